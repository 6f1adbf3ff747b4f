// Changes of the state by an event action: impacts as jumps of the velocities.
#include <gtest/gtest.h>

#include <polybody/bodies/rigid/planar_rigid.hpp>
#include <polybody/integrators/generalised_alpha.hpp>
#include <polybody/integrators/runge_kutta.hpp>
#include <polybody/joints/planar/joints.hpp>
#include <polybody/joints/policies/elimination.hpp>
#include <polybody/joints/policies/policy.hpp>
#include <polybody/run/simulate.hpp>

#include "support/refusal.hpp"

using namespace polybody;

namespace event_action_test {

constexpr double g = 9.81;

/// Ball 1 m above the floor with the restitution 0.8.
struct Ball {
  Model<Bodies<planar::Rigid>, Joints<>> model{Gravity{0, -g, 0}};
  State x;
  Event const floor{.name = "floor",
                    .value = [](State const& now) { return now.q[1]; },
                    .tolerance = 1e-15,
                    .action = [](State& now) { now.v[1] *= -0.8; }};
  Event const apex{.name = "apex", .value = [](State const& now) { return now.v[1]; }, .tolerance = 1e-15};

  Ball() {
    model.add(planar::Rigid(2.0, 1.0, Placement::at({0, 1.0, 0})), "ball");
    x = model.reference_state();
  }
};

TEST(EventAction, AnImpactIsMetOnceAndTurnsTheSpeedRound) {
  Ball ball;
  auto run = simulate(ball.model, ball.x, GeneralisedAlpha{},
                      {.end_time = 1.7, .step = 1e-2, .events = {ball.floor, ball.apex}});
  run.run();
  double const t1 = std::sqrt(2.0 / g), v1 = std::sqrt(2.0 * g);
  // a jump of the velocity through zero is not an apex
  auto const& met = run.report().events;
  ASSERT_EQ(met.size(), 4u);
  EXPECT_EQ(met[0].name, "floor");
  EXPECT_NEAR(met[0].time, t1, 1e-13);
  EXPECT_EQ(met[1].name, "apex");
  EXPECT_NEAR(met[1].time, 1.8 * t1, 1e-13);
  EXPECT_EQ(met[2].name, "floor");
  EXPECT_NEAR(met[2].time, 2.6 * t1, 1e-13);
  EXPECT_EQ(met[3].name, "apex");
  EXPECT_NEAR(met[3].time, 3.24 * t1, 1e-13);
  EXPECT_NEAR(ball.x.v[1], 0.64 * v1 - g * (1.7 - 2.6 * t1), 1e-12);
  EXPECT_NEAR(ball.x.a[1], -g, 1e-12);
}

TEST(EventAction, ASnapshotKeepsThatAnEventHasActed) {
  Ball ball;
  RunOptions options{.end_time = 0.46, .step = 1e-2, .events = {ball.floor}};
  auto first = simulate(ball.model, ball.x, GeneralisedAlpha{}, options);
  while (first.report().events.empty()) first.advance();
  RunSnapshot const kept = first.snapshot();
  State x = ball.model.reference_state();
  options.end_time = 0.6;
  auto second = resume(ball.model, x, GeneralisedAlpha{}, options, kept);
  second.run();
  EXPECT_EQ(second.report().events.size(), 1u);
  double const t1 = std::sqrt(2.0 / g);
  EXPECT_NEAR(x.v[1], 0.8 * std::sqrt(2.0 * g) - g * (0.6 - t1), 1e-12);
}

/// Two rods on pins that fall from the side. The first one hits a stop in its hanging position.
template <class Policy>
struct Stopped {
  using Pin = Joint<planar::Revolute, Policy>;
  Model<Bodies<planar::Rigid>, Joints<Pin>> model{Gravity{0, -g, 0}};
  State x;

  Stopped() {
    Bar bar{.length = 1.0, .constants = BarConstants{.EA = 1.0, .EI = 1.0, .mass_per_length = 1.0}};
    auto const a = model.add(planar::Rigid::from(bar), "a");
    bar.placement = Placement::at({1.0, 0, 0});
    auto const b = model.add(planar::Rigid::from(bar), "b");
    model.connect(Pin{}, model.ground().at({0, 0, 0}), a.at(0.0), "pin");
    model.connect(Pin{}, a.at(1.0), b.at(0.0), "hinge");
    x = model.reference_state();
  }
  /// Impact on the first rod alone. The velocities are then projected in the mass norm.
  RunReport run(double restitution, double end_time) {
    Event const stop{.name = "stop",
                     .value = [](State const& now) { return now.q[2] + 0.5 * std::numbers::pi; },
                     .tolerance = 1e-14,
                     .action = [restitution](State& now) { now.v[2] *= -restitution; }};
    auto run = simulate(model, x, RungeKutta4<Projection>{}, {.end_time = end_time, .step = 1e-3, .events = {stop}});
    return run.run();
  }
};

TEST(EventAction, SpeedsAreProjectedOntoTheJointsOverTheMasses) {
  Stopped<Constraint> s;
  State before;
  Event const stop{.name = "stop",
                   .value = [](State const& now) { return now.q[2] + 0.5 * std::numbers::pi; },
                   .tolerance = 1e-14,
                   .action =
                       [&](State& now) {
                         before = now;
                         now.v[2] = -now.v[2];
                       }};
  auto run = simulate(s.model, s.x, GeneralisedAlpha{}, {.end_time = 2.0, .step = 1e-3, .events = {stop}});
  while (run.report().events.empty()) run.advance();
  // M (v⁺ − v) + Gᵀμ = 0 with G v⁺ = 0 and the changed velocities v: the change is orthogonal to the free directions
  // of the joints
  VecX changed = before.v;
  changed[2] = -changed[2];
  System system(s.model, with<Capabilities::motion>);
  system.evaluate(s.x.q, s.x.v, s.x.t);
  VecX rate(system.rows());
  system.violation_rate(rate);
  EXPECT_LT(rate.norm(), 1e-12 * changed.norm());
  // rod of length l: mass m, inertia m l²/12
  double const inertia = 1.0 / 12.0;
  Vec<double, 6> const masses(Vec<double, 6>{{1.0, 1.0, inertia, 1.0, 1.0, inertia}});
  auto const work_on = [&](double spin_a, double spin_b) {  // work of the change along a motion of both angles
    double const a = s.x.q[2], b = s.x.q[5];
    Vec<double, 6> w;
    w << -0.5 * std::sin(a) * spin_a, 0.5 * std::cos(a) * spin_a, spin_a,
        -std::sin(a) * spin_a - 0.5 * std::sin(b) * spin_b, std::cos(a) * spin_a + 0.5 * std::cos(b) * spin_b, spin_b;
    return w.dot(masses.cwiseProduct(Vec<double, 6>(s.x.v - changed)));
  };
  EXPECT_NEAR(work_on(1.0, 0.0), 0.0, 1e-10);
  EXPECT_NEAR(work_on(0.0, 1.0), 0.0, 1e-10);
  EXPECT_GT((s.x.v - changed).norm(), 0.1);
}

TEST(EventAction, IsTheSameInJointCoordinates) {
  Stopped<Constraint> rows;
  Stopped<JointCoordinates> tree;
  RunReport const a = rows.run(0.5, 1.2), b = tree.run(0.5, 1.2);
  ASSERT_GE(a.events.size(), 1u);
  ASSERT_EQ(a.events.size(), b.events.size());
  EXPECT_NEAR(a.events[0].time, b.events[0].time, 1e-9);
  EXPECT_LT((rows.x.q - tree.x.q).norm(), 1e-7);
  EXPECT_LT((rows.x.v - tree.x.v).norm(), 1e-6);
}

TEST(EventAction, MustLeaveFiniteNumbers) {
  Ball ball;
  Event bad = ball.floor;
  bad.action = [](State& now) { now.v[1] = std::nan(""); };
  State const start = ball.x;
  auto run = simulate(ball.model, ball.x, GeneralisedAlpha{}, {.end_time = 1.0, .step = 1e-2, .events = {bad}});
  EXPECT_TRUE(has(refusal([&] { run.run(); }), "The velocities after the event \"floor\" must be finite"));
  EXPECT_TRUE(all_finite(ball.x.v));  // state before the step
  EXPECT_GT(ball.x.q[1], 0.0);
}

/// Ball on the floor, or above it, with the restitution e.
template <class I>
State bounce(I const& integrator, double e, double height, RunOptions options, RunReport* report = nullptr) {
  Model<Bodies<planar::Rigid>, Joints<>> model{Gravity{0, -g, 0}};
  model.add(planar::Rigid(2.0, 1.0, Placement::at({0, height, 0})), "ball");
  State x = model.reference_state();
  options.events.insert(options.events.begin(), Event{.name = "floor",
                                                      .value = [](State const& now) { return now.q[1]; },
                                                      .action = [e](State& now) { now.v[1] *= -e; },
                                                      .rests = options.events.empty() || options.events[0].rests});
  auto run = simulate(model, x, integrator, options);
  run.run();
  if (report) *report = run.report();
  return x;
}

TEST(EventAction, ALongStepAfterAnImpactMeetsTheNextOne) {
  // in free flight the error estimate does not shorten the steps
  RunReport report;
  bounce(DormandPrince<>{}, 0.8, 1.0, {.end_time = 2.0, .step = 1e-3}, &report);
  ASSERT_EQ(report.events.size(), 3u);
  double const t1 = std::sqrt(2.0 / g);
  EXPECT_NEAR(report.events[0].time, t1, 1e-8);
  EXPECT_NEAR(report.events[1].time, 2.6 * t1, 1e-8);
  EXPECT_NEAR(report.events[2].time, 3.88 * t1, 1e-8);
}

TEST(EventAction, AnActionThatLetsTheValuePassIsMetOnTheWayBack) {
  Model<Bodies<planar::Rigid>, Joints<>> model{Gravity{0, -g, 0}};
  model.add(planar::Rigid(2.0, 1.0), "ball");
  State x = model.reference_state();
  x.v[1] = 4.0;
  std::vector<double> velocities;
  Event const net{.name = "net",
                  .value = [](State const& now) { return now.q[1] - 0.3; },
                  .action =
                      [&](State& now) {
                        velocities.push_back(now.v[1]);
                        now.v[1] *= 0.5;
                      }};
  simulate(model, x, GeneralisedAlpha{}, {.end_time = 1.0, .step = 1e-2, .events = {net}}).run();
  double const v = std::sqrt(16.0 - 2.0 * g * 0.3);
  ASSERT_EQ(velocities.size(), 2u);
  EXPECT_NEAR(velocities[0], v, 1e-8);
  EXPECT_NEAR(velocities[1], -0.5 * v, 1e-8);
}

TEST(EventAction, ImpactsThatAccumulateAreRefusedUnlessTheValueMayRest) {
  Event const only_time{.name = "late", .value = [](State const& now) { return 100.0 - now.t; }, .rests = false};
  double const t1 = std::sqrt(2.0 / g);
  for (double const e : {0.0, 0.5}) {
    std::string const said =
        refusal([&] { bounce(GeneralisedAlpha{}, e, 1.0, {.end_time = 10.0, .step = 1e-2, .events = {only_time}}); });
    EXPECT_TRUE(has(said, "The event \"floor\" occurs again within its tolerance of 1e-10 s after its action at t = " +
                              number(t1 * (1.0 + e) / (1.0 - e)).substr(0, 6)));
    EXPECT_TRUE(has(said, "Set `rests` of the event"));
  }
  // at rest from the start, also if round-off puts the ball below the floor
  for (double const height : {0.0, 0.3 - 0.1 - 0.2}) {
    EXPECT_TRUE(has(
        refusal([&] { bounce(RungeKutta4<>{}, 0.5, height, {.end_time = 1.0, .step = 1e-2, .events = {only_time}}); }),
        "The event \"floor\" occurs again"));
    State const rested = bounce(RungeKutta4<>{}, 0.5, height, {.end_time = 1.0, .step = 1e-2});
    EXPECT_NEAR(rested.q[1], 0.0, 1e-12);
    EXPECT_NEAR(rested.v[1], 0.0, 1e-12);
  }
}

TEST(EventAction, AValueThatRestsLeavesWhereItIsDrivenBack) {
  Event const kick{.name = "kick",
                   .value = [](State const& now) { return now.t - 1.0; },
                   .action = [](State& now) { now.v[1] = 3.0; },
                   .rests = true};
  RunReport report;
  State const x = bounce(GeneralisedAlpha{}, 0.0, 0.2, {.end_time = 1.2, .step = 1e-2, .events = {kick}}, &report);
  EXPECT_NEAR(x.q[1], 3.0 * 0.2 - 0.5 * g * 0.04, 1e-8);
  EXPECT_NEAR(x.v[1], 3.0 - g * 0.2, 1e-8);
  ASSERT_EQ(report.events.size(), 3u);
  EXPECT_EQ(report.events[1].name, "floor comes to rest");
  EXPECT_EQ(report.events[2].name, "kick");
}

/// Rod on a pin that falls onto a stop at −45° and comes to rest there.
template <class Policy, class I>
void expect_rest_of_rod(I const& integrator) {
  using Pin = Joint<planar::Revolute, Policy>;
  Model<Bodies<planar::Rigid>, Joints<Pin>> model{Gravity{0, -g, 0}};
  auto const rod = model.add(
      planar::Rigid::from(Bar{.length = 1.0, .constants = BarConstants{.EA = 1.0, .EI = 1.0, .mass_per_length = 1.0}}),
      "rod");
  model.connect(Pin{}, model.ground().at({0, 0, 0}), rod.at(0.0), "pin");
  State x = model.reference_state();
  Event const stop{.name = "stop",
                   .value = [](State const& now) { return now.q[2] + 0.25 * std::numbers::pi; },
                   .action = [](State& now) { now.v *= -0.3; },
                   .rests = true};
  auto run = simulate(model, x, integrator, {.end_time = 2.0, .step = 1e-3, .events = {stop}});
  double worst = 0.0, open = 0.0;
  System full(model, with<Capabilities::motion>);
  VecX gaps(full.rows());
  bool rests = false;
  while (!run.done()) {
    run.advance();
    full.evaluate(x.q, x.v, x.t);
    full.violation(gaps);
    open = std::max(open, gaps.lpNorm<Eigen::Infinity>());
    rests = rests || (!run.report().events.empty() && run.report().events.back().name == "stop comes to rest");
    if (rests) worst = std::max(worst, std::abs(x.q[2] + 0.25 * std::numbers::pi));
  }
  EXPECT_TRUE(rests);
  EXPECT_LT(worst, 1e-9);
  EXPECT_LT(open, 1e-9);
  EXPECT_LT(x.v.norm(), 1e-9);
}
TEST(EventAction, APartOfAMechanismRests) {
  expect_rest_of_rod<Constraint>(GeneralisedAlpha{});
  expect_rest_of_rod<JointCoordinates>(RungeKutta4<Projection>{});
}

TEST(EventAction, MustKeepJointsClosed) {
  Stopped<Constraint> s;
  auto const opened = [&](double by) {
    State x = s.x;
    Event const event{.name = "push",
                      .value = [](State const& now) { return now.t - 0.1503; },
                      .action = [by](State& now) { now.q[0] += by; }};
    auto run = simulate(s.model, x, GeneralisedAlpha{}, {.end_time = 0.3, .step = 1e-3, .events = {event}});
    State before = x;
    try {
      for (; !run.done(); run.advance()) before = x;
    } catch (InvalidInput const& error) {
      EXPECT_EQ(x.q, before.q);
      EXPECT_EQ(x.t, before.t);
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_TRUE(has(opened(1e-3), "The action of the event \"push\" at t = 0.1503"));
  EXPECT_TRUE(has(opened(1e-3), "violates joint \""));
  EXPECT_TRUE(has(opened(1e-6), "violates joint \""));
  EXPECT_EQ(opened(1e-10), "");
}

TEST(EventAction, MustKeepTheSizesOfTheState) {
  Ball ball;
  Event bad = ball.floor;
  bad.action = [](State& now) { now.q.resize(0); };
  auto run = simulate(ball.model, ball.x, GeneralisedAlpha{}, {.end_time = 1.0, .step = 1e-2, .events = {bad}});
  EXPECT_TRUE(has(refusal([&] { run.run(); }), "The action of the event \"floor\" at t = 0.4515"));
  EXPECT_EQ(ball.x.q.size(), 3);
  Ball other;
  auto steps = simulate(other.model, other.x, GeneralisedAlpha{}, {.end_time = 1.0, .step = 1e-2});
  steps.advance();
  other.x.q.resize(0);
  EXPECT_TRUE(has(refusal([&] { steps.advance(); }), "The sizes of the state were changed since the last step"));
}

}  // namespace event_action_test
