// title: Torque of a motor on its base
// thread: https://github.com/bulletphysics/bullet3/issues/2966
// wanted: The reaction of a motor on its base contains the torque of the motor once. It was counted twice.
// inputs: Link of 1 kg with J = 0.2 kg m² about its hinge, which is 0.4 m from its centre of mass. The motor drives
//     the link by 2 N m from rest. The base is fixed to the ground. No gravity.
// right: M/J = 10 rad/s². The ground holds the base by 2 N m, and the hinge has no moment about its axis. After 0.1 s
//     the speed is 1 rad/s, and the hinge holds the link by m r ω² = 0.4 N along it.
#include <polybody/polybody.hpp>

#include "answer.hpp"
using namespace polybody;

int main() {
  using Hinge = Joint<Revolute, Constraint>;
  using Foot = Joint<Weld, Constraint>;
  Model<Bodies<Rigid<>>, Joints<Hinge, Foot>, Forces<PointMoment<>>> model;
  auto const base = model.add(Rigid<>(5.0, Mat3(Mat3::Identity())), "base");
  auto const link = model.add(Rigid<>(1.0, Mat3(0.04 * Mat3::Identity()), Placement::at({0.4, 0, 0})), "link");
  auto const foot = model.connect(Foot{}, model.ground().at({0, 0, 0}), base.centre(), "foot");
  auto const hinge =
      model.connect(Hinge{Revolute{.axis = {0, 0, 1}}}, base.centre(), link.at(Vec3(-0.4, 0, 0)), "hinge");
  model.apply(PointMoment<>{.moment = {0, 0, 2.0}}, link.centre(), "motor, on the link");
  model.apply(PointMoment<>{.moment = {0, 0, -2.0}}, base.centre(), "motor, on the base");
  State x = model.reference_state();
  simulate(model, x, Radau{}, {.end_time = 0.1, .step = 1e-3}).run();
  answer("acceleration of the link [rad/s²]", 10.0, angular_acceleration(model, x, link.centre())[2], 1e-6);
  answer("moment of the ground on the base [N m]", 2.0, reaction(model, x, foot).m[2], 1e-6);
  answer("moment of the hinge about its axis [N m]", 0.0, reaction(model, x, hinge).m[2], 1e-6);
  Vec3 const along = frame(model, x, link.centre()).A.col(0);
  answer("force of the hinge along the link [N]", -0.4, reaction(model, x, hinge).f.dot(along), 1e-6);
  return wrong_answers();
}
