// title: Round rod that bends and twists
// thread: https://github.com/google-deepmind/mujoco/issues/2208
// wanted: A cable of round sections bends with the stiffness of the circle. It had that of a square. A weld of two
//     rods transmits a torque, which was lost (PyElastica#135).
// inputs: Radius 4 mm, 0.5 m, E = 2.5e9 Pa, ν = 0.35, clamped, 8 elements. Tip force of 0.05 N across the rod. Two
//     such rods, welded end to end, under a torque of 0.1 N m at the end.
// right: Elastica by elliptic integrals, without shear (the square of 8 mm deflects by 2.4414e-3 m). Each rod twists
//     by M L/GJ with GJ = G π r⁴/2.
#include <polybody/ffr.hpp>
#include <polybody/polybody.hpp>

#include "answer.hpp"
using namespace polybody;

int main() {
  using Fixed = Joint<Weld, Constraint>;
  using Rods = Model<Bodies<Ffr>, Joints<Fixed>, Forces<PointForce<>, PointMoment<>>>;
  Bar bar{.length = 0.5,
          .section = Circle{.radius = 4e-3},
          .material = Material{.density = 1000.0, .young = 2.5e9, .poisson = 0.35}};
  Rods model, two;
  auto const rod = model.add(Ffr::from(bar, 8), "rod"), first = two.add(Ffr::from(bar, 8), "first");
  bar.placement = Placement::at({0.5, 0, 0});
  auto const second = two.add(Ffr::from(bar, 8), "second");
  model.connect(Fixed{}, model.ground().at({0, 0, 0}), rod.at(0.0), "clamp");
  model.apply(PointForce<>{.force = {0, 0.05, 0}}, rod.at(0.5), "tip force");
  two.connect(Fixed{}, two.ground().at({0, 0, 0}), first.at(0.0), "clamp");
  auto const weld = two.connect(Fixed{}, first.at(0.5), second.at(0.0), "weld");
  two.apply(PointMoment<>{.moment = {0.1, 0, 0}}, second.at(0.5), "torque");
  State x = model.reference_state(), y = two.reference_state();
  equilibrium(model, x);
  equilibrium(two, y);
  Frame<double> const tip = frame(model, x, rod.at(0.5));
  Mat3 const joint = frame(two, y, first.at(0.5)).A, end = frame(two, y, second.at(0.5)).A;
  answer("deflection of the tip [m]", 4.144367e-3, tip.r[1], 4.1e-7);
  answer("slope of the tip [rad]", 0.01243328, std::atan2(tip.A(1, 0), tip.A(0, 0)), 1.2e-6);
  answer("shortening of the rod [m]", 2.0611e-5, 0.5 - tip.r[0], 2e-9);
  answer("twist at the weld [rad]", 0.13428698, std::atan2(joint(2, 1), joint(1, 1)), 1.3e-5);
  answer("twist at the end [rad]", 0.26857397, std::atan2(end(2, 1), end(1, 1)), 2.6e-5);
  answer("moment of the weld [N m]", 0.1, std::abs(reaction(two, y, weld).m[0]), 1e-5);
  return wrong_answers();
}
