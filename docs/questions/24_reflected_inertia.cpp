// title: Inertia of a rotor behind a gear
// thread: https://github.com/RobotLocomotion/drake/issues/12335
// words: gear ratio, transmission, reflected inertia, rotor inertia, armature, actuator, gearbox
// wanted: A motor drives a hinge through a gear. The ratio multiplies its torque, and its rotor adds inertia.
// inputs: Arm with 0.2 kg m² about its hinge, rotor with 1e-4 kg m², ratio 80, 0.05 N m on the rotor, no gravity.
// right: Power and kinetic energy give (J + n² J_r) α = n T, so α = 4/0.84 rad/s². The gear transmits J α to the
//     arm. Without the rotor the acceleration would be 20 rad/s².
#include <polybody/polybody.hpp>

#include "answer.hpp"
using namespace polybody;

int main() {
  using Hinge = Joint<Revolute, Constraint>;
  using Gears = Joint<Gear, Constraint>;
  Model<Bodies<Rigid<>>, Joints<Hinge, Gears>, Forces<PointMoment<>>> model;
  double const J = 0.2, rotor_inertia = 1e-4, ratio = 80.0, torque = 0.05,
               alpha = ratio * torque / (J + ratio * ratio * rotor_inertia);
  Hinge const about_z{Revolute{.axis = {0, 0, 1}}};
  auto const arm = model.add(Rigid<>(1.0, J * Mat3::Identity()), "arm");
  auto const rotor = model.add(Rigid<>(0.1, rotor_inertia * Mat3::Identity(), Placement::at({0.1, 0, 0})), "rotor");
  auto const hinge = model.connect(about_z, model.ground().at({0, 0, 0}), arm.centre(), "hinge");
  auto const bearing = model.connect(about_z, model.ground().at({0.1, 0, 0}), rotor.centre(), "bearing");
  auto const gear = model.connect(Gears{Gear{.teeth_a = 10, .teeth_b = -800, .axis = {0, 0, 1}, .centres = {-1, 0, 0}}},
                                  rotor.centre(), arm.centre(), "ring gear");
  model.apply(PointMoment<>{.moment = {0, 0, torque}}, rotor.centre(), "motor");
  State x = model.reference_state();
  simulate(model, x, GeneralisedAlpha{}, {.end_time = 1.0, .step = 1e-3}).run();
  answer("acceleration of the arm [rad/s²]", alpha, angular_acceleration(model, x, arm.centre())[2], 1e-6);
  answer("speed of the arm at 1 s [rad/s]", alpha, joint_angle_rate(model, x, hinge), 1e-7);
  answer("speed of the rotor at 1 s [rad/s]", ratio * alpha, joint_angle_rate(model, x, bearing), 1e-5);
  answer("moment of the gear on the arm [N m]", J * alpha, std::abs(reaction(model, x, gear).m[2]), 1e-6);
  return wrong_answers();
}
