#include <polybody/solvers/newton.hpp>

#include <gtest/gtest.h>

#include <functional>

using namespace polybody;

namespace newton_test {

/// f(x) = 0 in one unknown; a correction of `tolerance` has the norm one. Records the calls.
struct Scalar {
  std::function<double(double)> f, slope;
  double x = 0.0;
  double tolerance = 1e-10;
  double factored_slope = 0.0, residual = 0.0, correction = 0.0;
  int evaluations = 0, factorisations = 0, solutions = 0;

  bool evaluate() {
    ++evaluations;
    residual = f(x);
    return std::isfinite(residual);
  }
  bool refactor() {
    ++factorisations;
    factored_slope = slope(x);
    return factored_slope != 0.0;
  }
  double solve() {
    ++solutions;
    correction = -residual / factored_slope;
    return std::abs(correction) / tolerance;
  }
  void apply() { x += correction; }
};

/// Accepts damped corrections.
struct Damped : Scalar {
  double least_part = 1.0;
  void apply(double part) {
    least_part = std::min(least_part, part);
    x += part * correction;
  }
};

Scalar square_root_of_two() {
  return {[](double x) { return x * x - 2.0; }, [](double x) { return 2.0 * x; }, 1.0};
}

struct Outcome {
  NewtonReport report;
  ReusedFactorisation kept;
};
Outcome solve(Scalar& problem, NewtonOptions const& options = {}, ReusedFactorisation const& kept = {}) {
  Outcome out{{}, kept};
  out.report = newton(problem, options, out.kept);
  return out;
}

TEST(Newton, SolvesAndReportsWhatItCost) {
  Scalar problem = square_root_of_two();
  Outcome const o = solve(problem);
  EXPECT_EQ(o.report.result, NewtonResult::converged);
  EXPECT_NEAR(problem.x, std::sqrt(2.0), 1e-10);
  EXPECT_EQ(o.report.iterations, problem.evaluations);
  EXPECT_EQ(o.report.factorisations, problem.factorisations);
  // each renewal is followed by another solution
  EXPECT_EQ(problem.solutions, problem.evaluations + problem.factorisations - 1);
  EXPECT_LT(o.report.theta, 1.0);
  EXPECT_TRUE(o.kept.usable);
}

TEST(Newton, FullNewtonFactorsAtEveryIterate) {
  Scalar problem = square_root_of_two();
  Outcome const o = solve(problem, {.always_refactor = true});
  EXPECT_EQ(o.report.result, NewtonResult::converged);
  EXPECT_EQ(o.report.factorisations, o.report.iterations);
  EXPECT_LE(o.report.iterations, 6);  // quadratic convergence
  EXPECT_NEAR(problem.x, std::sqrt(2.0), 1e-15);
}

// At 1.4 the derivative contracts by |1 − x/1.4|, about 0.01: it is reused to the end and in the next solve.
TEST(Newton, KeepsAFactorisationThatContracts) {
  Scalar problem = square_root_of_two();
  problem.x = 1.4;
  Outcome const first = solve(problem);
  EXPECT_EQ(first.report.factorisations, 1);
  EXPECT_TRUE(first.kept.usable);
  EXPECT_NEAR(first.kept.theta, std::sqrt(2.0) / 1.4 - 1.0, 1e-3);

  problem.x = 1.41;
  Outcome const second = solve(problem, {}, first.kept);
  EXPECT_EQ(second.report.result, NewtonResult::converged);
  EXPECT_EQ(second.report.factorisations, 0);
  EXPECT_EQ(problem.factorisations, 1);
  EXPECT_NEAR(problem.x, std::sqrt(2.0), 1e-10);
}

// With the derivative at 1 instead of at √2 the rate is √2 − 1 = 0.41, and 23 corrections follow a correction of 0.1.
TEST(Newton, RenewsAFactorisationWhereThatSavesWhatItCosts) {
  Scalar eager = square_root_of_two(), patient = square_root_of_two();
  EXPECT_GE(solve(eager).report.factorisations, 2);
  EXPECT_EQ(solve(patient, {.max_iterations = 50, .factorisation_cost = 30.0}).report.factorisations, 1);
  EXPECT_GT(patient.evaluations, eager.evaluations + 10);
  EXPECT_NEAR(patient.x, std::sqrt(2.0), 1e-10);
}

// A rate of 0.2 with a factor of 1e3 to reduce needs four iterations, a new factorisation two. Over ten solves it
// saves twenty iterations.
TEST(Newton, RenewsSoonerWhatServesForLong) {
  auto const factorisations_after = [](int solves) {
    Scalar problem{[](double x) { return x - 1.0; }, [](double) { return 1.0; }};
    problem.tolerance = 1e-3;
    problem.factored_slope = 1.0 / 0.8;
    return solve(problem, {}, {.usable = true, .theta = 0.2, .served = solves}).report.factorisations;
  };
  EXPECT_EQ(factorisations_after(1), 0);
  EXPECT_EQ(factorisations_after(10), 1);
}

// A factorisation that fails at the first correction is not tried in the next solve; a successful one is reused.
TEST(Newton, BeginsAnewWhereTheLastFactorisationWasOfNoUse) {
  Scalar problem{[](double x) { return x - 1.0; }, [](double) { return 1.0; }};
  problem.factored_slope = -1.0;
  ReusedFactorisation kept{.usable = true, .theta = 0.1};
  NewtonReport const first = newton(problem, {}, kept);
  EXPECT_EQ(first.factorisations, 1);
  EXPECT_TRUE(kept.stale);
  problem.x = 5.0;
  NewtonReport const second = newton(problem, {}, kept);
  EXPECT_EQ(second.factorisations, 1);  // immediately
  EXPECT_EQ(second.iterations, first.iterations - 1);
  EXPECT_FALSE(kept.stale);
  problem.x = 9.0;
  EXPECT_EQ(newton(problem, {}, kept).factorisations, 0);
}

// If new factorisations contract no faster than the reused one, few are made. Occasionally one is tried again.
TEST(Newton, LearnsWhatANewFactorisationIsWorth) {
  Scalar problem{[](double x) { return x - 1.0; }, [](double) { return 1.0 / 0.7; }};
  ReusedFactorisation kept;
  int factorisations = 0;
  for (int solves = 0; solves < 100; ++solves) {
    problem.x = 0.0;
    factorisations += newton(problem, {}, kept).factorisations;
  }
  EXPECT_GE(factorisations, 5);
  EXPECT_LE(factorisations, 40);
  EXPECT_GT(kept.fresh, 0.1);
}

// A derivative of the wrong sign: the first correction increases the residual, and the second is not applied. The
// tangent at this point completes the solve.
TEST(Newton, CorrectionThatAsksForANewFactorisationIsNotTaken) {
  Scalar problem{[](double x) { return x - 1.0; }, [](double) { return 1.0; }};
  problem.factored_slope = -1.0;
  Outcome const o = solve(problem, {}, {.usable = true, .theta = 0.1});
  EXPECT_EQ(o.report.result, NewtonResult::converged);
  EXPECT_EQ(problem.x, 1.0);
  EXPECT_EQ(problem.evaluations, 3);  // at 0, at −1, and at the solution
  EXPECT_EQ(problem.factorisations, 1);
  EXPECT_EQ(problem.solutions, 4);
}

// A linear contraction of rate θ: the remaining error after the last correction is θ/(1 − θ) of it, and below the
// tolerance. The derivative is wrong by a known factor.
TEST(Newton, StopsWhereTheErrorLeftIsBelowTheTolerance) {
  for (double const rate : {0.1, 0.25}) {
    Scalar problem{[](double x) { return x - 1.0; }, [&](double) { return 1.0 / (1.0 - rate); }};
    Outcome const o = solve(problem);
    ASSERT_EQ(o.report.result, NewtonResult::converged);
    EXPECT_NEAR(o.report.theta, rate, 1e-6);
    EXPECT_LE(std::abs(problem.x - 1.0), problem.tolerance * (1.0 + 1e-5));
    EXPECT_GT(std::abs(problem.x - 1.0), 0.9 * rate * problem.tolerance);  // one correction fewer would not be enough
  }
}

TEST(Newton, CorrectionBelowTheToleranceEndsItAtOnce) {
  Scalar problem = square_root_of_two();
  problem.x = std::sqrt(2.0) * (1.0 + 1e-14);
  Outcome const o = solve(problem);
  EXPECT_EQ(o.report.result, NewtonResult::converged);
  EXPECT_EQ(o.report.iterations, 1);
}

// A known rate from the previous solve makes a single correction sufficient.
TEST(Newton, OldRateSavesTheSecondCorrection) {
  Scalar with = square_root_of_two(), without = square_root_of_two();
  with.x = without.x = std::sqrt(2.0) + 1e-10;
  with.factored_slope = without.factored_slope = 2.0 * std::sqrt(2.0);
  EXPECT_EQ(solve(with, {}, {.usable = true, .theta = 1e-3}).report.iterations, 1);
  EXPECT_EQ(solve(without, {}, {.usable = true, .theta = 0.9}).report.iterations, 2);
}

/// Two roots. The root at 10.5 is farther away than the solution may be.
struct TwoRoots : Scalar {
  int restarts = 0;
  TwoRoots() : Scalar{[](double y) { return (y - 1.0) * (y - 10.5); }, [](double y) { return 2.0 * y - 11.5; }} {
    factored_slope = -0.8;
  }
  bool is_far_from_solution(double norm) const { return norm * tolerance > 2.0; }
  void restart() {
    ++restarts;
    x = 0.0;
  }
};

TEST(Newton, BeginsAgainWhereAnEarlierFactorisationLedFar) {
  TwoRoots p;
  ReusedFactorisation kept{.usable = true, .theta = 0.1};
  NewtonReport const report = newton(p, {}, kept);
  EXPECT_EQ(report.result, NewtonResult::converged);
  EXPECT_NEAR(p.x, 1.0, 1e-10);
  EXPECT_EQ(p.restarts, 1);
  EXPECT_EQ(report.factorisations, 2);  // at 0, and between the roots
  Scalar without = TwoRoots();
  kept = {.usable = true, .theta = 0.1};
  EXPECT_EQ(newton(without, {}, kept).result, NewtonResult::converged);
  EXPECT_NEAR(without.x, 10.5, 1e-10);
  TwoRoots near;  // from this start the same derivative is more accurate
  near.x = 0.9;
  near.factored_slope = -4.0;
  kept = {.usable = true, .theta = 0.1};
  EXPECT_EQ(newton(near, {}, kept).result, NewtonResult::converged);
  EXPECT_EQ(near.restarts, 0);
}

// x ← x − (x − 1)/2: the correction k is 2⁻ᵏ.
TEST(Newton, EndsAtItsBudgetAndSaysWhatItLeft) {
  Scalar p{[](double y) { return y - 1.0; }, [](double) { return 2.0; }};
  NewtonOptions const options{.max_iterations = 100, .budget = 13.0};
  p.factored_slope = 2.0;
  ReusedFactorisation kept{
      .usable = true, .theta = 0.5, .fresh = 0.5};  // a new factorisation does not improve the rate
  NewtonReport const report = newton(p, options, kept);
  EXPECT_EQ(report.result, NewtonResult::converged);
  EXPECT_EQ(report.iterations, 13);
  EXPECT_EQ(report.left, std::abs(p.correction) / p.tolerance);
  EXPECT_GT(report.left, 1.0);
  kept = {};
  p.x = 0.0;
  EXPECT_EQ(newton(p, {.max_iterations = 100}, kept).left, 0.0);
  EXPECT_NEAR(p.x, 1.0, 1e-10);
  // two iterations do not reach a hundredth of the first correction: the iteration continues until it is reached
  p.x = 0.0;
  kept = {};
  NewtonReport const longer = newton(p, {.max_iterations = 100, .factorisation_cost = 1.0, .budget = 2.0}, kept);
  EXPECT_EQ(longer.result, NewtonResult::converged);
  EXPECT_LE(std::abs(p.correction), 0.005);
  EXPECT_GT(std::abs(p.correction), 0.0025);
  EXPECT_EQ(longer.factorisations, 1);  // the budget permits no other factorisation
}

TEST(Newton, GivesUpWhenCorrectionsGrow) {
  // x^(1/3): every Newton correction moves x to −2 x
  Scalar problem{[](double x) { return std::cbrt(x); }, [](double x) { return std::cbrt(x) / (3.0 * x); }, 1.0};
  Outcome const o = solve(problem);
  EXPECT_EQ(o.report.result, NewtonResult::diverged);
  EXPECT_FALSE(o.kept.usable);
  EXPECT_GE(o.report.theta, 1.0);
  EXPECT_LE(o.report.iterations, 5);
}

// atan x from 1.5: undamped iterates are −1.69, 2.32, −5.11, … and diverge on alternating sides.
TEST(Newton, FullNewtonDampsWhatGoesBackAndForth) {
  auto const arc = [](double x) { return std::atan(x); };
  auto const slope = [](double x) { return 1.0 / (1.0 + x * x); };
  NewtonOptions const full{.max_iterations = 60, .always_refactor = true, .max_growths = 60};
  ReusedFactorisation kept;
  Scalar undamped{arc, slope, 1.5};
  EXPECT_NE(newton(undamped, full, kept).result, NewtonResult::converged);
  Damped damped{{arc, slope, 1.5}};
  EXPECT_EQ(newton(damped, full, kept).result, NewtonResult::converged);
  EXPECT_NEAR(damped.x, 0.0, 1e-9);
  EXPECT_LT(damped.least_part, 1.0);
  // full steps that converge are not damped
  Damped easy{{[](double x) { return x * x - 2.0; }, [](double x) { return 2.0 * x; }, 1.0}};
  EXPECT_EQ(newton(easy, full, kept).result, NewtonResult::converged);
  EXPECT_EQ(easy.least_part, 1.0);
}

TEST(Newton, GivesUpAfterTheMostIterationsAllowed) {
  Scalar problem = square_root_of_two();
  Outcome const o = solve(problem, {.max_iterations = 2});
  EXPECT_EQ(o.report.result, NewtonResult::diverged);
  EXPECT_EQ(o.report.iterations, 2);
  EXPECT_FALSE(o.kept.usable);
}

TEST(Newton, SaysWhenTheTangentIsSingular) {
  Scalar problem = square_root_of_two();
  problem.x = 0.0;
  Outcome const o = solve(problem);
  EXPECT_EQ(o.report.result, NewtonResult::singular);
  EXPECT_FALSE(o.kept.usable);
  EXPECT_EQ(problem.solutions, 0);
}

TEST(Newton, SaysWhenTheRightHandSideIsNoNumber) {
  auto const f = [](double x) { return std::sqrt(x) + 1.0; };
  auto const slope = [](double x) { return 0.5 / std::sqrt(x); };
  Scalar outside{f, slope, -1.0};
  EXPECT_EQ(solve(outside).report.result, NewtonResult::not_finite);
  EXPECT_EQ(outside.solutions, 0);
  Scalar leaves{f, slope,
                // the first correction leaves the domain: this is due to Newton's method, and a smaller step may stay
                // inside
                1.0};
  EXPECT_EQ(solve(leaves).report.result, NewtonResult::diverged);
  EXPECT_EQ(leaves.solutions, 1);
}

// x² + 1 has no root: the first correction from 1 leads to the point with zero derivative.
TEST(Newton, TangentThatIsSingularLaterOnIsNewtonsDoing) {
  Scalar problem{[](double x) { return x * x + 1.0; }, [](double x) { return 2.0 * x; }, 1.0};
  EXPECT_EQ(solve(problem, {.always_refactor = true}).report.result, NewtonResult::diverged);
  EXPECT_EQ(problem.x, 0.0);
}

// A wrong derivative moves x far away, and the next factorisation makes small corrections. They are small compared
// with the previous corrections, which gives no contraction rate, but not compared with the tolerance.
TEST(Newton, SmallCorrectionAfterOneThatGrewTellsNoRate) {
  Scalar problem{[](double x) { return x / (1.0 + std::abs(x)) - 0.1; },
                 [](double x) { return x == 0.0 ? 1e-6 : 1e9; }};
  EXPECT_NE(solve(problem).report.result, NewtonResult::converged);
  EXPECT_GT(problem.solutions, 3);
}

// Corrections that shrink to a fifth per iteration while the tolerance shrinks faster: they contract, and are not
// damped.
TEST(Newton, FullNewtonDampsByCorrectionsThemselves) {
  struct Moving : Damped {
    double tolerated = 1.0;
    CorrectionSize solve() {
      (void)Scalar::solve();
      tolerated = std::max(0.1 * tolerated, 1e-6);
      return {.norm = std::abs(correction), .tolerated = tolerated};
    }
  };
  Moving problem{{{[](double x) { return x - 1.0; }, [](double) { return 1.25; }}}};
  ReusedFactorisation kept;
  EXPECT_EQ(newton(problem, {.always_refactor = true}, kept).result, NewtonResult::converged);
  EXPECT_EQ(problem.least_part, 1.0);
  EXPECT_NEAR(problem.x, 1.0, 1e-6);
}

// Corrections that shrink slowly because of damping do not cause more damping.
TEST(Newton, DampingEnds) {
  // the first correction is opposite to a much smaller second one
  Damped problem{
      {[](double x) { return std::atan(x); }, [](double x) { return x == 3.0 ? 1.0 : 1.0 / (1.0 + x * x); }, 3.0}};
  ReusedFactorisation kept;
  EXPECT_EQ(newton(problem, {.max_iterations = 40, .always_refactor = true, .max_growths = 40}, kept).result,
            NewtonResult::converged);
  EXPECT_NEAR(problem.x, 0.0, 1e-9);
  EXPECT_GE(problem.least_part, 1.0 / 64.0);
}

TEST(Newton, CorrectionThatIsNoNumberIsNotApplied) {
  Scalar problem = square_root_of_two();
  problem.slope = [](double) { return std::numeric_limits<double>::quiet_NaN(); };
  Outcome const o = solve(problem);
  EXPECT_EQ(o.report.result, NewtonResult::singular);
  EXPECT_EQ(problem.x, 1.0);
  EXPECT_FALSE(o.kept.usable);
}

/// f contains noise of either sign, far above the tolerance.
struct Noisy : Scalar {
  double noise = 1e-8;
  bool evaluate() {
    bool const finite = Scalar::evaluate();
    residual += evaluations % 2 == 0 ? noise : -noise;
    return finite;
  }
};
/// Reports its noise.
struct AwareOfNoise : Noisy {
  int asked = 0;
  bool is_round_off(double norm) {
    ++asked;
    return norm * tolerance <= 3.0 * noise;
  }
};

// Corrections due to noise cause a failure unless the problem reports that they are noise. Then the last one is not
// applied.
TEST(Newton, StopsWhereCorrectionsAreRounding) {
  auto const f = [](double x) { return x - 2.0; };
  auto const slope = [](double) { return 1.0; };
  for (bool const full : {false, true}) {
    ReusedFactorisation kept;
    Noisy noisy{{.f = f, .slope = slope, .x = 1.0}};
    EXPECT_EQ(newton(noisy, {.always_refactor = full, .predictive_stop = false}, kept).result, NewtonResult::diverged);
    kept = {};
    AwareOfNoise aware{{{.f = f, .slope = slope, .x = 1.0}}};
    EXPECT_EQ(newton(aware, {.always_refactor = full, .predictive_stop = false}, kept).result, NewtonResult::converged);
    EXPECT_EQ(aware.asked, 1);
    EXPECT_TRUE(kept.usable);
    EXPECT_NEAR(aware.x, 2.0, 2e-8);
  }
}

}  // namespace newton_test
