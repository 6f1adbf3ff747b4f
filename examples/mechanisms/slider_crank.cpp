// Slider-crank that turns at a constant rate: position of the piston after 0.4 turns.
#include "mechanism.hpp"
using namespace polybody;

int main() {
  using Pin = Joint<planar::Revolute, Constraint>;
  using Slide = Joint<planar::Prismatic, Constraint>;
  using Motor = Joint<PrescribedRate<Constant>, Constraint>;
  double const r = 0.1, l = 0.3, turn = 2.0 * std::acos(-1.0);
  Model<Bodies<planar::Rigid>, Joints<Pin, Slide, Motor>> model;
  auto const ground = model.ground().at({0, 0, 0});
  auto const crank = model.add(planar::Rigid(0.5, 1e-3, Placement::planar(0.5 * r, 0)), "crank");
  auto const rod = model.add(planar::Rigid(0.8, 6e-3, Placement::planar(r + 0.5 * l, 0)), "rod");
  auto const piston = model.add(planar::Rigid(2.0, 1e-3, Placement::planar(r + l, 0)), "piston");
  model.connect(Pin{}, ground, crank.at(Vec2(-0.5 * r, 0)), "bearing");
  model.connect(Pin{}, crank.at(Vec2(0.5 * r, 0)), rod.at(Vec2(-0.5 * l, 0)), "crank pin");
  model.connect(Pin{}, rod.at(Vec2(0.5 * l, 0)), piston.centre(), "piston pin");
  model.connect(Slide{{.axis = {1, 0, 0}}}, ground, piston.centre(), "cylinder");
  model.connect(Motor{{.law = {{.value = turn}}}}, ground, crank.at(Vec2(-0.5 * r, 0)), "motor");

  State x = model.reference_state();
  mechanism::Picture picture("Slider-crank", 0, 1);
  int step = 0;
  for (auto const& now : simulate(model, x, GeneralisedAlpha{}, {.end_time = 0.4, .step = 1e-3})) {
    if (step++ % 80 != 0) continue;
    Vec3 const pin = now.position(crank.at(Vec2(0.5 * r, 0))), end = now.position(piston.centre());
    picture.line({Vec3(0, 0, 0), pin, end}, 0, now.t);
  }
  picture.write("slider_crank");
  double const angle = 0.4 * turn, known = r * std::cos(angle) + std::sqrt(l * l - std::pow(r * std::sin(angle), 2));
  return mechanism::compare("position of the piston [m]", position(model, x, piston.centre())[0], known, 1e-6);
}
