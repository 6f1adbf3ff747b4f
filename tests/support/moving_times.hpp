#pragma once
// Scenarios of runs whose times depend on their parameters: impacts on the floor, pushes that end, driving
// constraints with ramps, stops.

#include <polybody/gradients/sensitivities.hpp>

#include <gtest/gtest.h>

#include <polybody/bodies/rigid/planar_rigid.hpp>
#include <polybody/bodies/rigid/rigid.hpp>
#include <polybody/forces/loads.hpp>
#include <polybody/joints/driving_constraints.hpp>
#include <polybody/joints/planar/joints.hpp>
#include <polybody/joints/policies/penalty.hpp>
#include <polybody/joints/policies/policy.hpp>
#include <polybody/math/time_functions.hpp>
#include <polybody/run/probe.hpp>

#include "support/differences_of_runs.hpp"
#include "support/refusal.hpp"

namespace polybody::moving_times {

using P = std::span<double const>;

/// Derivative f′ of a closed form with respect to the j-th parameter, by fourth-order differences.
template <class F>
double slope_of(F const& f, std::vector<double> p, std::size_t j) {
  double const at = p[j], e = 1e-3 * std::abs(at);
  double sum = 0.0;
  for (std::size_t k = 0; k < 4; ++k) {
    p[j] = at + FourPoints::places[k] * e;
    sum += FourPoints::weights[k] / e * f(p);
  }
  return sum;
}

// --- a mass that falls on the floor ------------------------------------------------------------------------------

/// Parameters: gravity, height, and the share of the velocity that remains after an impact.
template <bool bounces>
inline auto const ball = [](P p) {
  using M = Model<Bodies<planar::Rigid>, Joints<>>;
  M model{Gravity{0, -p[0], 0}};
  model.add(planar::Rigid(2.0, 1.0, Placement::at({0, p[1], 0})), "ball");
  State const start = model.reference_state();
  Event floor{
      .name = "floor", .value = [](State const& x) { return x.q[1]; }, .terminal = !bounces, .tolerance = 1e-15};
  if (bounces) floor.action = [e = p[2]](State& x) { x.v[1] *= -e; };
  std::vector<Output<M>> outputs{{"y [m]", [](M const&, State const& x) { return x.q[1]; }},
                                 {"v [m/s]", [](M const&, State const& x) { return x.v[1]; }}};
  return Scenario<M>{
      std::move(model), start, {.end_time = 1.7, .step = 1e-2, .max_step = 0.1, .events = {floor}}, std::move(outputs)};
};
inline std::vector<Parameter> const of_ball{{"gravity [m/s²]", 9.81}, {"height [m]", 1.0}, {"restitution [1]", 0.8}};

/// Time of the n-th impact of the ball.
inline double time_of_bounce(std::vector<double> const& p, int n) {
  double t = std::sqrt(2.0 * p[1] / p[0]), next = 2.0 * t;
  for (int i = 1; i < n; ++i) t += next *= p[2];
  return t;
}
/// Height and velocity at a time t between the n-th and the next impact.
inline std::array<double, 2> flight(std::vector<double> const& p, int n, double t) {
  double const after = t - time_of_bounce(p, n), v = std::pow(p[2], n) * std::sqrt(2.0 * p[0] * p[1]);
  return {v * after - 0.5 * p[0] * after * after, v - p[0] * after};
}

/// The time of a fall equals that of the closed form.
template <class I>
void expect_fall(I const& integrator) {
  SensitivityResult const s = sensitivities(ball<false>, of_ball, integrator);
  double const g = 9.81, t = std::sqrt(2.0 / g);
  ASSERT_TRUE(s.run.stopped);
  EXPECT_NEAR(s.times.back(), t, 1e-13);
  VecX const& by = s.time_derivatives.back();
  EXPECT_NEAR(by[0], -0.5 * t / g, 1e-11);
  EXPECT_NEAR(by[1], 0.5 * t, 1e-11);
  EXPECT_EQ(by[2], 0.0);
  // at the end of the run the ball is on the floor for all parameters, with the speed √(2gh)
  EXPECT_NEAR(s.derivatives.back()(0, 0), 0.0, 1e-11);
  EXPECT_NEAR(s.derivatives.back()(0, 1), 0.0, 1e-11);
  EXPECT_NEAR(s.derivatives.back()(1, 0), -1.0 / std::sqrt(2.0 * g), 1e-11);
  EXPECT_NEAR(s.derivatives.back()(1, 1), -g / std::sqrt(2.0 * g), 1e-11);
  // times before the impact do not depend on the parameters
  EXPECT_TRUE(s.time_derivatives[s.times.size() / 2].isZero(0.0));
}

/// Bounces agree with the closed form.
template <class I>
void expect_bounces(I const& integrator) {
  std::vector<double> const p{9.81, 1.0, 0.8};
  SensitivityResult const s = sensitivities(ball<true>, of_ball, integrator);
  ASSERT_EQ(s.run.events.size(), 2u);
  for (int n = 1; n <= 2; ++n) {
    double const t = s.run.events[std::size_t(n - 1)].time;
    EXPECT_NEAR(t, time_of_bounce(p, n), 1e-12);
    std::size_t const i = std::size_t(std::find(s.times.begin(), s.times.end(), t) - s.times.begin());
    ASSERT_LT(i, s.times.size());
    for (std::size_t j = 0; j < 3; ++j)
      EXPECT_NEAR(s.time_derivatives[i][Index(j)], slope_of([&](auto const& q) { return time_of_bounce(q, n); }, p, j),
                  1e-10)
          << n << ' ' << j;
  }
  EXPECT_EQ(s.times.back(), 1.7);
  for (std::size_t j = 0; j < 3; ++j) {
    EXPECT_NEAR(s.time_derivatives.back()[Index(j)], 0.0, 1e-12);
    for (std::size_t i = 0; i < 2; ++i)
      EXPECT_NEAR(s.derivatives.back()(Index(i), Index(j)),
                  slope_of([&](auto const& q) { return flight(q, 2, 1.7)[i]; }, p, j), 1e-9)
          << i << ' ' << j;
  }
}

// --- breakpoints -------------------------------------------------------------------------------------------------

template <class Policy>
Policy policy_of_pins() {
  if constexpr (std::is_same_v<Policy, Penalty>)
    return {.stiffness = 1e6, .damping = 1e3};
  else
    return {};
}

/// A free mass that a force pushes until T: v = F T/m, x = F T/m (t − T/2).
inline auto const pushed = [](P p) {
  using M = Model<Bodies<planar::Rigid>, Joints<>, Forces<PointForce<Window>>>;
  M model;
  auto const mass = model.add(planar::Rigid(p[2], 1.0, Placement::at({0, 0, 0})), "mass");
  model.apply(PointForce<Window>{.force = {p[1], 0, 0}, .law = {.from = 0.0, .to = p[0]}}, mass.at(Vec2(0, 0)), "push");
  State const start = model.reference_state();
  std::vector<Output<M>> outputs{{"x [m]", [](M const&, State const& x) { return x.q[0]; }},
                                 {"v [m/s]", [](M const&, State const& x) { return x.v[0]; }},
                                 {"a [m/s²]", [](M const&, State const& x) { return x.a[0]; }}};
  return Scenario<M>{std::move(model), start, {.end_time = 0.8, .step = 1e-2}, std::move(outputs)};
};

/// The derivative with respect to the end time of a push is exact.
template <class I>
void expect_push(I const& integrator) {
  double const T = 0.3137, F = 3.0, m = 2.0, end = 0.8;
  // the finite difference moves the breakpoint by 0.06 steps, or by 6
  for (double const scale : {0.75, 75.0}) {
    SensitivityResult const s = sensitivities(pushed, {{"T [s]", T, scale}, {"F [N]", F}, {"m [kg]", m}}, integrator);
    MatX const& by = s.derivatives.back();
    EXPECT_NEAR(by(0, 0), F / m * (end - T), 1e-11);
    EXPECT_NEAR(by(1, 0), F / m, 1e-11);
    EXPECT_NEAR(by(2, 0), 0.0, 1e-11);
    EXPECT_NEAR(by(0, 1), T / m * (end - 0.5 * T), 1e-11);
    EXPECT_NEAR(by(1, 1), T / m, 1e-11);
    EXPECT_NEAR(by(0, 2), -F * T / (m * m) * (end - 0.5 * T), 1e-11);
    std::size_t const at = std::size_t(std::find(s.times.begin(), s.times.end(), T) - s.times.begin());
    ASSERT_LT(at, s.times.size());
    EXPECT_NEAR(s.time_derivatives[at][0], 1.0, 1e-12);
    EXPECT_NEAR(s.derivatives[at](0, 0), F * T / m, 1e-11);
    EXPECT_NEAR(s.derivatives[at](2, 0), 0.0, 1e-11);  // after the end of the push
    EXPECT_NEAR(s.time_derivatives.back()[0], 0.0, 1e-12);
  }
}

/// A crank that a ramp rotates, and a rod that swings on it. Parameters: the ramp's duration, its angle, the rod's
/// length, gravity.
template <class Policy>
inline auto const driven = [](P p) {
  using Pin = Joint<planar::Revolute, Policy>;
  using Drive = Joint<PrescribedAngle<Ramp>, Constraint>;
  using M = Model<Bodies<planar::Rigid>, Joints<Pin, Drive>>;
  M model{Gravity{0, -p[3], 0}};
  Bar bar{.length = 0.3, .section = Circle{.radius = 0.01}, .material = Material{.density = 7800.0, .young = 2e11}};
  auto const crank = model.add(planar::Rigid::from(bar), "crank");
  bar.placement = Placement::at({0.3, 0, 0});
  bar.length = p[2];
  auto const rod = model.add(planar::Rigid::from(bar), "rod");
  Policy const policy = policy_of_pins<Policy>();
  model.connect(Pin{planar::Revolute{}, policy}, model.ground().at({0, 0, 0}), crank.at(0.0), "pin");
  model.connect(Pin{planar::Revolute{}, policy}, crank.at(0.3), rod.at(0.0), "hinge");
  model.connect(Drive{PrescribedAngle<Ramp>{.law = {.target = p[1], .duration = p[0], .start = 0.05}}, Constraint{}},
                model.ground().at({0, 0, 0}), crank.at(0.0), "drive");
  State const start = model.reference_state();
  double const l = p[2];
  std::vector<Output<M>> outputs{
      {"tip x [m]", [rod, l](M const& m, State const& x) { return position(m, x, rod.at(l))[0]; }},
      {"tip y [m]", [rod, l](M const& m, State const& x) { return position(m, x, rod.at(l))[1]; }},
      {"spin [rad/s]", [](M const&, State const& x) { return x.v[5]; }}};
  return Scenario<M>{std::move(model), start, {.end_time = 0.4, .step = 4e-3}, std::move(outputs)};
};
/// The ramp ends at 0.2031 s.
inline std::vector<Parameter> const of_drive{
    {"duration [s]", 0.1531}, {"angle [rad]", 0.5}, {"length [m]", 0.4}, {"gravity [m/s²]", 9.81}};

/// Comparison with finite differences of runs. The differences, scaled by `scales`, keep each breakpoint and event
/// within its step.
template <class Make, class I>
void expect_derivatives_of_moving_runs(Make const& make, std::vector<Parameter> const& parameters, I const& integrator,
                                       double tolerance, std::vector<double> const& scales) {
  SensitivityResult const s = sensitivities(make, parameters, integrator);
  auto near = parameters;
  for (std::size_t j = 0; j < scales.size(); ++j) near[j].scale = scales[j];
  MatX const expected = by_differences(make, near, integrator);
  for (Index j = 0; j < expected.cols(); ++j)
    EXPECT_LT((s.derivatives.back().col(j) - expected.col(j)).norm(), tolerance * expected.col(j).norm())
        << parameters[std::size_t(j)].name << ": " << s.derivatives.back().col(j).transpose() << " for "
        << expected.col(j).transpose();
}

// --- events of mechanisms ----------------------------------------------------------------------------------------

/// A rod on a pin, released horizontally, that hits a stop. Parameters: length, gravity, angle of the stop,
/// restitution.
template <class Policy>
inline auto const stopped = [](P p) {
  using Pin = Joint<planar::Revolute, Policy>;
  using M = Model<Bodies<planar::Rigid>, Joints<Pin>>;
  M model{Gravity{0, -p[1], 0}};
  Policy const policy = policy_of_pins<Policy>();
  auto const rod = model.add(
      planar::Rigid::from(
          {.length = p[0], .section = Circle{.radius = 0.01}, .material = Material{.density = 7800.0, .young = 2e11}}),
      "rod");
  model.connect(Pin{planar::Revolute{}, policy}, model.ground().at({0, 0, 0}), rod.at(0.0), "pin");
  State const start = model.reference_state();
  Event const stop{.name = "stop",
                   .value = [at = p[2]](State const& x) { return x.q[2] + at; },
                   .tolerance = 1e-15,
                   .action = [e = p[3]](State& x) { x.v *= -e; }};
  Event const half{.name = "half way", .value = [](State const& x) { return x.q[2] + 1.2; }, .tolerance = 1e-15};
  double const l = p[0];
  std::vector<Output<M>> outputs{
      {"angle [rad]", [](M const&, State const& x) { return x.q[2]; }},
      {"spin [rad/s]", [](M const&, State const& x) { return x.v[2]; }},
      {"tip x [m]", [rod, l](M const& m, State const& x) { return position(m, x, rod.at(l))[0]; }}};
  return Scenario<M>{
      std::move(model), start, {.end_time = 0.9, .step = 5e-3, .events = {stop, half}}, std::move(outputs)};
};
inline std::vector<Parameter> const of_stop{
    {"length [m]", 1.2}, {"gravity [m/s²]", 9.81}, {"angle [rad]", 1.4}, {"restitution [1]", 0.6}};

/// The driven crank. The rod loses half its velocity at a given angle during the ramp. Parameters: the ramp's
/// duration, its angle, gravity, and the given angle.
inline auto const braked = [](P p) {
  auto scenario = driven<Constraint>(std::array{p[0], p[1], 0.4, p[2]});
  scenario.options.events = {{.name = "passes",
                              .value = [at = p[3]](State const& x) { return x.q[5] + at; },
                              .tolerance = 1e-15,
                              .action = [](State& x) { x.v[5] *= 0.5; }}};
  return scenario;
};
inline std::vector<Parameter> const of_brake{
    {"duration [s]", 0.1531}, {"angle [rad]", 0.5}, {"gravity [m/s²]", 9.81}, {"place [rad]", 0.3}};

/// A rod that spins as it falls in space, and loses a part of its spin at a given height. Parameters: spin, height,
/// gravity.
inline auto const spun = [](P p) {
  using M = Model<Bodies<Rigid<>>, Joints<>>;
  M model{Gravity{0, 0, -p[2]}};
  auto const rod = model.add(Rigid<>(2.0, Mat3(Vec3(0.3, 0.5, 0.4).asDiagonal()), Placement::at({0, 0, 1})), "rod");
  State start = model.reference_state();
  model.set_velocity(start, rod, {0.2, 0, 0}, {p[0], 2.0, 0.5});
  Event const passes{.name = "passes",
                     .value = [h = p[1]](State const& x) { return x.q[2] + 0.1 * x.q[4] - h; },
                     .tolerance = 1e-15,
                     .action = [](State& x) { x.v.tail<3>() *= 0.5; }};
  std::vector<Output<M>> outputs{
      {"x [m]", [rod](M const& m, State const& x) { return position(m, x, rod.at(Vec3(0.5, 0, 0)))[0]; }},
      {"z [m]", [rod](M const& m, State const& x) { return position(m, x, rod.at(Vec3(0, 0.5, 0)))[2]; }}};
  return Scenario<M>{std::move(model), start, {.end_time = 0.5, .step = 5e-3, .events = {passes}}, std::move(outputs)};
};

/// The lengths of steps and of the run are parameters. \param step of the rod: long enough for a measurable error [s]
template <class I>
void expect_lengths_as_parameters(I const& integrator, double step) {
  // x(T) of a mass that is thrown: the method is exact for any step length
  auto const thrown = [](P p) {
    auto scenario = ball<false>(std::array{9.81, 100.0, 0.0});
    scenario.options.end_time = p[0];
    scenario.options.step = p[1];
    scenario.start.t = p[2];
    return scenario;
  };
  SensitivityResult const s =
      sensitivities(thrown, {{"until [s]", 0.505}, {"step [s]", 0.01}, {"start [s]", 0.1}}, integrator);
  double const v = -9.81 * 0.405;
  EXPECT_NEAR(s.time_derivatives.back()[0], 1.0, 1e-12);
  EXPECT_NEAR(s.time_derivatives[1][2], 1.0, 1e-12);
  EXPECT_NEAR(s.time_derivatives[2][1], 2.0, 1e-12);
  // the round-off is one unit in the last place of 100 m, over the size of the differences
  EXPECT_NEAR(s.derivatives.back()(0, 0), v, 1e-9);
  EXPECT_NEAR(s.derivatives.back()(0, 1), 0.0, 1e-9);
  EXPECT_NEAR(s.derivatives.back()(0, 2), -v, 1e-9);
  // also of a rod, whose error depends on the step length; finite differences of its runs scatter by 2e-7
  auto const swung = [](P p) {
    auto scenario = stopped<Constraint>(std::array{1.2, 9.81, 10.0, 0.5});
    scenario.options.end_time = p[0];
    scenario.options.step = p[1];
    return scenario;
  };
  expect_derivatives_of_moving_runs(swung, {{"until [s]", 0.508}, {"step [s]", step}}, integrator, 5e-7,
                                    {0.025, 0.5 * step});
}

// --- refusals ----------------------------------------------------------------------------------------------------

/// Quantities without a derivative are refused.
template <class I>
void expect_refusals(I const& integrator) {
  auto const said = [&](auto const& value_of_p, std::vector<Event> const& more = {}) {
    auto const make = [&](P p) {
      auto scenario = ball<false>(std::array{9.81, 100.0, 0.0});
      scenario.options.events = {
          {.name = "first", .value = [&value_of_p, p0 = p[0]](State const& x) { return value_of_p(x, p0); }}};
      for (Event const& e : more) scenario.options.events.push_back(e);
      return scenario;
    };
    return refusal([&] { sensitivities(make, {{"p [s]", 0.5}}, integrator); });
  };
  EXPECT_TRUE(has(said([](State const& x, double p) { return std::pow(x.t - p - 1e-3, 3); }),
                  "the event \"first\" only touches zero at t = 0.501"));
  Event const second{.name = "second", .value = [](State const& x) { return x.t - 0.503; }};
  EXPECT_TRUE(has(said([](State const& x, double p) { return x.t - p - 0.003; }, {second}),
                  "events \"first\" and \"second\" coincide at t = 0.503"));
  EXPECT_TRUE(has(said([](State const& x, double p) { return x.t - p - 1.2; }),
                  "an event coincides with a breakpoint or with the end of the run at t ="));

  auto const scenario_with = [](auto const& change) {
    return [change](P p) {
      auto scenario = pushed(std::array{0.3137, 3.0, 2.0});
      change(scenario.options, p[0]);
      return scenario;
    };
  };
  auto const refused = [&](auto const& make) {
    return refusal([&] { sensitivities(make, {{"p [s]", 0.5}}, integrator); });
  };
  EXPECT_TRUE(has(refused(scenario_with([](RunOptions& o, double p) { o.breakpoints = {p, 0.5}; })),
                  "a change of \"p [s]\" separates them"));
  EXPECT_TRUE(has(refused(scenario_with([](RunOptions& o, double p) { o.breakpoints = {p, 0.5003}; })),
                  "change their order within the difference step of \"p [s]\""));
  EXPECT_TRUE(has(refused(scenario_with([](RunOptions& o, double p) {
                    o.end_time = 0.5;
                    o.breakpoints = {p};
                  })),
                  "a breakpoint at the end of the run, t = 0.5 s, moves"));
  EXPECT_TRUE(has(refused(scenario_with([](RunOptions& o, double) { o.max_step_halvings = 3; })), "halved steps"));
}

}  // namespace polybody::moving_times
