// Four-bar mechanism with a motor: the rocker swings by an angle that the law of cosines gives.
#include "mechanism.hpp"
using namespace polybody;

int main() {
  using Pin = Joint<planar::Revolute, Constraint>;
  using Motor = Joint<PrescribedRate<Constant>, Constraint>;
  Model<Bodies<planar::Rigid>, Joints<Pin, Motor>> model;
  auto const rod = [](double length, double at, double angle) {
    return planar::Rigid::from({.length = length,
                                .section = Circle{.radius = 0.01},
                                .material = Material{.density = 7800, .young = 2e11},
                                .placement = Placement::planar(at, 0, angle)});
  };
  auto const ground = model.ground();
  auto const crank = model.add(rod(0.3, 0.0, 0.0), "crank");
  auto const coupler = model.add(rod(0.9, 0.3, 0.6), "coupler");
  auto const rocker = model.add(rod(0.7, 1.0, 1.5), "rocker");
  model.connect(Pin{}, ground.at({0, 0, 0}), crank.at(0.0), "bearing");
  model.connect(Pin{}, crank.at(0.3), coupler.at(0.0), "crank pin");
  model.connect(Pin{}, coupler.at(0.9), rocker.at(0.7), "rocker pin");
  auto const pivot = model.connect(Pin{}, ground.at({1, 0, 0}), rocker.at(0.0), "pivot");
  model.connect(Motor{{.law = {{.value = 2.0 * std::acos(-1.0)}}}}, ground.at({0, 0, 0}), crank.at(0.0), "motor");

  State x = model.reference_state();
  assemble(model, x);  // closes the loop
  mechanism::Picture picture("Four-bar mechanism", 0, 1);
  double least = 1e9, most = -1e9;
  int step = 0;
  for (auto const& now : simulate(model, x, GeneralisedAlpha{}, {.end_time = 1.0, .step = 1e-3})) {
    least = std::min(least, now.joint_angle(pivot));
    most = std::max(most, now.joint_angle(pivot));
    if (step++ % 125 == 0 && now.t < 0.99)
      picture.line({Vec3(0, 0, 0), now.position(crank.at(0.3)), now.position(rocker.at(0.7)), Vec3(1, 0, 0)}, 0, now.t);
  }
  picture.write("four_bar");
  double const known = std::acos((1.49 - 1.44) / 1.4) - std::acos((1.49 - 0.36) / 1.4);
  return mechanism::compare("swing of the rocker [rad]", most - least, known, 1e-4);
}
