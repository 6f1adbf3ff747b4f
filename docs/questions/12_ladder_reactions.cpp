// title: Reactions of a ladder on a wall
// thread: https://github.com/RobotLocomotion/drake/issues/13888
// wanted: Reactions of joints include all forces. They missed contacts, limits and damping in the discrete mode.
// inputs: Ladder of 4 m and 7 kg at 60°, of two welded halves, on a pin about z at the origin. It leans on a
//     smooth wall by a contact at its top, 0.15 m from its mid-plane.
// right: Equilibrium: wall m g/(2 tan 60°) = 19.823321 N, pin (19.823321, 68.67) N, weld (19.823321, 34.335, 0) N
//     with −17.1675 N m about z and 2.973498 N m about y.
#include <polybody/polybody.hpp>

#include <numbers>

#include "answer.hpp"
using namespace polybody;

int main() {
  using Pin = Joint<Revolute, Constraint>;
  using Fixed = Joint<Weld, Constraint>;
  using Wall = Contact<SphereOnPlane>;
  Model<Bodies<Rigid<>>, Joints<Pin, Fixed>, Forces<Wall>> model{Gravity{0, -9.81, 0}};
  double const angle = std::numbers::pi / 3;
  Vec3 const along(std::cos(angle), std::sin(angle), 0);
  auto const half = [&](double at) {
    return Rigid<>(3.5, Mat3(Vec3(0.01, 3.5 * 4 / 12, 3.5 * 4 / 12).asDiagonal()),
                   Placement::at(at * along, {0, 0, angle}));
  };
  auto const lower = model.add(half(1.0), "lower"), upper = model.add(half(3.0), "upper");
  auto const pin =
      model.connect(Pin{Revolute{.axis = {0, 0, 1}}}, model.ground().at({0, 0, 0}), lower.at(Vec3(-1, 0, 0)), "pin");
  auto const weld = model.connect(Fixed{}, lower.at(Vec3(1, 0, 0)), upper.at(Vec3(-1, 0, 0)), "weld");
  Placement wall;  // its third axis points at the ladder
  wall.origin = Vec3(2.01, 0, 0);
  wall.axes << 0, 0, -1, 0, 1, 0, 1, 0, 0;
  auto const contact = model.apply(Wall{.geometry = {.radius = 0.01}, .normal = {.stiffness = 1e9, .damping = 0.0}},
                                   upper.at(Vec3(1, 0, 0.15)), model.ground().at(wall), "wall");
  State x = model.reference_state();
  equilibrium(model, x);
  Wrench<double> const foot = reaction(model, x, pin), middle = reaction(model, x, weld);
  answer("force of the wall [N]", 19.823321, applied_wrenches(model, x, contact)[0].f.norm(), 1e-5);
  answer("horizontal force of the pin [N]", 19.823321, std::abs(foot.f[0]), 1e-5);
  answer("vertical force of the pin [N]", 68.67, std::abs(foot.f[1]), 1e-5);
  answer("horizontal force of the weld [N]", 19.823321, std::abs(middle.f[0]), 1e-5);
  answer("vertical force of the weld [N]", 34.335, std::abs(middle.f[1]), 1e-5);
  answer("moment of the weld about z [N m]", 17.1675, std::abs(middle.m[2]), 1e-5);
  answer("moment of the weld about y [N m]", 2.973498, std::abs(middle.m[1]), 1e-5);
  return wrong_answers();
}
