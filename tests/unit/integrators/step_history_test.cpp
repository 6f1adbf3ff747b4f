#include <gtest/gtest.h>

#include <polybody/integrators/step_history.hpp>

namespace step_history_test {

using namespace polybody;

/// Powers of t: entry k of v̇ is tᵏ, entry k of λ is tᵏ⁺¹. Five points determine the powers up to t⁴.
struct Powers {
  State x;
  Powers(Index velocities, Index rows) {
    x.a.resize(velocities);
    x.lambda.resize(rows);
    at(0.0);
    StepHistory::reset(x);
  }
  void at(double t) {
    x.t = t;
    for (Index k = 0; k < x.a.size(); ++k) x.a[k] = std::pow(t, k);
    for (Index k = 0; k < x.lambda.size(); ++k) x.lambda[k] = std::pow(t, k + 1);
  }
  void step(double h) {
    State const before = x;
    at(before.t + h);
    StepHistory(x).push(before, h, before.a);
  }
};

constexpr std::array<double, 7> uneven{0.1, 0.13, 0.07, 0.11, 0.09, 0.15, 0.1};

TEST(StepHistory, FivePointsContinuePolynomialsOfDegreeFour) {
  Powers p(5, 4);
  for (double const h : uneven) p.step(h);
  double const h = 0.12;
  VecX a(5), lambda(4);
  StepHistory(p.x).extrapolate(p.x, h, a, lambda);
  for (int k = 0; k < 5; ++k) EXPECT_NEAR(a[k], std::pow(p.x.t + h, k), 1e-13) << k;
  for (int k = 0; k < 4; ++k) EXPECT_NEAR(lambda[k], std::pow(p.x.t + h, k + 1), 1e-13) << k;
}

TEST(StepHistory, AsManyPointsAsThereAreCountAtFirst) {
  for (int steps = 0; steps < 5; ++steps) {
    Powers p(steps + 1, 1);  // powers of t up to the number of steps
    for (int i = 0; i < steps; ++i) p.step(uneven[std::size_t(i)]);
    VecX a(steps + 1), lambda(1);
    StepHistory(p.x).extrapolate(p.x, 0.1, a, lambda);
    bool const looked_back = steps >= 2;  // after one step the history has only the last point
    for (int k = 0; k <= (looked_back ? steps - 1 : 0); ++k)
      EXPECT_NEAR(a[k], std::pow(p.x.t + 0.1, k), 1e-14) << steps << " steps, power " << k;
  }
}

TEST(StepHistory, ValuesThatJumpAreHeldAndNotContinued) {
  Powers p(1, 0);
  for (int i = 0; i < 8; ++i) {
    State const before = p.x;
    p.x.t += 0.1;
    p.x.a[0] = i % 2 == 0 ? 1.0 : -1.0;
    StepHistory(p.x).push(before, 0.1, before.a);
  }
  VecX a(1), lambda;
  StepHistory(p.x).extrapolate(p.x, 0.1, a, lambda);
  EXPECT_EQ(a[0], p.x.a[0]);
}

TEST(StepHistory, AStepFarBeyondTheLastOneIsPredictedByThePresentAlone) {
  Powers p(3, 0);
  for (double const h : uneven) p.step(h);
  VecX a(3), lambda;
  StepHistory(p.x).extrapolate(p.x, 0.21, a, lambda);
  EXPECT_EQ(a, p.x.a);
}

TEST(StepHistory, JerkOfAParabolaIsExactAfterTwoUnequalSteps) {
  Powers p(3, 0);
  VecX jerk(3);
  EXPECT_FALSE(StepHistory(p.x).jerk(p.x, jerk));
  p.step(0.1);
  p.step(0.25);
  ASSERT_TRUE(StepHistory(p.x).jerk(p.x, jerk));
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(jerk[k], k * std::pow(0.35, k - 1), 1e-14) << k;
}

}  // namespace step_history_test
