// title: Assembly of a scattered slider-crank
// thread: https://github.com/FreeCAD/FreeCAD/issues/30536
// words: assembly solver, closed loop, crankshaft, connecting rod, piston, overconstrained, initial configuration
// wanted: Crank, rod and piston are assembled. The solver failed at the joint that closes the loop, unless the
//     user dragged the rod to its place first.
// inputs: Crank of 0.05 m, rod of 0.15 m. The crank is turned to 60°. The bodies start up to 0.3 m and 40° beside
//     their places, in space, with three hinges about z and a cylindrical guide along x.
// right: With β = arcsin(r sin 60°/l) for the rod, the piston is at r cos 60° + l cos β. The loop is in a plane,
//     so 2 of the 20 equations are redundant.
#include <polybody/polybody.hpp>

#include <numbers>

#include "answer.hpp"
using namespace polybody;

int main() {
  using Hinge = Joint<Revolute, Constraint>;
  using Guide = Joint<Cylindrical, Constraint>;
  using Turn = Joint<PrescribedAngle<Constant>, Constraint>;
  Model<Bodies<Rigid<>>, Joints<Hinge, Guide, Turn>> model;
  double const r = 0.05, l = 0.15, angle = std::numbers::pi / 3, beta = std::asin(r * std::sin(angle) / l);
  Mat3 const inertia = 1e-3 * Mat3::Identity();
  Hinge const hinge{Revolute{.axis = {0, 0, 1}}};
  auto const ground = model.ground().at({0, 0, 0});
  auto const crank = model.add(Rigid<>(1.0, inertia, Placement::at({0.5 * r, 0, 0})), "crank");
  auto const rod = model.add(Rigid<>(1.0, inertia, Placement::at({0.3, 0.2, 0.1}, {0, 0, 0.7})), "rod");
  auto const piston = model.add(Rigid<>(1.0, inertia, Placement::at({0.4, 0.05, -0.02})), "piston");
  model.connect(hinge, ground, crank.at(Vec3(-0.5 * r, 0, 0)), "bearing");
  model.connect(Turn{{.law = {angle}, .axis = {0, 0, 1}}}, ground, crank.at(Vec3(-0.5 * r, 0, 0)),
                "angle of the crank");
  model.connect(hinge, crank.at(Vec3(0.5 * r, 0, 0)), rod.at(Vec3(-0.5 * l, 0, 0)), "crank pin");
  model.connect(hinge, rod.at(Vec3(0.5 * l, 0, 0)), piston.centre(), "piston pin");
  model.connect(Guide{{.axis = {1, 0, 0}}}, ground, piston.centre(), "cylinder");
  State x = model.reference_state();
  assemble(model, x);
  Vec3 const at = position(model, x, piston.centre());
  Redundancy const rows = redundancy(model, x);
  answer("x of the piston [m]", r * std::cos(angle) + l * std::cos(beta), at[0], 1e-10);
  answer("distance of the piston from its axis [m]", 0.0, std::hypot(at[1], at[2]), 1e-10);
  answer("sine of the angle of the rod [1]", -std::sin(beta), frame(model, x, rod.centre()).A(1, 0), 1e-10);
  answer("redundant equations [1]", 2.0, double(rows.rows - rows.rank), 0.0);
  return wrong_answers();
}
