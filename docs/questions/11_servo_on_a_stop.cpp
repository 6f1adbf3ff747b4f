// title: Servo on a stop
// thread: https://github.com/dartsim/dart/issues/1583
// wanted: A servo drives a hinge against its limit and back. The hinge passed the limit, or stuck to it
//     (dart#1683, #2422).
// inputs: J = 0.5 kg m², 1.5 kg at 0.5 m below the hinge. Servo torque 40 (ω_ref − ω), at most 20 N m; ω_ref = 1
//     rad/s for 2 s, then −1. Stop at 0.5 rad: 1e4 (ϑ − 0.5) + 50 ω, pushes only.
// right: Radau IIA of SciPy at a tolerance of 1e-11. At rest on the stop its torque is 20 − 7.3575 sin ϑ.
#include <polybody/parts.hpp>
#include <polybody/polybody.hpp>

#include "answer.hpp"
using namespace polybody;

int main() {
  auto target = [](double t) -> Motion { return {2.0 - std::abs(t - 2.0), t < 2.0 ? 1.0 : -1.0, 0.0}; };
  using Hinge = Joint<Revolute, Constraint>;
  using Drive = OnAngle<Servo<decltype(target)>>;
  Model<Bodies<Rigid<>>, Joints<Hinge>, Forces<Drive, JointLimit>> model{Gravity{0, 0, -9.81}};
  auto const arm =
      model.add(Rigid<>(1.5, Mat3(Vec3(0.125, 0.125, 0.01).asDiagonal()), Placement::at({0, 0, -0.5})), "arm");
  auto const hinge = model.connect(Hinge{Revolute{.axis = {0, -1, 0}}}, model.ground().at({0, 0, 0}),
                                   arm.at(Vec3(0, 0, 0.5)), "hinge");
  model.apply(Drive{{.target = target, .proportional_gain = 0.0, .derivative_gain = 40.0, .most_force = 20.0}}, hinge,
              "servo");
  auto const stop = model.apply(JointLimit{{.upper = 0.5, .stiffness = 1e4, .damping = 50.0}}, hinge, "stop");
  State x = model.reference_state();
  auto const angle = [&](double t) {
    simulate(model, x, GeneralisedAlpha{.rho_inf = 0.9}, {.end_time = t, .step = 2e-4, .breakpoints = {2.0}}).run();
    return joint_angle(model, x, hinge);
  };
  answer("angle at 0.1 s [rad]", 0.08387673, angle(0.1), 1e-5);
  answer("angle at 0.5 s [rad]", 0.46474471, angle(0.5), 1e-5);
  double const rest = angle(1.9), torque = applied_wrenches(model, x, stop)[1].m[1];  // against the rotation about −y
  answer("angle at rest on the stop [rad]", 0.50164620, rest, 1e-6);
  answer("torque of the stop [N m]", 16.462002, torque, 1e-3);
  answer("angle at 2.5 s [rad]", -0.00704989, angle(2.5), 1e-5);
  return wrong_answers();
}
