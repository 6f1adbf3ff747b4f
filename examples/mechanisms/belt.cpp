// Belt drive: the driven pulley is slower than by the radii, because the belt creeps.
#include <polybody/parts.hpp>

#include "mechanism.hpp"
using namespace polybody;

int main() {
  using Pin = Joint<Revolute, Constraint>;
  using Motor = Joint<PrescribedRate<SmoothRamp>, Constraint>;
  using Belt = BeltAndPulley<2>;
  Model<Bodies<Rigid<>>, Joints<Pin, Motor>, Forces<Belt, PointMoment<Ramp>>> model;
  std::array const at = {Vec3(0, 0, 0), Vec3(0.8, 0, 0)};
  std::array const radii = {0.1, 0.25};
  auto const small = model.add(Rigid<>(2.0, 0.02 * Mat3::Identity()), "small");
  auto const large = model.add(Rigid<>(4.0, 0.1 * Mat3::Identity(), Placement::at(at[1])), "large");
  auto const ground = model.ground();
  auto const driver = model.connect(Pin{{.axis = {0, 0, 1}}}, ground.at(at[0]), small.centre(), "driver");
  auto const driven = model.connect(Pin{{.axis = {0, 0, 1}}}, ground.at(at[1]), large.centre(), "driven");
  Motor const motor{{.law = {{.target = 20.0, .duration = 0.5}}, .axis = {0, 0, 1}}};
  model.connect(motor, ground.at(at[0]), small.centre(), "motor");
  Belt const belt{.radii = radii, .centres = at, .axial_stiffness = 2e4, .damping = 60.0, .pretension = 400.0};
  auto const spans_of = model.apply(belt, small.centre(), large.centre(), "belt");
  model.apply(PointMoment<Ramp>{.moment = {0, 0, -30}, .law = {.target = 1.0, .duration = 0.5}}, large.centre(),
              "load");

  State x = model.reference_state();
  simulate(model, x, Radau{}, {.end_time = 3.0, .step = 2e-3}).run();
  mechanism::Picture picture("Belt over two pulleys", 0, 1);
  for (std::size_t k = 0; k < 2; ++k) {
    std::vector<Vec3> circle;
    for (int i = 0; i <= 40; ++i)
      circle.push_back(at[k] + radii[k] * Vec3(std::cos(i * 0.15708), std::sin(i * 0.15708), 0));
    picture.line(circle, int(k));
  }
  double const across = (radii[0] - radii[1]) / at[1][0];  // normal of a span, along the line of centres
  for (double const side : {1.0, -1.0}) {
    Vec3 const normal(across, side * std::sqrt(1.0 - across * across), 0);
    picture.line({at[0] + radii[0] * normal, at[1] + radii[1] * normal}, 2);
  }
  picture.write("belt");
  auto const spans = belt_spans(model, x, spans_of);
  double const tight = std::max(spans[0].strain, spans[1].strain), slack = std::min(spans[0].strain, spans[1].strain);
  double const ratio = radii[0] * joint_angle_rate(model, x, driver) / (radii[1] * joint_angle_rate(model, x, driven));
  return mechanism::compare("ratio of the surface speeds", ratio, (1.0 + tight) / (1.0 + slack), 1e-5);
}
