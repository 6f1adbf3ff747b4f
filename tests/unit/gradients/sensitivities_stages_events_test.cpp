// Derivatives of runs with multi-stage methods, with breakpoints of driving constraints and loads, and with events.
#include <polybody/gradients/sensitivities.hpp>

#include <gtest/gtest.h>

#include <numbers>

#include <polybody/integrators/radau.hpp>

#include "support/moving_times.hpp"

using namespace polybody;

namespace sensitivities_stages_events_test {

using namespace moving_times;

TEST(SensitivitiesOfStagesThroughEvents, TheTimeOfAFallIsThatOfTheClosedForm) {
  expect_fall(RungeKutta4<>{});
  expect_fall(DormandPrince<>{});
  expect_fall(Radau{});
}
TEST(SensitivitiesOfStagesThroughEvents, BouncesFollowTheClosedForm) {
  expect_bounces(RungeKutta4<>{});
  expect_bounces(DormandPrince<>{});
  expect_bounces(Radau{});
}
TEST(SensitivitiesOfStagesThroughEvents, ImpactsOfAMechanismAreThoseOfItsRuns) {
  RungeKutta4<Projection> const classical;
  ASSERT_GE(sensitivities(stopped<Constraint>, of_stop, classical).run.events.size(), 3u);
  expect_derivatives_of_moving_runs(stopped<Constraint>, of_stop, classical, 1e-8, {0.25, 2.5, 0.25, 0.25});
  expect_derivatives_of_moving_runs(stopped<Constraint>, of_stop, Radau{}, 1e-8, {0.25, 2.5, 0.25, 0.25});
  expect_derivatives_of_moving_runs(stopped<Penalty>, of_stop, Radau{}, 1e-7, {0.25, 2.5, 0.25, 0.25});
}
TEST(SensitivitiesOfStagesThroughEvents, JumpsInSpaceAreThoseOfTheirRuns) {
  std::vector<Parameter> const parameters{{"spin [rad/s]", 3.0}, {"height [m]", 0.6}, {"gravity [m/s²]", 9.81}};
  expect_derivatives_of_moving_runs(spun, parameters, RungeKutta4<>{}, 1e-8, {0.75, 0.125, 2.5});
  expect_derivatives_of_moving_runs(spun, parameters, Radau{}, 1e-8, {0.75, 0.125, 2.5});
}
TEST(SensitivitiesOfStagesThroughEvents, AnEventUnderADriveIsThatOfItsRuns) {
  auto const s = sensitivities(braked, of_brake, RungeKutta4<Projection>{});
  ASSERT_GE(s.run.events.size(), 1u);
  EXPECT_LT(s.run.events[0].time, 0.2);  // the ramp continues
  expect_derivatives_of_moving_runs(braked, of_brake, RungeKutta4<Projection>{}, 3e-8, {0.025, 0.25, 2.5, 0.4});
  expect_derivatives_of_moving_runs(braked, of_brake, Radau{}, 3e-8, {0.025, 0.25, 2.5, 0.4});
}
TEST(SensitivitiesOfStagesThroughEvents, LengthsOfStepsAndOfTheRunAreParameters) {
  expect_lengths_as_parameters(RungeKutta4<Projection>{}, 0.05);
  expect_lengths_as_parameters(Radau{}, 0.1);
}

/// The outputs of `stopped` at the end of a run with prescribed step lengths: those of a run for other parameters,
/// multiplied by `times`. A run that ended at an event ends at its own event time.
template <class I>
VecX end_of_frozen_run(std::span<double const> p, I const& integrator, SensitivityResult const& chosen) {
  auto scenario = stopped<Constraint>(p);
  System system(scenario.model, with<Capabilities::motion>);
  auto work = integrator.template workspace<DefaultSolver>(system);
  State x = scenario.start;
  auto const restart = [&] {
    work.forward.project_velocities(system, x.q, x.v, x.t);
    integrator.start(system, x, 0.0, work);
  };
  auto const after = [&](double h) {
    State y = x;
    EXPECT_EQ(integrator.step(system, y, h, work).taken, h);
    return y;
  };
  restart();
  std::size_t met = 0;
  for (std::size_t n = 1; n < chosen.times.size(); ++n) {
    double h = chosen.times[n] - chosen.times[n - 1];
    bool const at_event = met < chosen.run.events.size() && chosen.times[n] == chosen.run.events[met].time;
    if (n + 1 == chosen.times.size()) h = scenario.options.end_time - x.t;
    if (!at_event) {
      x = after(h);
      continue;
    }
    Event const& event = scenario.options.events[chosen.run.events[met++].name == "stop" ? 0 : 1];
    double lo = 0.9 * h, hi = 1.1 * h, before = event.value(after(lo));
    for (int k = 0; k < 60; ++k) {
      double const mid = 0.5 * (lo + hi), value = event.value(after(mid));
      ((value > 0.0) == (before > 0.0) ? lo : hi) = mid;
    }
    x = after(hi);
    if (event.action) event.action(x);
    restart();
  }
  return detail::values_of_outputs(scenario, x);
}
TEST(SensitivitiesOfStagesThroughEvents, ChosenStepsAreFrozenButForThoseThatEndAtEvents) {
  DormandPrince<Projection> integrator{.relative_tolerance = 1e-6, .absolute_tolerance = 1e-8};
  auto const make = [](P p) {
    auto scenario = stopped<Constraint>(p);
    scenario.options.max_step = 0.05;
    return scenario;
  };
  SensitivityResult const s = sensitivities(make, of_stop, integrator);
  ASSERT_GE(s.run.events.size(), 3u);
  integrator.relative_tolerance = integrator.absolute_tolerance = 1e6;
  for (std::size_t j = 0; j < of_stop.size(); ++j) {
    VecX expected = VecX::Zero(3);
    double const e = 2e-4 * of_stop[j].size();
    for (std::size_t k = 0; k < 4; ++k) {
      std::vector<double> p = detail::values_of(of_stop);
      p[j] += FourPoints::places[k] * e;
      expected += FourPoints::weights[k] / e * end_of_frozen_run(p, integrator, s);
    }
    EXPECT_LT((s.derivatives.back().col(Index(j)) - expected).norm(), 1e-8 * expected.norm()) << of_stop[j].name;
  }
}

/// A force pulse of a few hundredths of a second, about t = 0.5 s.
struct Bump {
  void check(std::string const&) const {}
  Motion operator()(double t) const {
    double const s = (t - 0.5) / 0.02;
    return {std::exp(-s * s), 0.0, 0.0};
  }
};
/// A mass of 2 kg that is thrown at 1 m/s and pushed in flight. Parameters: speed, push, and the position at which it
/// is stopped.
auto const bumped = [](P p) {
  using M = Model<Bodies<planar::Rigid>, Joints<>, Forces<PointForce<Bump>>>;
  M model;
  auto const mass = model.add(planar::Rigid(2.0, 1.0, Placement::at({0, 0, 0})), "mass");
  model.apply(PointForce<Bump>{.force = {p[1], 0, 0}}, mass.at(Vec2(0, 0)), "push");
  State start = model.reference_state();
  start.v[0] = p[0];
  Event const there{.name = "there", .value = [at = p[2]](State const& x) { return x.q[0] - at; }, .terminal = true};
  std::vector<Output<M>> outputs{{"v [m/s]", [](M const&, State const& x) { return x.v[0]; }}};
  RunOptions const options{.end_time = 2.0, .step = 1.0, .max_step = 0.2, .events = {there}};
  return Scenario<M>{std::move(model), start, options, std::move(outputs)};
};
TEST(SensitivitiesOfStagesThroughEvents, GoOverAllStepsThatLeadToAnEvent) {
  // The step that leads to the pulse is divided.
  double const v = 1.0, push = 20.0, at = 0.7, impulse = push * 0.02 * std::sqrt(std::numbers::pi) / 2.0;
  SensitivityResult const s = sensitivities(bumped, {{"v [m/s]", v}, {"push [N]", push}, {"at [m]", at}},
                                            DormandPrince<>{.relative_tolerance = 1e-10, .absolute_tolerance = 1e-12});
  ASSERT_GT(s.times.size(), 5u);
  double const t = s.times.back(), after = v + impulse;  // at = v t + impulse (t − 0.5 s)
  EXPECT_NEAR(t, (at + 0.5 * impulse) / after, 1e-6);
  VecX const& by = s.time_derivatives.back();
  EXPECT_NEAR(by[0], -t / after, 1e-6);
  EXPECT_NEAR(by[1], -impulse / push * (t - 0.5) / after, 1e-6);
  EXPECT_NEAR(by[2], 1.0 / after, 1e-6);
  EXPECT_NEAR(s.derivatives.back()(0, 0), 1.0, 1e-6);
  EXPECT_NEAR(s.derivatives.back()(0, 1), impulse / push, 1e-6);
  EXPECT_NEAR(s.derivatives.back()(0, 2), 0.0, 1e-6);
}

TEST(SensitivitiesOfStagesThroughCorners, APushThatEndsAtAParameterIsExact) {
  expect_push(RungeKutta4<>{});
  expect_push(DormandPrince<>{});
  expect_push(Radau{});
}
TEST(SensitivitiesOfStagesThroughCorners, ARampOfADriveIsThatOfItsRuns) {
  expect_derivatives_of_moving_runs(driven<Constraint>, of_drive, RungeKutta4<Projection>{}, 3e-8,
                                    {0.025, 0.25, 0.25, 2.5});
  expect_derivatives_of_moving_runs(driven<Constraint>, of_drive, Radau{}, 3e-8, {0.025, 0.25, 0.25, 2.5});
  expect_derivatives_of_moving_runs(driven<Penalty>, of_drive, Radau{}, 3e-8, {0.025, 0.25, 0.25, 2.5});
}

/// Times and outputs equal those of `simulate`.
template <class Make, class I>
void expect_run_of_simulation(Make const& make, std::vector<Parameter> const& parameters, I const& integrator) {
  SensitivityResult const s = sensitivities(make, parameters, integrator);
  auto scenario = make(detail::values_of(parameters));
  State x = scenario.start;
  std::size_t n = 0;
  for (State const& now : simulate(scenario.model, x, integrator, scenario.options)) {
    ASSERT_LT(n, s.times.size());
    EXPECT_NEAR(s.times[n], now.t, 1e-14);
    EXPECT_LT((s.values[n] - detail::values_of_outputs(scenario, now)).norm(), 1e-11 * s.values[n].norm());
    ++n;
  }
  EXPECT_EQ(n, s.times.size());
}
TEST(SensitivitiesOfStages, TakeTheRunOfASimulation) {
  expect_run_of_simulation(stopped<Constraint>, of_stop, RungeKutta4<Projection>{});
  expect_run_of_simulation(stopped<Constraint>, of_stop, DormandPrince<Projection>{});
  expect_run_of_simulation(stopped<Constraint>, of_stop, Radau{.tolerance = 1e-12});
  expect_run_of_simulation(driven<Constraint>, of_drive, DormandPrince<Projection>{});
}

TEST(SensitivitiesOfStagesThroughEvents, RefuseWhatHasNoDerivative) {
  expect_refusals(RungeKutta4<>{});
  expect_refusals(DormandPrince<>{});
  expect_refusals(Radau{});
}

}  // namespace sensitivities_stages_events_test
