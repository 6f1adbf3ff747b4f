// X14: servo that presses a hinge against its stop and then reverses (after dartsim/dart#1583 and #2422), and a
// pendulum at rest on its backlash stop (jiminy#778).

#include <gtest/gtest.h>

#include <polybody/bodies/rigid/rigid.hpp>
#include <polybody/forces/limits.hpp>
#include <polybody/forces/servo.hpp>
#include <polybody/forces/user_force.hpp>
#include <polybody/integrators/generalised_alpha.hpp>
#include <polybody/integrators/radau.hpp>
#include <polybody/joints/policies/bushing.hpp>
#include <polybody/joints/policies/elimination.hpp>
#include <polybody/joints/standard_joints.hpp>
#include <polybody/run/energy_audit.hpp>
#include <polybody/run/joint_position.hpp>
#include <polybody/run/probe.hpp>
#include <polybody/run/simulate.hpp>

#include "support/held.hpp"

namespace polybody {
namespace servo_on_a_stop_test {

/// Angular speed of 1 rad/s before 2 s and of −1 rad/s afterwards: the target of the servo.
// --- code with parts
auto reversed() {
  return [](double t) -> Motion { return {2.0 - std::abs(t - 2.0), t < 2.0 ? 1.0 : -1.0, 0.0}; };
}
using SpeedServo = OnAngle<Servo<decltype(reversed())>>;
// --- end

// Servo and stop by lambdas of the user.
// --- code by hand
template <class T>
std::array<Wrench<T>, 2> about(Vec<T, 3> const& axis, T const& moment) {
  std::array<Wrench<T>, 2> w;
  for (int i = 0; i < 3; ++i) {
    w[1].m[i] = axis[i] * moment;
    w[0].m[i] = -w[1].m[i];
  }
  return w;
}
auto servo() {
  return user_force<2>([]<class T>(std::array<Frame<T>, 2> const& f, double t) {
    Vec<T, 3> const axis = axis_of(f[0], 2), spin = f[1].w - f[0].w;
    T moment = ((t < 2.0 ? 1.0 : -1.0) - axis.dot(spin)) * 40.0;
    if (value_of(moment) > 20.0) moment = T(20.0);
    if (value_of(moment) < -20.0) moment = T(-20.0);
    return about<T>(axis, moment);
  });
}
auto stop() {
  return user_force<2>([]<class T>(std::array<Frame<T>, 2> const& f, double) {
    using std::atan2;
    Vec<T, 3> const axis = axis_of(f[0], 2), spin = f[1].w - f[0].w, x = axis_of(f[1], 0);
    T const angle = atan2(x.dot(axis_of(f[0], 1)), x.dot(axis_of(f[0], 0)));
    T moment = (angle - 0.5) * 1e4 + axis.dot(spin) * 50.0;
    if (value_of(angle) < 0.5 || value_of(moment) < 0.0) moment = T(0.0);
    return about<T>(axis, -moment);
  });
}
// --- end

/// Arm of 1.5 kg on a hinge about −y, which hangs at zero, with its centre of mass at 0.5 m and J = 0.5 kg m² about
/// the hinge: 0.125 kg m² about the centre. Servo and stop are parts of the library or lambdas.
/// The third body axis is the axis of the hinge.
Mat3 const axes_of_arm = [] {
  Mat3 axes;
  axes << 1, 0, 0, 0, 0, -1, 0, 1, 0;
  return axes;
}();
template <class Policy, bool parts>
struct Arm {
  using Pin = Joint<Revolute, Policy>;
  using Drive = std::conditional_t<parts, SpeedServo, decltype(servo())>;
  using Stop = std::conditional_t<parts, JointLimit, decltype(stop())>;
  Model<Bodies<Rigid<>>, Joints<Pin>, Forces<Drive, Stop>> model{Gravity{0, 0, -9.81}};
  BodyHandle<Rigid<>> arm = model.add(
      Rigid<>(1.5, Mat3(Vec3(0.125, 0.01, 0.125).asDiagonal()), Placement{Vec3(0, 0, -0.5), axes_of_arm}), "arm");
  ElementHandle<Pin> hinge;
  ElementHandle<Stop> end;

  explicit Arm(Policy const& policy = {})
      : hinge(model.connect(Pin{Revolute{.axis = Vec3(0, -1, 0)}, policy}, model.ground().at({0, 0, 0}),
                            arm.at(Vec3(0, 0.5, 0)), "hinge")) {
    if constexpr (parts) {
      // --- code with parts
      model.apply(
          SpeedServo{{.target = reversed(), .proportional_gain = 0.0, .derivative_gain = 40.0, .most_force = 20.0}},
          hinge, "servo");
      end = model.apply(JointLimit{{.upper = 0.5, .stiffness = 1e4, .damping = 50.0}}, hinge, "stop");
      // --- end
    } else {
      // --- code by hand
      auto const on_ground = model.ground().at(Placement{Vec3::Zero(), axes_of_arm});
      auto const on_arm = arm.at(Vec3(0, 0.5, 0));
      model.apply(servo(), on_ground, on_arm, "servo");
      end = model.apply(stop(), on_ground, on_arm, "stop");
      // --- end
    }
  }
};

struct Time {
  double t, angle;
};
/// Angles by Radau IIA of scipy with rtol 1e-11, from θ̈ = (servo + stop − 7.3575 sin θ)/0.5.
constexpr Time times[] = {{0.1, 0.08387673},  {0.3, 0.27768540}, {0.5, 0.46474471}, {1.9, 0.50164620},
                          {2.05, 0.46195710}, {2.1, 0.40825029}, {2.3, 0.19687401}, {2.5, -0.00704989}};

template <class Policy, bool parts = true, class Integrator>
void follows(char const* formulation, Integrator const& method, Policy const& policy = {}) {
  Claim const angle{"X14", "angle of the hinge [rad]", By::independent, "Radau IIA (scipy), rtol 1e-11", formulation};
  Arm<Policy, parts> arm(policy);
  State x = arm.model.reference_state();
  EnergyAudit audit(arm.model);
  audit.record(x);
  for (Time const& expected : times) {
    for (State const& now :
         simulate(arm.model, x, method, {.end_time = expected.t, .step = 2e-4, .breakpoints = {2.0}}))
      audit.record(now);
    held(angle, joint_angle(arm.model, x, arm.hinge), expected.angle, 1e-5,
         {.at = equals("t", expected.t), .scale = 0.5});
    if (expected.t == 1.9) {
      Claim const moment{"X14", "moment of the stop [N m]", By::closed_form, "20 − 7.3575 sin θ", formulation};
      held(moment, -applied_wrenches(arm.model, x, arm.end)[1].m.dot(Vec3(0, -1, 0)), 16.462002, 1e-4);
    }
  }
  EXPECT_LT(audit.relative(), 1e-3);  // contacts within steps, see below
}

TEST(ServoOnAStop, IsHeldAndReleased) {
  follows<Constraint>("Constraint, GeneralisedAlpha, h = 0.2 ms", GeneralisedAlpha{.rho_inf = 0.9});
  follows<JointCoordinates>("JointCoordinates, GeneralisedAlpha, h = 0.2 ms", GeneralisedAlpha{.rho_inf = 0.9});
  follows<Penalty>("Penalty, GeneralisedAlpha, h = 0.2 ms", GeneralisedAlpha{.rho_inf = 0.9},
                   {.stiffness = 1e8, .damping = 1e4});
  follows<Constraint>("Constraint, Radau, h = 0.2 ms", Radau{});
  follows<Constraint, false>("Constraint, lambdas, GeneralisedAlpha, h = 0.2 ms", GeneralisedAlpha{.rho_inf = 0.9});
}

// The damper of the stop engages at once, and its power jumps by c ω² at a contact. A jump within a step adds an error
// of ½ h c ω² to the audit. The second run therefore has breakpoints 10 ns before and after each contact.
TEST(ServoOnAStop, ClosesItsEnergyAudit) {
  Arm<Constraint, true> arm;
  Probe probe(arm.model);
  Event const contact{.name = "contact",
                      .value = [&](State const& x) { return ObservedState(x, probe).joint_angle(arm.hinge) - 0.5; }};
  std::vector<double> unaccounted;
  for (double const h : {4e-4, 1e-4}) {
    State x = arm.model.reference_state();
    RunOptions options{.end_time = 2.5, .step = h, .breakpoints = {2.0}, .events = {contact}};
    auto search = simulate(arm.model, x, Radau{.tolerance = 1e-11}, options);
    search.run();
    ASSERT_GE(search.report().events.size(), 2u);
    for (auto const& met : search.report().events)
      for (double const side : {-1e-8, 1e-8}) options.breakpoints.push_back(met.time + side);
    options.events.clear();
    x = arm.model.reference_state();
    EnergyAudit audit(arm.model);
    for (State const& now : simulate(arm.model, x, Radau{.tolerance = 1e-11}, options)) audit.record(now);
    EXPECT_GT(audit.dissipated(), 0.1);
    unaccounted.push_back(audit.relative());
  }
  EXPECT_LT(unaccounted[1], 1e-6);
  EXPECT_GT(unaccounted[0] / unaccounted[1], 5.6) << unaccounted[0];  // h^1.25: corners of the powers within steps
}

/// Arm that rests on a stop with play, held by gravity: after it settles, its acceleration is zero (jiminy#778).
template <class Policy>
void rests_without_acceleration(Policy const& policy = {}) {
  using Pin = Joint<Revolute, Policy>;
  using Play = OnAngle<Backlash>;
  Model<Bodies<Rigid<>>, Joints<Pin>, Forces<Play>> model{Gravity{0, 0, -9.81}};
  auto const arm =
      model.add(Rigid<>(1.5, Mat3(Vec3(0.125, 0.125, 0.01).asDiagonal()), Placement::at({0.5, 0, 0})), "arm");
  auto const hinge = model.connect(Pin{Revolute{.axis = Vec3(0, -1, 0)}, policy}, model.ground().at({0, 0, 0}),
                                   arm.at(Vec3(-0.5, 0, 0)), "hinge");
  auto const play = model.apply(Play{{.play = 0.1, .stiffness = 1e4, .damping = 100.0, .onset = 1e-3}}, hinge, "play");
  State x = model.reference_state();
  simulate(model, x, GeneralisedAlpha{.rho_inf = 0.6}, {.end_time = 2.0, .step = 1e-3}).run();
  double const angle = joint_angle(model, x, hinge);
  EXPECT_NEAR(1e4 * (-0.05 - angle), 7.3575 * std::cos(angle), 1e-6);  // stop against gravity
  EXPECT_NEAR(applied_wrenches(model, x, play)[1].m.dot(Vec3(0, -1, 0)), 7.3575 * std::cos(angle), 1e-6);
  EXPECT_LT(x.a.cwiseAbs().maxCoeff(), 1e-6);
}
TEST(Backlash, RestsWithoutAcceleration) {
  rests_without_acceleration<Constraint>();
  rests_without_acceleration<JointCoordinates>();
}

}  // namespace servo_on_a_stop_test
}  // namespace polybody
