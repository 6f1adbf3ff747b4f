// The adjoint gradient of runs with breakpoints of driving constraints and loads and with events, against forward
// sensitivities.
#include <polybody/gradients/gradient.hpp>

#include <gtest/gtest.h>

#include <polybody/integrators/generalised_alpha.hpp>

#include "support/impacts_of_whole_states.hpp"
#include "support/moving_times.hpp"

using namespace polybody;

namespace gradient_events_test {

using namespace moving_times;

/// A scenario whose objective function contains all outputs at the end, and the integral of the first output if this
/// output does not jump.
template <bool integrates = true, class Make>
auto rated_by_outputs(Make const& make) {
  return [make](P p) {
    auto scenario = make(p);
    using M = std::remove_cvref_t<decltype(scenario.model)>;
    auto const outputs = scenario.outputs;
    auto const end = [outputs](M const& model, State const& x) {
      double sum = 0.0;
      for (std::size_t i = 0; i < outputs.size(); ++i) sum += double(i + 1) * outputs[i].value(model, x);
      return sum;
    };
    double const weight = integrates ? 1.0 : 0.0;
    auto const way = [weight, first = outputs[0]](M const& model, State const& x) {
      return weight * first.value(model, x);
    };
    return with_objective(Scenario<M>(std::move(scenario)), end, way);
  };
}

/// Value and derivative of this objective function by forward sensitivities. The integral includes the derivatives of
/// the step lengths.
inline std::pair<double, VecX> by_direct_differentiation(SensitivityResult const& s, bool integrates) {
  double value = 0.0;
  VecX derivatives = VecX::Zero(s.derivatives[0].cols());
  for (Index i = 0; i < s.values.back().size(); ++i) {
    value += double(i + 1) * s.values.back()[i];
    derivatives += double(i + 1) * s.derivatives.back().row(i).transpose();
  }
  for (std::size_t k = 1; integrates && k < s.times.size(); ++k) {
    double const h = s.times[k] - s.times[k - 1], mean = 0.5 * (s.values[k][0] + s.values[k - 1][0]);
    value += h * mean;
    derivatives += 0.5 * h * (s.derivatives[k].row(0) + s.derivatives[k - 1].row(0)).transpose() +
                   mean * (s.time_derivatives[k] - s.time_derivatives[k - 1]);
  }
  return {value, derivatives};
}

template <bool integrates = true, class Make, class I>
void expect_direct_derivatives(Make const& make, std::vector<Parameter> const& parameters, I const& integrator,
                               double within = 1e-10) {
  auto const [value, derivatives] = by_direct_differentiation(sensitivities(make, parameters, integrator), integrates);
  GradientResult const g = gradient(rated_by_outputs<integrates>(make), parameters, integrator);
  EXPECT_NEAR(g.value, value, 1e-12 * (1.0 + std::abs(value)));
  EXPECT_LT(g.left, 1e-10);
  for (std::size_t j = 0; j < parameters.size(); ++j) {
    double const size = parameters[j].size();
    EXPECT_NEAR(size * g.derivatives[Index(j)], size * derivatives[Index(j)],
                within * (1.0 + std::abs(size * derivatives[Index(j)])))
        << parameters[j].name;
  }
}

TEST(GradientThroughEvents, BouncesFollowDirectDifferentiation) {
  expect_direct_derivatives(ball<true>, of_ball, GeneralisedAlpha{});
  expect_direct_derivatives(ball<true>, of_ball, Newmark{});
}
TEST(GradientThroughEvents, AFallThatEndsTheRunFollowsDirectDifferentiation) {
  expect_direct_derivatives(ball<false>, of_ball, GeneralisedAlpha{.rho_inf = 0.6});
}
TEST(GradientThroughCorners, APushFollowsDirectDifferentiation) {
  expect_direct_derivatives(pushed, {{"T [s]", 0.3137}, {"F [N]", 3.0}, {"m [kg]", 2.0}},
                            GeneralisedAlpha{.rho_inf = 0.7});
}
TEST(GradientThroughCorners, ARampOfADriveFollowsDirectDifferentiation) {
  expect_direct_derivatives(driven<Constraint>, of_drive, GeneralisedAlpha{.rho_inf = 0.7});
  // on stiff pins the forward sensitivities are accurate to 1e-8 only: they change by this amount with the size of
  // the difference
  expect_direct_derivatives(driven<Penalty>, of_drive, Trapezoidal{}, 1e-8);
}
TEST(GradientThroughEvents, ImpactsOfAMechanismFollowDirectDifferentiation) {
  expect_direct_derivatives(stopped<Constraint>, of_stop, GeneralisedAlpha{.rho_inf = 0.7});
  expect_direct_derivatives(stopped<Penalty>, of_stop, Newmark{});
}
TEST(GradientThroughEvents, AnEventUnderADriveFollowsDirectDifferentiation) {
  expect_direct_derivatives(braked, of_brake, GeneralisedAlpha{.rho_inf = 0.7});
}
TEST(GradientThroughEvents, AnEventMayChangeTheStateByItsForces) {
  auto const pulled = [](P p) {
    auto scenario = stopped<Constraint>(std::array{1.2, p[0], p[1], 0.6});
    scenario.options.events[0].action = [k = p[2]](State& x) { x.v *= -k * (0.01 * x.lambda.norm() + 0.02 * x.a[2]); };
    return scenario;
  };
  // multipliers contain the round-off of the constraint equations over βh²: both derivatives change by 1.4e-7 from
  // solver to solver
  expect_direct_derivatives(pulled, {{"gravity [m/s²]", 9.81}, {"angle [rad]", 1.4}, {"factor [1]", 0.3}},
                            GeneralisedAlpha{.rho_inf = 0.7}, 1e-6);
}
TEST(GradientThroughEvents, JumpsInSpaceFollowDirectDifferentiation) {
  expect_direct_derivatives(spun, {{"spin [rad/s]", 3.0}, {"height [m]", 0.6}, {"gravity [m/s²]", 9.81}},
                            GeneralisedAlpha{});
}
TEST(GradientThroughEvents, LengthsOfStepsAndOfTheRunAreParameters) {
  auto const swung = [](P p) {
    auto scenario = stopped<Constraint>(std::array{1.2, 9.81, 10.0, 0.5});
    scenario.options.end_time = p[0];
    scenario.options.step = p[1];
    scenario.start.t = p[2];
    return scenario;
  };
  // the start correction for the jerk uses a finite difference over a part of a step; its round-off is 1e-10 of the
  // generalised velocities
  expect_direct_derivatives(swung, {{"until [s]", 0.508}, {"step [s]", 0.01, 0.1}, {"start [s]", 0.0, 0.1}},
                            GeneralisedAlpha{}, 1e-9);
  expect_direct_derivatives(swung, {{"until [s]", 0.508}, {"step [s]", 0.01, 0.1}, {"start [s]", 0.0, 0.1}},
                            GeneralisedAlpha{.start_correction = false}, 2e-10);
}
TEST(GradientThroughEvents, CornersOfOptionsAtFixedTimesFollowDirectDifferentiation) {
  auto const swung = [](P p) {
    auto scenario = stopped<Constraint>(std::array{p[0], p[1], 10.0, 0.5});
    scenario.options.breakpoints = {0.2013, 0.31};
    return scenario;
  };
  expect_direct_derivatives(swung, {{"length [m]", 1.2}, {"gravity [m/s²]", 9.81}}, GeneralisedAlpha{});
}
TEST(GradientThroughEvents, ImpactsOfWholeStatesFollowDirectDifferentiation) {
  expect_direct_derivatives(nut_on_thread, of_nut, GeneralisedAlpha{});
  // after the impact of cables stiff terms dominate the change of the accelerations; these derivatives contain
  // round-off
  expect_direct_derivatives<false>(impact_of_cables(2e-3), of_impact, GeneralisedAlpha{.rho_inf = 0.6}, 1e-9);
}

TEST(GradientThroughEvents, ABounceIsThatOfTheClosedForm) {
  auto const rated_ball = [](P p) {
    auto scenario = ball<true>(p);
    using M = std::remove_cvref_t<decltype(scenario.model)>;
    auto const height = [](auto const&, auto const& x) { return x.q[1]; };
    auto const falls = [](auto const&, auto const& x) { return x.v[1]; };
    return with_objective(Scenario<M>(std::move(scenario)), height, falls);
  };
  GradientResult const g = gradient(rated_ball, of_ball, GeneralisedAlpha{});
  std::vector<double> const p{9.81, 1.0, 0.8};
  // v is linear between impacts, so the sum over steps is exact: ∫v dt = y − h, although v jumps
  EXPECT_NEAR(g.value, 2.0 * flight(p, 2, 1.7)[0] - p[1], 1e-11);
  for (std::size_t j = 0; j < 3; ++j)
    EXPECT_NEAR(g.derivatives[Index(j)],
                slope_of([](auto const& q) { return 2.0 * flight(q, 2, 1.7)[0] - q[1]; }, p, j), 1e-9)
        << j;
  EXPECT_EQ(g.run.events.size(), 2u);
}
TEST(GradientThroughEvents, TheTimeOfAFallIsThatOfTheClosedForm) {
  // the integral of one is the time at which the contact with the floor ends the run
  auto const timed = [](P p) {
    auto scenario = ball<false>(p);
    using M = std::remove_cvref_t<decltype(scenario.model)>;
    return with_objective(Scenario<M>(std::move(scenario)), NoTerm{}, [](auto const&, State const&) { return 1.0; });
  };
  GradientResult const g = gradient(timed, of_ball, GeneralisedAlpha{.rho_inf = 0.6});
  double const t = std::sqrt(2.0 / 9.81);
  EXPECT_NEAR(g.value, t, 1e-13);
  EXPECT_NEAR(g.derivatives[0], -0.5 * t / 9.81, 1e-11);
  EXPECT_NEAR(g.derivatives[1], 0.5 * t, 1e-11);
  EXPECT_EQ(g.run.warnings.size(), 1u);  // about the restitution, whose impact comes after the end of the run
}

TEST(GradientThroughEvents, EverySnapshotCountGivesTheSameBits) {
  auto const with = [](std::size_t snapshots) {
    return gradient(rated_by_outputs(braked), of_brake, GeneralisedAlpha{.rho_inf = 0.7}, {.snapshots = snapshots});
  };
  GradientResult const all = with(1000);
  EXPECT_EQ(all.reversal.taken, all.reversal.steps);
  for (std::size_t const snapshots : {1u, 2u, 3u, 7u, 30u}) {
    GradientResult const few = with(snapshots);
    EXPECT_GT(few.reversal.taken, few.reversal.steps);
    EXPECT_EQ(few.value, all.value);
    for (Index j = 0; j < all.derivatives.size(); ++j)
      EXPECT_EQ(few.derivatives[j], all.derivatives[j]) << snapshots << ' ' << j;
  }
}

TEST(GradientThroughEvents, RefusesWhatHasNoDerivative) {
  auto const said = [&](auto const& change) {
    auto const make = [&](P p) {
      auto scenario = pushed(std::array{0.3137, 3.0, 2.0});
      change(scenario.options, p[0]);
      return scenario;
    };
    return refusal([&] { gradient(rated_by_outputs(make), {{"p [s]", 0.5}}, GeneralisedAlpha{}); });
  };
  auto const event = [](char const* name, auto const& value) {
    return Event{.name = name, .value = [value](State const& x) { return value(x.t); }};
  };
  EXPECT_TRUE(has(said([&](RunOptions& o, double p) {
                    o.events = {event("first", [p](double t) { return std::pow(t - p - 1e-3, 3); })};
                  }),
                  "gradient: the event \"first\" only touches zero at t = 0.501"));
  EXPECT_TRUE(has(said([&](RunOptions& o, double p) {
                    o.events = {event("first", [p](double t) { return t - p - 0.003; }),
                                event("second", [](double t) { return t - 0.503; })};
                  }),
                  "gradient: events \"first\" and \"second\" coincide at t = 0.503"));
  EXPECT_TRUE(
      has(said([&](RunOptions& o, double p) { o.events = {event("end", [p](double t) { return t - p - 0.3; })}; }),
          "an event coincides with a breakpoint or with the end of the run at t ="));
  EXPECT_TRUE(has(said([](RunOptions& o, double p) { o.breakpoints = {p, 0.5}; }), "gradient: two breakpoints"));
  EXPECT_TRUE(has(said([](RunOptions& o, double p) { o.breakpoints = {p, 0.5003}; }),
                  "change their order within the difference step of \"p [s]\""));
  EXPECT_TRUE(has(said([](RunOptions& o, double p) {
                    o.end_time = 0.5;
                    o.breakpoints = {p};
                  }),
                  "gradient: a breakpoint at the end of the run, t = 0.5 s, moves"));
  EXPECT_TRUE(has(said([](RunOptions& o, double) { o.max_step_halvings = 3; }), "gradient: a run with halved steps"));
}

}  // namespace gradient_events_test
