#include <polybody/run/run_snapshot.hpp>

#include <gtest/gtest.h>

namespace polybody {
namespace step_plan_test {

/// End times of all steps of about h from 0 to `end_time`. The clock is updated as in `simulate`.
std::vector<double> ends(StepPlan plan, double end_time, double h) {
  std::vector<double> times;
  double t = plan.pass(0.0);
  while (t < end_time) {
    auto const next = plan.next(t, h);
    t = next.lands ? next.target : t + next.h;
    times.push_back(t);
    if (next.jumps) t = plan.pass(t);
  }
  return times;
}

TEST(StepPlan, StepsEndAtCornersInTheirOrder) {
  EXPECT_EQ(ends(StepPlan(0.0, 1.0, 0.25, {0.6, 0.3}), 1.0, 0.25), (std::vector{0.25, 0.3, 0.55, 0.6, 0.85, 1.0}));
}

TEST(StepPlan, CornersOutsideTheRunAreLeftOut) {
  EXPECT_EQ(ends(StepPlan(0.0, 1.0, 0.5, {-1.0, 0.0, 1.5}), 1.0, 0.5), (std::vector{0.5, 1.0}));
}

// 0.1 + 0.2 > 0.3: two breakpoints that differ by round-off only. They are merged, and the clock has the later time.
TEST(StepPlan, CornersThatOnlyRoundingSetsApartAreOne) {
  StepPlan plan(0.0, 1.0, 0.1, {0.3, 0.1 + 0.2});
  EXPECT_EQ(plan.pass(0.3), 0.1 + 0.2);
  EXPECT_EQ(plan.next(0.3, 0.1).target, 1.0);
}

TEST(StepPlan, ACrumbLeftOverGoesToTheStepBefore) {
  StepPlan const plan(0.0, 1.0, 0.5, {});
  auto const last = plan.next(0.496, 0.5);  // the remainder is 0.504, within a hundredth of a step
  EXPECT_TRUE(last.lands);
  EXPECT_EQ(last.h, 1.0 - 0.496);
  EXPECT_FALSE(plan.next(0.49, 0.5).lands);
  EXPECT_EQ(plan.next(0.49, 0.5).h, 0.5);
}

// A function of time that changes at a breakpoint is evaluated with its old value at the end of the previous step.
TEST(StepPlan, AStepToACornerEndsJustBeforeIt) {
  StepPlan const plan(0.0, 1.0, 0.5, {0.3});
  auto const step = plan.next(0.1, 0.5);
  EXPECT_TRUE(step.lands && step.jumps);
  EXPECT_EQ(step.target, 0.3);
  EXPECT_LT(0.1 + step.h, 0.3);
  EXPECT_NEAR(0.1 + step.h, 0.3, 1e-15);
}

TEST(StepPlan, TheEndIsReachedExactly) {
  EXPECT_EQ(StepPlan(0.0, 1.0, 1e-3, {}).pass(1.0 - 1e-13), 1.0);
  EXPECT_EQ(StepPlan(0.0, 1.0, 1e-3, {}).pass(1.0 - 1e-11), 1.0 - 1e-11);
}

}  // namespace step_plan_test
}  // namespace polybody
