// The driver of runs, with a run that records its calls. The event test integrates a falling body.
#include <polybody/run/run_driver.hpp>

#include <gtest/gtest.h>

#include <polybody/bodies/rigid/planar_rigid.hpp>
#include <polybody/system/make_operations.hpp>

#include "support/refusal.hpp"

using namespace polybody;

namespace run_driver_test {

using Falling = Model<Bodies<planar::Rigid>, Joints<>>;

/// A body that falls with 10 m/s²; steps are exact. Steps longer than `longest` do not converge. If `part` is below
/// one, a step takes this fraction of the requested length and suggests the length `next`.
struct Fall {
  Falling model = [] {
    Falling m{Gravity{0, -10.0, 0}};
    m.add(planar::Rigid(1.0, 1.0, Placement::at({0, 1.0, 0})), "body");
    return m;
  }();
  System system{model, with<Capabilities::motion>};
  State x = model.reference_state();
  RunOptions options;
  RunReport report;
  RunDriver driver;
  double longest = 1e9, part = 1.0, next_length = 0.0, fails_at = -1.0;
  int order = 0;  // number of steps so far
  int starts = 0, failing_step = -1, restarts = 0, failures = 0;
  std::vector<double> ends;
  std::vector<RunStep> steps;

  explicit Fall(RunOptions o, bool adaptive = false) : options(std::move(o)), driver(options, report, adaptive) {
    x.a[1] = -10.0;
    driver.plan_run(x.t, system.layout().breakpoints);
    driver.start_events(x, *this);
  }
  void run() {
    while (!driver.done(x)) {
      driver.plan_step(x);
      driver.take_step(x, *this);
    }
  }

  StepReport step(State& y, double h, int = -1) {
    if (h > longest || (std::abs(y.t + h - fails_at) < 1e-12 && h > 1e-6))
      throw NewtonConvergenceFailure("newton.not_converged", {"no solution"});
    StepReport r;
    r.taken = part * h;
    r.next = next_length;
    r.iterations = 1;
    r.order = ++order;
    r.choices = order;
    y.q[1] += r.taken * (y.v[1] - 5.0 * r.taken);
    y.v[1] -= 10.0 * r.taken;
    y.t += r.taken;
    return r;
  }
  StepReport take(State& y, double h) { return driver.halving_step(y, h, options.allowed_halvings(), *this); }
  void start(State&, double) { ++starts; }
  State const& full_state(State const& y) { return y; }
  System& stepped_system() { return system; }
  bool keeps() const { return true; }
  void on_step(RunStep&) {}
  void on_end(RunStep& s) {
    for (std::size_t i = 0; s.acts && i < options.events.size(); ++i)
      if (driver.events().met(i) && options.events[i].action) options.events[i].action(x);
  }
  bool requires_restart() { return false; }
  void on_next(RunStep& s) { restarts += s.restarts; }
  void on_done(RunStep& s) {
    ends.push_back(x.t);
    steps.push_back(s);
    if (int(steps.size()) == failing_step) throw std::runtime_error("an observer fails");
    report.add(s.report);
  }
  void on_failure() { ++failures; }
};

TEST(RunDriver, StepsEndAtTheGridAndAtBreakpoints) {
  Fall fall({.end_time = 1.0, .step = 0.25, .breakpoints = {0.6, 0.3}});
  fall.run();
  EXPECT_EQ(fall.ends, (std::vector{0.25, 0.3, 0.55, 0.6, 0.85, 1.0}));
  EXPECT_EQ(fall.restarts, 2);
  EXPECT_TRUE(fall.steps[1].at_breakpoint);
  EXPECT_NEAR(fall.x.v[1], -10.0, 1e-14);
}

TEST(RunDriver, AShortStepAfterABreakpointIsFollowedByARestart) {
  Fall fall({.end_time = 0.5015, .step = 0.25, .breakpoints = {0.5}});
  fall.run();
  EXPECT_EQ(fall.ends, (std::vector{0.25, 0.5, 0.5015}));
  EXPECT_FALSE(fall.steps[1].remainder);
  EXPECT_TRUE(fall.steps[2].remainder);
  EXPECT_EQ(fall.restarts, 2);
}

TEST(RunDriver, AFailedStepIsTakenInHalvesAfterNewStarts) {
  Fall fall({.end_time = 0.2, .step = 0.1});
  fall.longest = 0.03;
  fall.run();
  EXPECT_EQ(fall.ends, (std::vector{0.1, 0.2}));
  EXPECT_EQ(fall.report.halved, 6);  // each step: itself and both halves
  EXPECT_EQ(fall.starts, 6);
  EXPECT_EQ(fall.report.iterations, 8);
  EXPECT_EQ(fall.report.last.order, 8);  // of the last half
  EXPECT_EQ(fall.report.last.choices, 8);
  EXPECT_NEAR(fall.x.q[1], 1.0 - 5.0 * 0.04, 1e-14);
}

// Steps that end at 0.2 s fail unless they are shorter than a millionth of a step. Only the last halves are halved
// again: 17 halvings with the default of 6.
TEST(RunDriver, HalvesBeforeAFailureAtTheEndOfAStepDoNotCount) {
  Fall fall({.end_time = 0.3, .step = 0.1});
  fall.fails_at = 0.2;
  fall.run();
  EXPECT_EQ(fall.ends.size(), 3u);
  EXPECT_EQ(fall.report.halved, 17);  // 0.1 s · 2⁻¹⁷ < 1e-6 s
  EXPECT_NEAR(fall.x.q[1], 1.0 - 5.0 * 0.09, 1e-13);
}

TEST(RunDriver, AStepThatFailsInAllHalvesLeavesTheStateUnchanged) {
  Fall fall({.end_time = 0.2, .step = 0.1, .max_step_halvings = 2});
  fall.driver.plan_step(fall.x);
  fall.driver.take_step(fall.x, fall);
  State const before = fall.x;
  fall.longest = 0.0;
  fall.driver.plan_step(fall.x);
  EXPECT_TRUE(has(message_of<NewtonConvergenceFailure>([&] { fall.driver.take_step(fall.x, fall); }),
                  "The step of the run was halved 2 times."));
  EXPECT_EQ(fall.x.q, before.q);
  EXPECT_EQ(fall.x.t, 0.1);
  EXPECT_EQ(fall.failures, 1);
}

TEST(RunDriver, AnExceptionAfterAStepRestoresPlanAndEvents) {
  auto const options = [] {
    return RunOptions{.end_time = 1.0,
                      .step = 0.1,
                      .breakpoints = {0.25},
                      .events = {{.name = "floor",
                                  .value = [](State const& x) { return x.q[1]; },
                                  .tolerance = 1e-14,
                                  .action = [](State& x) { x.v *= -0.5; }}}};
  };
  Fall sound(options());
  sound.run();
  for (int failing = 1; failing <= int(sound.steps.size()); ++failing) {
    Fall fall(options());
    fall.failing_step = failing;
    for (;;) try {
        fall.run();
        break;
      } catch (std::runtime_error const&) {
        fall.ends.pop_back();
        fall.failing_step = -1;
      }
    EXPECT_EQ(fall.failures, 1);
    EXPECT_EQ(fall.ends, sound.ends) << failing;
    EXPECT_EQ(fall.x.q, sound.x.q) << failing;
    ASSERT_EQ(fall.report.events.size(), sound.report.events.size());
  }
}

TEST(RunDriver, RecordsThePartsOfAStepUpToAnEvent) {
  Fall fall(
      {.end_time = 1.0,
       .step = 0.5,
       .events =
           {{.name = "floor", .value = [](State const& x) { return x.q[1]; }, .terminal = true, .tolerance = 1e-14}}},
      true);
  fall.part = 0.75;  // an integrator with error control, which takes less than it is asked for
  fall.next_length = 0.5;
  fall.run();
  double const t = std::sqrt(0.2);
  EXPECT_NEAR(fall.x.t, t, 1e-12);
  Sequence<double> const& parts = fall.steps.back().lengths;
  EXPECT_GT(parts.size(), 1u);
  double sum = fall.driver.before().t;
  for (double const part : parts) sum += part;
  EXPECT_NEAR(sum, fall.x.t, 1e-15);
  EXPECT_TRUE(fall.steps.back().met);
  EXPECT_TRUE(fall.driver.done(fall.x));
}

TEST(RunDriver, KeepsTheStepOfErrorControlBehindABreakpoint) {
  Fall fall({.end_time = 1.0, .step = 0.2, .max_step = 0.3, .breakpoints = {0.25}}, true);
  fall.next_length = 0.4;
  fall.run();
  // 0.4 is limited to 0.3; the short step to the breakpoint does not shorten the next one
  EXPECT_EQ(fall.ends.size(), 5u);
  EXPECT_NEAR(fall.ends[2], 0.55, 1e-15);
}

}  // namespace run_driver_test
