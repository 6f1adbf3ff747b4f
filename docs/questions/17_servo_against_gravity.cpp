// title: Servo against gravity
// thread: https://github.com/google-deepmind/mujoco_menagerie/pull/254
// words: position actuator, PD control, steady-state error, gravity compensation, target not reached, PID
// wanted: A position servo holds an arm at a target angle. A commanded angle of 1.57 rad gave 1.63 rad.
// inputs: Arm of 1.5 kg with its centre 0.5 m below the hinge, target 1.2 rad. PD servo with 25 N m/rad and 8 N m
//     s/rad; PID servo with 30 N m/(rad s) more.
// right: The servo has torque only if it has an error: k_p (r − ϑ) = m g l sin ϑ, solved by fixed-point iteration.
//     An integral part removes the error, and its torque at the target is m g l sin r.
#include <polybody/parts.hpp>
#include <polybody/polybody.hpp>

#include "answer.hpp"
using namespace polybody;

int main() {
  using Hinge = Joint<Revolute, Constraint>;
  using Pd = OnAngle<Servo<>>;
  using Pid = OnAngle<PidServo<>>;
  Model<Bodies<Rigid<>>, Joints<Hinge>, Forces<Pd, Pid>> model{Gravity{0, -9.81, 0}};
  auto const arm_at = [&](double z) {
    auto const arm = model.add(Rigid<>(1.5, 0.125 * Mat3::Identity(), Placement::at({0, -0.5, z})));
    return model.connect(Hinge{Revolute{.axis = {0, 0, 1}}}, model.ground().at({0, 0, z}), arm.at({0, 0.5, 0}));
  };
  auto const first = arm_at(0.0), second = arm_at(1.0);
  double const kp = 25.0, kd = 8.0, target = 1.2, load = 1.5 * 9.81 * 0.5;
  auto const pd =
      model.apply(Pd{{.target = {target}, .proportional_gain = kp, .derivative_gain = kd}}, first, "PD servo");
  auto const pid = model.apply(Pid{{.target = {target},
                                    .proportional_gain = kp,
                                    .integral_gain = 30.0,
                                    .derivative_gain = kd,
                                    .tracking_time = 0.2}},
                               second, "PID servo");
  State x = model.reference_state();
  simulate(model, x, GeneralisedAlpha{.rho_inf = 0.8}, {.end_time = 20.0, .step = 1e-2}).run();
  answer("angle under the PD servo [rad]", 0.9590691425, joint_angle(model, x, first), 1e-8);
  answer("torque of the PD servo [N m]", kp * (target - 0.9590691425), applied_wrenches(model, x, pd)[1].m[2], 1e-6);
  answer("angle under the PID servo [rad]", target, joint_angle(model, x, second), 1e-6);
  answer("torque of the PID servo [N m]", load * std::sin(target), applied_wrenches(model, x, pid)[1].m[2], 1e-5);
  return wrong_answers();
}
