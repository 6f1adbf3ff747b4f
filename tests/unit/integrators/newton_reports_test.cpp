// Cost of Newton's method in a step of generalised-α.

#include <gtest/gtest.h>

#include <polybody/integrators/generalised_alpha.hpp>
#include <polybody/run/simulate.hpp>

#include "support/chain.hpp"

using namespace polybody;

namespace newton_reports_test {

RunReport fall(int links, GeneralisedAlpha const& integrator, double end_time) {
  Chain<InSpace<Constraint>> chain(links, {.length = 0.1, .mass = 1.0, .inertia = 1e-3, .com = 0.05});
  State x = chain.model.reference_state();
  return simulate(chain.model, x, integrator, {.end_time = end_time, .step = 1e-3}).run();
}

double per_step(long count, RunReport const& r) { return double(count) / double(r.steps); }

// 64 links of 0.1 m, 1 kg, 1e-3 kg m², released horizontally, h = 1 ms, 1 s, with the tolerance of the next test.
TEST(NewtonReports, LongChainKeepsItsFactorisation) {
  RunReport const report = fall(64, {.tolerance = 1e-5}, 1.0);
  RecordProperty("iterations_per_step", std::to_string(per_step(report.iterations, report)));
  RecordProperty("factorisations_per_step", std::to_string(per_step(report.factorisations, report)));
  EXPECT_EQ(report.steps, 1000);
  // at most 2.5 and 0.2 together: Newton's method balances iterations against factorisations
  EXPECT_LE(per_step(report.iterations, report) + 3.0 * per_step(report.factorisations, report), 3.1);
  EXPECT_LE(per_step(report.factorisations, report), 0.22);
  EXPECT_LT(report.last.contraction, 1.0);
}

// At this tolerance the remaining error of Newton's method is far below the error of the step.
TEST(NewtonReports, WhatNewtonLeavesIsSmallBesideTheStepsError) {
  auto const tip = [](GeneralisedAlpha const& integrator, double step) {
    Chain<InSpace<Constraint>> chain(64, bar_link(0.1));
    State x = chain.model.reference_state();
    simulate(chain.model, x, integrator, {.end_time = 0.5, .step = step}).run();
    return chain.tip(x);
  };
  GeneralisedAlpha const tight{.tolerance = 1e-10};
  for (double const step : {1e-3, 5e-4}) {
    Vec3 const solved = tip(tight, step);
    double const of_step = (solved - tip(tight, 0.5 * step)).norm() * 4.0 / 3.0;
    EXPECT_LT((tip({.tolerance = 1e-5}, step) - solved).norm(), 0.02 * of_step) << step;
  }
}

TEST(NewtonReports, FullNewtonFactorsInEveryIteration) {
  RunReport const full = fall(16, {.newton = {.always_refactor = true}}, 0.1);
  EXPECT_EQ(full.factorisations, full.iterations);
  RunReport const modified = fall(16, {}, 0.1);
  EXPECT_LT(10 * modified.factorisations, full.factorisations);
}

TEST(NewtonReports, ChainAtRestCostsOneIterationAndNoFactorisation) {
  Chain<InSpace<Constraint>> chain(8, bar_link(0.1), 9.81, 0.0);
  State x = chain.model.reference_state();
  auto run = simulate(chain.model, x, GeneralisedAlpha{}, {.end_time = 0.1, .step = 1e-3});
  RunReport const& report = run.run();
  EXPECT_LT(report.iterations, 1.1 * report.steps);  // except for occasional round-off errors
  EXPECT_EQ(report.factorisations, 1);
  EXPECT_EQ(report.evaluations, report.iterations);
}

TEST(NewtonReports, ReportOfAStepIsThatOfTheSum) {
  Chain<InSpace<Constraint>> chain(4, bar_link());
  State x = chain.model.reference_state();
  auto run = simulate(chain.model, x, GeneralisedAlpha{}, {.end_time = 0.1, .step = 5e-3});
  long iterations = 0, factorisations = 0;
  while (!run.done()) {
    run.advance();
    iterations += run.report().last.iterations;
    factorisations += run.report().last.factorisations;
  }
  EXPECT_EQ(run.report().steps, 20);
  EXPECT_EQ(run.report().iterations, iterations);
  EXPECT_EQ(run.report().factorisations, factorisations);
}

// If Newton's method reaches its limit of iterations, the step ends unconverged, within a hundredth of its motion,
// and is counted.
TEST(NewtonReports, BudgetBoundsAStepAndTellsWhatItLeft) {
  Chain<InSpace<Constraint>> chain(16, bar_link(0.1));
  State x = chain.model.reference_state(), exact = x;
  simulate(chain.model, exact, GeneralisedAlpha{}, {.end_time = 1.0, .step = 1e-3}).run();
  auto run = simulate(chain.model, x, GeneralisedAlpha{.newton = {.budget = 5.0}}, {.end_time = 1.0, .step = 1e-3});
  long most = 0, cut = 0;
  double left = 0.0;
  while (!run.done()) {
    run.advance();
    StepReport const& step = run.report().last;
    if (run.report().steps > 10) most = std::max<long>(most, step.iterations + 3 * step.factorisations);
    if (step.left > 0.0) ++cut;
    left = std::max(left, step.left);
  }
  EXPECT_EQ(run.report().over_budget, cut);
  EXPECT_EQ(run.report().left, left);
  EXPECT_GT(cut, 100);
  EXPECT_GT(left, 1.0);
  EXPECT_LE(most, 5);
  EXPECT_LT((chain.tip(x) - chain.tip(exact)).norm(), 1e-4);
}

}  // namespace newton_reports_test
