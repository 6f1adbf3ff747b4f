// Heavy symmetric top on a fixed point: without nutation it precesses at a constant rate, with a constant lean.
#include "mechanism.hpp"
using namespace polybody;

int main() {
  using Tip = Joint<Spherical, Constraint>;
  double const mass = 0.5, arm = 0.1, radius = 0.06, lean = 0.5, spin = 200.0, g = 9.81;  // disc, arm without mass
  double const axial = 0.5 * mass * radius * radius, lateral = 0.5 * axial;
  Vec3 const axis(std::sin(lean), 0, std::cos(lean));
  Model<Bodies<Rigid<>>, Joints<Tip>> model{Gravity{0, 0, -g}};
  auto const top = model.add(
      Rigid<>(mass, Vec3(lateral, lateral, axial).asDiagonal(), Placement::at(arm * axis, {0, lean, 0})), "top");
  model.connect(Tip{}, model.ground().at({0, 0, 0}), top.at(Vec3(0, 0, -arm)), "tip");

  // Constant rate Ω, with I = I₁ + m l² about the tip and the spin ω₃: I cos θ Ω² − I₃ ω₃ Ω + m g l = 0. The slow root:
  double const about_tip = lateral + mass * arm * arm, momentum = axial * spin, moment = mass * g * arm;
  double const root = std::sqrt(momentum * momentum - 4.0 * about_tip * std::cos(lean) * moment);
  double const known = 2.0 * moment / (momentum + root);
  State x = model.reference_state();
  Vec3 const w = known * Vec3::UnitZ() + (spin - known * std::cos(lean)) * axis;
  model.set_velocity(x, top, Vec3::Zero(), w);  // the tip rests

  mechanism::Picture picture("Top: axis and rim of its disc", 0, 2);
  double const pi = std::acos(-1.0), end = 1.25 * pi / known;
  double angle = 0.0, before = 0.0;
  int step = 0;
  for (auto const& now : simulate(model, x, Radau{}, {.end_time = end, .step = end / 1000})) {
    Vec3 const centre = now.position(top.centre());
    double const azimuth = std::atan2(centre[1], centre[0]);
    angle += std::remainder(azimuth - before, 2.0 * pi);
    before = azimuth;
    if (step++ % 400 != 0) continue;  // a half-turn takes 800 steps
    std::vector<Vec3> rim;
    for (int i = 0; i <= 40; ++i)
      rim.push_back(now.position(top.at(Vec3(radius * std::cos(pi * i / 20), radius * std::sin(pi * i / 20), 0))));
    picture.area(rim, step / 400);
    picture.line({Vec3(0, 0, 0), centre}, step / 400);
    Vec3 const lowest = *std::ranges::min_element(rim, {}, [](Vec3 const& p) { return p[2]; });
    picture.text(lowest + Vec3(0.003, 0, -0.014), number(now.t, 3) + " s");
  }
  picture.write("top");
  return mechanism::compare("rate of precession [rad/s]", angle / end, known, 1e-5);
}
