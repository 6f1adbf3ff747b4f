// Servos on a hinge, compared with closed forms and with servo.py.
#include <gtest/gtest.h>

#include <polybody/forces/limits.hpp>
#include <polybody/forces/servo.hpp>
#include <polybody/integrators/generalised_alpha.hpp>
#include <polybody/integrators/radau.hpp>
#include <polybody/joints/policies/elimination.hpp>
#include <polybody/run/energy_audit.hpp>
#include <polybody/statics/equilibrium.hpp>

#include "support/hinge.hpp"

namespace polybody {
namespace servo_test {

// Case of a servo that pushes an arm against a stop, reverses and leaves it [dartsim/dart#1583, #1683].

/// Rate of 1 rad/s, from 2 s on −1 rad/s.
struct Reversal {
  Motion operator()(double t) const { return {0.0, t < 2.0 ? 1.0 : -1.0, 0.0}; }
  std::vector<double> breakpoints() const { return {2.0}; }
};
template <class P, class I>
void servo_on_a_stop(I const& integrator, double h, char const* formulation) {
  Hinge<P, OnAngle<Servo<Reversal>>, JointLimit> arm(0.5, 1.5, 0.5);
  arm.model.apply(
      OnAngle<Servo<Reversal>>{{.target = {}, .proportional_gain = 0.0, .derivative_gain = 40.0, .most_force = 20.0}},
      arm.pin, "servo");
  arm.model.apply(JointLimit{{.upper = 0.5, .stiffness = 1e4, .damping = 50.0}}, arm.pin, "stop");
  State x = arm.model.reference_state();
  std::vector<std::pair<double, double>> const exact = {{0.1, 0.08387673}, {0.3, 0.27768540},  {0.5, 0.46474471},
                                                        {1.9, 0.50164620}, {2.05, 0.46195710}, {2.1, 0.40825029},
                                                        {2.3, 0.19687401}, {2.5, -0.00704989}};
  std::size_t next = 0;
  for (State const& now : simulate(arm.model, x, integrator, {.end_time = 2.5, .step = h}))
    if (next < exact.size() && now.t > exact[next].first - 1e-9) {
      held({"X14", "angle of the hinge [rad]", By::independent, "Radau IIA (scipy), rtol 1e-11", formulation},
           arm.angle(now), exact[next].second, 1e-5, {equals("t", exact[next].first), 0.5});
      ++next;
    }
  EXPECT_EQ(next, exact.size());
}
TEST(Servos, ServoPushesAnArmAgainstAStopAndLeavesIt) {
  servo_on_a_stop<Constraint>(Radau{}, 1e-3, "Servo, Constraint, Radau IIA");
  servo_on_a_stop<JointCoordinates>(GeneralisedAlpha{.rho_inf = 0.8}, 1e-4, "Servo, JointCoordinates, generalised-α");
}

// mujoco_menagerie#254: without compensation of gravity a PD servo rests where k_p (r − θ) = m g l sin θ.
TEST(Servos, PdServoRestsBelowItsTarget) {
  double const load = 1.5 * 9.81 * 0.5, kp = 25.0, target = 1.2;
  double rest = target;
  for (int i = 0; i < 100; ++i) rest = target - load * std::sin(rest) / kp;  // contraction by load/kp
  Hinge<Constraint, OnAngle<Servo<>>> arm(0.5, 1.5, 0.5);
  arm.model.apply(OnAngle<Servo<>>{{.target = {target}, .proportional_gain = kp, .derivative_gain = 8.0}}, arm.pin,
                  "servo");
  State x = arm.model.reference_state();
  equilibrium(arm.model, x);
  auto const claim = [](char const* formulation) {
    return by_formula("angle of an arm that a PD servo holds against gravity [rad]", "k_p (r − θ) = m g l sin θ",
                      formulation);
  };
  held(claim("equilibrium"), arm.angle(x), rest, 1e-9);
  held(claim("motion, generalised-α"), arm.angle(arm.after(6.0, GeneralisedAlpha{}, 0.01)), rest, 1e-6);
  EXPECT_GT(target - rest, 0.2);

  Hinge<Constraint, OnAngle<PidServo<>>> with_integral(0.5, 1.5, 0.5);
  auto const servo = with_integral.model.apply(OnAngle<PidServo<>>{{.target = {target},
                                                                    .proportional_gain = kp,
                                                                    .integral_gain = 30.0,
                                                                    .derivative_gain = 8.0,
                                                                    .tracking_time = 0.2}},
                                               with_integral.pin, "servo");
  State y = with_integral.model.reference_state();
  equilibrium(with_integral.model, y);
  EXPECT_NEAR(with_integral.angle(y), target, 1e-9);
  EXPECT_NEAR(with_integral.model.states(std::as_const(y), servo)[0], load * std::sin(target), 1e-6);
}

// A servo on a displacement and one on a distance share a weight: k₁ (r₁ − x) + k₂ (r₂ − x) = m g for the height x.
TEST(Servos, OnADisplacementAndOnADistanceShareAWeight) {
  using Slide = Joint<Prismatic>;
  Model<Bodies<Rigid<>>, Joints<Slide>, Forces<OnTranslation<Servo<>>, OnDistance<Servo<>>>> model{
      Gravity{0, 0, -9.81}};
  auto const body = model.add(Rigid<>(3.0, Mat3(Mat3::Identity()), Placement::at({0, 0, 1.0})), "weight");
  auto const slide =
      model.connect(Slide{Prismatic{.axis = Vec3::UnitZ()}}, model.ground().at({0, 0, 0}), body.at({0, 0, 0}), "slide");
  model.apply(OnTranslation<Servo<>>{{.target = {1.2}, .proportional_gain = 500.0, .derivative_gain = 20.0}}, slide,
              "first");
  model.apply(OnDistance<Servo<>>{{.target = {1.1}, .proportional_gain = 300.0, .derivative_gain = 20.0}},
              model.ground().at({0, 0, 0}), body.at({0, 0, 0}), "second");
  State x = model.reference_state();
  equilibrium(model, x);
  held(by_formula("height of a weight on two servos [m]", "k₁ (r₁ − x) + k₂ (r₂ − x) = m g", "equilibrium"), x.q[2],
       (500.0 * 1.2 + 300.0 * 1.1 - 3.0 * 9.81) / 800.0, 1e-9);
}

/// Compares angle, rate and last state of a servo at four times after a step of the target, and checks the energy.
template <class L>
void expect_step(L const& law, char const* what, double step, std::vector<Vec3> const& exact) {
  Hinge<Constraint, OnTurns<L>> arm(0.5);
  auto const servo = arm.model.apply(OnTurns<L>{law}, arm.pin, "servo");
  State x = arm.model.reference_state();
  std::vector<double> const times = {0.3, 0.6, 1.0, 1.5};
  std::size_t next = 0;
  EnergyAudit audit(arm.model);
  for (State const& now : simulate(arm.model, x, Radau{}, {.end_time = 1.5, .step = step})) {
    audit.record(now);
    if (next == times.size() || now.t < times[next] - 1e-9) continue;
    Instance const at{equals("t", times[next]), 1.0};
    auto const of = [&](char const* quantity) {
      return Claim{"drives", std::string(what) + ": " + quantity, By::independent, "Runge–Kutta of order 4, 10 µs",
                   "OnTurns, Radau IIA"};
    };
    held(of("angle [rad]"), arm.angle(now), exact[next][0], 1e-6, at);
    held(of("rate [rad/s]"), joint_angle_rate(arm.model, now, arm.pin), exact[next][1], 3e-6, at);
    held(of("state [N m]"), arm.model.states(now, servo).back(), exact[next][2], 1e-5, at);
    ++next;
  }
  EXPECT_EQ(next, times.size());
  EXPECT_GT(std::abs(audit.work_of_loads()), 0.0);
  EXPECT_LT(audit.relative(), 1e-6) << audit;
}
PidServo<> pid(double tracking_time) {
  return {.target = {1.0},
          .proportional_gain = 40.0,
          .integral_gain = 60.0,
          .derivative_gain = 6.0,
          .tracking_time = tracking_time,
          .most_force = 5.0};
}
// The values are those of servo.py. With T = 10¹² s, the integral winds up and the arm overshoots by more than 56 %.
TEST(Servos, AntiWindupKeepsThePidStepFromOvershooting) {
  expect_step(pid(0.2), "step of a PID servo with anti-windup", 2.5e-4,
              {{0.446020037, 2.757715525, -5.367286063},
               {0.967812331, 0.516295612, -1.224369990},
               {0.976686165, -0.041518884, -0.912160184},
               {0.988702521, 0.029747523, -0.317751498}});
  expect_step(pid(1e12), "step of a PID servo that winds up", 2.5e-4,
              {{0.45, 3.0, 15.3},
               {1.450732441, 2.283850866, 15.727409102},
               {1.564272787, -1.716149134, 0.347346363},
               {0.878030303, 0.166233492, -2.539609168}});
}
TEST(Servos, RateLimitedServoFollowsTheScript) {
  expect_step(
      RateLimited<Servo<>>{
          .law = {.target = {1.0}, .proportional_gain = 40.0, .derivative_gain = 6.0, .most_force = 5.0},
          .most_rate = 30.0,
          .lag = 0.02},
      "step of a servo with a bounded rate", 1e-4,
      {{0.244856072, 2.154677903, 4.999719095},
       {1.231645282, 3.674374780, -1.663912694},
       {2.039342357, 0.057357392, -4.999999882},
       {0.885863237, -3.867561212, 0.679037564}});
}

// Target of 50 rad: J ω̇ = k_d (most_speed − ω) until the target is near. No bound is exceeded on the way.
TEST(Servos, ServoRespectsTheBoundsOfSpeedAndForce) {
  double const inertia = 0.5, kd = 6.0, bound = 4.0, most_force = 15.0;
  using Law = OnTurns<Servo<>>;
  Hinge<Constraint, Law> arm(inertia);
  Law const law{{.target = {50.0},
                 .proportional_gain = 40.0,
                 .derivative_gain = kd,
                 .most_force = most_force,
                 .most_speed = bound}};
  auto const servo = arm.model.apply(law, arm.pin, "servo");
  State x = arm.model.reference_state();
  double fastest = 0.0, strongest = 0.0, turns = 0.0;
  double const corner = (bound - most_force / kd) * inertia / most_force;  // the torque leaves its bound
  for (State const& now : simulate(arm.model, x, Radau{}, {.end_time = 16.0, .step = 1e-2})) {
    double const rate = joint_angle_rate(arm.model, now, arm.pin);
    fastest = std::max(fastest, rate);
    strongest = std::max(strongest, std::abs(applied_wrenches(arm.model, now, servo)[1].m.norm()));
    turns = arm.model.states(now, servo)[0];
    if (now.t > 0.5 && now.t < 10.0 && std::abs(std::remainder(now.t, 1.0)) < 1e-6) {
      double const expected = bound - most_force / kd * std::exp(-kd / inertia * (now.t - corner));
      held(by_formula("speed of a servo at its bound of speed [rad/s]", "v − (Q/k_d) exp(−k_d (t − t₁)/J)",
                      "OnTurns, Radau IIA"),
           rate, expected, 3e-5, {equals("t", now.t)});
    }
  }
  EXPECT_LE(fastest, bound * (1.0 + 1e-12));
  EXPECT_GT(fastest, 0.999 * bound);
  EXPECT_LE(strongest, most_force * (1.0 + 1e-12));
  EXPECT_GT(strongest, 0.999 * most_force);
  EXPECT_NEAR(turns, 50.0, 1e-3);  // eight turns
}

}  // namespace servo_test
}  // namespace polybody
