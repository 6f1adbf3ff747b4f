#include <polybody/compare/compare.hpp>

#include <gtest/gtest.h>

#include <numbers>
#include <sstream>

#include <polybody/bodies/rigid/planar_rigid.hpp>
#include <polybody/compare/work_precision.hpp>
#include <polybody/integrators/generalised_alpha.hpp>
#include <polybody/integrators/runge_kutta.hpp>
#include <polybody/joints/planar/joints.hpp>

#include "support/exact_pendulum.hpp"
#include "support/refusal.hpp"

namespace compare_test {

using namespace polybody;

// Rod of 1 m and 1 kg on a pin, released from the horizontal.
struct Pendulum {
  std::vector<std::string> outputs = {"tip y [m]"};  ///< equal for all of them
  double sampling = 0.0;

  template <class F>
  auto operator()(F const& f) const {
    using Pin = Joint<planar::Revolute, typename F::PolicyType>;
    using M = Model<Bodies<typename F::BodyType>, Joints<Pin>>;
    M model{Gravity{0, -9.81, 0}};
    auto const rod = model.add(
        F::BodyType::from({.length = 1.0, .constants = BarConstants{.EA = 1e6, .EI = 1e3, .mass_per_length = 1.0}}),
        "rod");
    model.connect(Pin{{}, f.policy}, model.ground().at({0, 0, 0}), rod.at(0.0), "pin");
    State const start = model.reference_state();
    auto const tip = rod.at(1.0);
    Scenario<M> scenario{std::move(model), start, {.end_time = 0.5, .step = 1e-3}};
    for (std::string const& name : outputs)
      scenario.outputs.push_back({name, [tip](M const& m, State const& x) { return position(m, x, tip)[1]; }});
    if (f.name == "of its own mind") scenario.outputs.pop_back();
    scenario.sampling = sampling;
    return scenario;
  }
};

// Uniform rod pendulum (J1, independent computation): phi(0.5) from the downward vertical
constexpr double end_angle = -0.090352089956;
// θ¨ = −(3 g/2 L) sin θ from θ = 90°
double exact_tip(double t) {
  static ExactPendulum const pendulum(0.5 * std::numbers::pi, 1.5 * 9.81);
  return -std::cos(pendulum(t).angle);
}

double nowhere(double) { return std::nan(""); }

using Ideal = Formulation<planar::Rigid, Constraint, GeneralisedAlpha>;
using Stiff = Formulation<planar::Rigid, Penalty, GeneralisedAlpha>;
using Explicit = Formulation<planar::Rigid, Constraint, RungeKutta4<Projection>>;

TEST(Compare, RunsOneCaseUnderSeveralFormulations) {
  Comparison const c =
      compare(Pendulum{}, Ideal{"ideal", {}, {.rho_inf = 0.9}},
              Stiff{"penalty", {.stiffness = 1e7, .damping = 1e3}, {.rho_inf = 0.9}}, Explicit{"explicit", {}, {}});
  ASSERT_EQ(c.runs.size(), 3u);
  // Counts as in Table 3.4 of Wallin 2016: the penalty does not reduce the degrees of freedom.
  EXPECT_EQ(c.runs[0].problem_size.degrees_of_freedom, 1);
  EXPECT_EQ(c.runs[1].problem_size.degrees_of_freedom, 3);
  EXPECT_EQ(c.runs[0].problem_size.rows, 2);
  EXPECT_EQ(c.runs[1].problem_size.rows, 0);
  // The pin carries 5/2 m g cos φ along the rod and 1/4 m g sin φ across it, so m g/4 at the start. A penalty carries
  // no force at the start.
  double const mg = 9.81, held = mg * std::hypot(2.5 * std::cos(end_angle), 0.25 * std::sin(end_angle));
  for (ComparedRun const& run : c.runs) {
    EXPECT_EQ(run.run.steps, 500);
    EXPECT_EQ(run.family, families::rigid);
    EXPECT_EQ(run.policy, &run == &c.runs[1] ? "Penalty" : "Constraint");
    ASSERT_EQ(run.times.size(), 501u);
    EXPECT_NEAR(run.outputs[0].back(), -std::cos(end_angle), 2e-5) << run.name;
    EXPECT_NEAR(run.energy_end - run.energy_start, 0.0, 2e-3) << run.name;
    EXPECT_NEAR(run.peak_joint_force, 2.5 * mg, 0.2) << run.name;
    ASSERT_EQ(run.joint_forces.size(), 501u);
    EXPECT_NEAR(run.joint_forces.front(), &run == &c.runs[1] ? 0.0 : 0.25 * mg, 1e-9) << run.name;
    EXPECT_NEAR(run.joint_forces.back(), held, 2e-3 * held) << run.name;
    // the middle has fallen by ½ cos φ
    ASSERT_EQ(run.energies.size(), 501u);
    EXPECT_NEAR(run.energies.back().kinetic, 0.5 * mg * std::cos(end_angle), 2e-3) << run.name;
    EXPECT_NEAR(run.energies.back().potential(), -0.5 * mg * std::cos(end_angle), 2e-3) << run.name;
    EXPECT_EQ(run.energies.front().total(), 0.0) << run.name;
    ASSERT_EQ(run.violations.size(), 501u);
    double largest = 0.0;
    for (Violation const& v : run.violations) largest = std::max(largest, v.velocity);
    EXPECT_EQ(run.violation.velocity, largest) << run.name;
  }
  EXPECT_EQ(c.runs[0].difference[0], 0.0);
  EXPECT_GT(c.runs[1].difference[0], 0.0);
  EXPECT_LT(c.runs[1].difference[0], 1e-4);
  EXPECT_LT(c.runs[0].violation.position, 1e-12);
  EXPECT_EQ(c.runs[1].violation.position, 0.0);
  EXPECT_LT(c.runs[2].violation.velocity, 1e-10);
}

TEST(Compare, AsksTheFirstStateAfterEachSample) {
  using Controlled = Formulation<planar::Rigid, Constraint, DormandPrince<Projection>>;
  Pendulum const all{}, sampled{.sampling = 0.05}, within{.sampling = 0.0035};
  DormandPrince<Projection> const short_steps{.relative_tolerance = 1e-12, .absolute_tolerance = 1e-12};
  for (auto const& [run, full] : {std::pair(compare(sampled, Controlled{"own steps", {}, short_steps}).runs[0],
                                            compare(all, Controlled{"own steps", {}, short_steps}).runs[0]),
                                  {compare(sampled, Ideal{"ideal"}).runs[0], compare(all, Ideal{"ideal"}).runs[0]}}) {
    EXPECT_EQ(run.run.steps, full.run.steps) << run.name;  // the steps are unchanged
    ASSERT_EQ(run.times.size(), 11u) << run.name;
    ASSERT_EQ(run.outputs[0].size(), run.times.size());
    ASSERT_EQ(run.energies.size(), run.times.size());
    for (std::size_t k = 0; k < run.times.size(); ++k) {
      auto const after =
          std::find_if(full.times.begin(), full.times.end(), [&](double t) { return t > 0.05 * double(k) - 1e-12; });
      ASSERT_NE(after, full.times.end());
      EXPECT_EQ(run.times[k], *after) << run.name << ", sample " << k;
      EXPECT_EQ(run.outputs[0][k], full.outputs[0][std::size_t(after - full.times.begin())]);
    }
  }
  // 0, 4, 7, 11, 14 ms …, and the end, which is not a multiple
  ComparedRun const run = compare(within, Ideal{"ideal"}).runs[0];
  ASSERT_EQ(run.times.size(), 144u);
  EXPECT_NEAR(run.times[1], 0.004, 1e-12);
  EXPECT_NEAR(run.times[2], 0.007, 1e-12);
  EXPECT_NEAR(run.times[3], 0.011, 1e-12);
  EXPECT_NEAR(run.times.back(), 0.5, 1e-12);
  EXPECT_TRUE(has(refusal([] { compare(Pendulum{.sampling = -1.0}, Ideal{"ideal"}); }),
                  "compare: the sampling of \"ideal\" must be zero or positive"));
}

TEST(Compare, JoinsRunsThatWereMadeApart) {
  Ideal const ideal{"ideal", {}, {.rho_inf = 0.9}};
  Stiff const stiff{"stiff", {.stiffness = 1e5, .damping = 1e2}, {.rho_inf = 0.9}};
  Comparison const at_once = compare(Pendulum{}, ideal, stiff),
                   joined = join({compare(Pendulum{}, ideal), compare(Pendulum{}, stiff)});
  ASSERT_EQ(joined.runs.size(), 2u);
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_EQ(joined.runs[k].name, at_once.runs[k].name);
    EXPECT_EQ(joined.runs[k].outputs, at_once.runs[k].outputs);
    EXPECT_EQ(joined.runs[k].difference, at_once.runs[k].difference);
  }
  EXPECT_GT(joined.runs[1].difference[0], 1e-5);
  // A duplicate name, and different outputs.
  EXPECT_EQ(join({at_once, at_once}).runs[3].name, "stiff (2)");
  Comparison const other = compare(Pendulum{.outputs = {"y [m]"}}, ideal);
  EXPECT_TRUE(
      has(refusal([&] { join({at_once, other}); }), "the outputs of \"ideal (2)\" differ from those of \"ideal\""));
}

TEST(Compare, TypesAloneDoWhereEveryNumberHasADefault) {
  Comparison const c = compare<Ideal, Explicit>(Pendulum{});
  ASSERT_EQ(c.runs.size(), 2u);
  std::ostringstream text;
  text << c;
  for (char const* word : {"GeneralisedAlpha", "RungeKutta4", "degrees of freedom", "Newton iterations per step",
                           "peak joint force [N]", "end: tip y [m]"})
    EXPECT_NE(text.str().find(word), std::string::npos) << word;
}

TEST(Compare, TellsRunsOfTheSameNameApart) {
  std::vector<ComparedRun> runs(2);
  runs[0].name = "ideal";
  runs[1].name = "ideal (2)";
  EXPECT_EQ(detail::unique_name(runs, detail::name_of(Ideal{"ideal"})), "ideal (3)");
  EXPECT_EQ(detail::unique_name(runs, detail::name_of(Ideal{})), "GeneralisedAlpha");
}

TEST(Compare, RefusesOutputsThatCannotBePutSideBySide) {
  EXPECT_TRUE(has(refusal([] { compare(Pendulum{{"tip", "tip"}}, Ideal{"ideal"}); }),
                  "\"ideal\" need distinct, nonempty names"));
  EXPECT_TRUE(has(refusal([] { compare(Pendulum{{""}}, Ideal{}); }), "need distinct, nonempty names"));
  EXPECT_TRUE(has(refusal([] { compare(Pendulum{}, Ideal{"ideal"}, Ideal{"of its own mind"}); }),
                  "the outputs of \"of its own mind\" differ from those of \"ideal\""));
}

/// The pendulum with steps of 0.1 s for the run "absurd". The run "stops short" fails in its output after 0.2 s.
constexpr auto coarse = [](auto const& f) {
  auto scenario = Pendulum{}(f);
  if (f.name == "absurd") scenario.options.step = 0.1;
  if (f.name == "absurd") scenario.options.max_step_halvings = 0;
  if (f.name == "stops short")
    scenario.outputs[0].value = [tip = scenario.outputs[0].value](auto const& model, State const& x) {
      if (x.t > 0.2) throw NonFiniteValue("the output fails");
      return tip(model, x);
    };
  return scenario;
};
Stiff const absurd{"absurd", {.stiffness = 1e16, .damping = 0.0}, {.newton = {.max_iterations = 1}}};

// A penalty of 1e16 with steps of 0.1 s diverges. The results of the other runs are kept. The first complete run is
// the reference.
TEST(Compare, EndsWithAllRunsAndMarksTheFailedOnes) {
  Comparison const c = compare(coarse, absurd, Ideal{"ideal"}, Ideal{"stops short"}, Explicit{"explicit", {}, {}});
  ASSERT_EQ(c.runs.size(), 4u);
  EXPECT_TRUE(has(c.runs[0].failure, "at t = 0.1 s")) << c.runs[0].failure;
  EXPECT_EQ(c.runs[0].times, std::vector<double>{0.0});
  EXPECT_EQ(&c.reference(), &c.runs[1]);
  for (std::size_t const k : {1u, 3u}) {
    EXPECT_EQ(c.runs[k].failure, "");
    EXPECT_NEAR(c.runs[k].outputs[0].back(), -std::cos(end_angle), 2e-5) << c.runs[k].name;
    EXPECT_EQ(c.runs[k].difference.size(), 1u);
  }
  ComparedRun const& halfway = c.runs[2];  // 200 steps and the start; the step to 0.201 s has no output
  EXPECT_EQ(halfway.failure, "the output fails");
  ASSERT_EQ(halfway.times.size(), 201u);
  EXPECT_EQ(halfway.outputs[0].size(), 201u);
  EXPECT_EQ(halfway.energies.size(), 201u);
  EXPECT_EQ(halfway.difference[0], 0.0);
  EXPECT_NEAR(halfway.outputs[0].back(), exact_tip(0.2), 2e-5);
  std::ostringstream table;
  table << c;
  EXPECT_TRUE(has(table.str(), "absurd failed after t = 0 s: GeneralisedAlpha")) << table.str();
  EXPECT_TRUE(has(table.str(), "stops short failed after t = 0.2 s: the output fails"));
  EXPECT_EQ(join({c}).runs[2].failure, "the output fails");
}

TEST(Compare, AComparisonOfFailedRunsHasNoDifferences) {
  Comparison const c = compare(coarse, absurd, absurd);
  ASSERT_EQ(c.runs.size(), 2u);
  EXPECT_TRUE(std::isnan(c.runs[1].difference[0]));
  std::ostringstream table;
  EXPECT_NO_THROW(table << c);
}

TEST(Compare, RequiresAllRunsIfTheProgramAsks) {
  EXPECT_EQ(require_complete(compare(coarse, Ideal{"ideal"})).runs.size(), 1u);
  try {
    (void)require_complete(compare(coarse, absurd, Ideal{"ideal"}, Explicit{"explicit", {}, {}}));
    FAIL() << "a run that failed went unnoticed";
  } catch (ComparisonFailed const& failed) {
    EXPECT_TRUE(has(failed.what(), "compare: runs failed. \"absurd\": "));
    EXPECT_TRUE(has(failed.what(), "at t = 0.1 s"));
    ASSERT_EQ(failed.finished.runs.size(), 2u);
    EXPECT_EQ(failed.finished.runs[0].name, "ideal");
    for (ComparedRun const& run : failed.finished.runs) {
      EXPECT_NEAR(run.outputs[0].back(), -std::cos(end_angle), 2e-5) << run.name;
      EXPECT_EQ(run.difference.size(), 1u);
    }
  }
}

TEST(Compare, InterpolatesHistories) {
  std::vector<double> const t{0.0, 1.0, 3.0}, y{0.0, 2.0, 6.0};
  EXPECT_DOUBLE_EQ(detail::interpolate(t, y, 0.5), 1.0);
  EXPECT_DOUBLE_EQ(detail::interpolate(t, y, 2.0), 4.0);
  EXPECT_DOUBLE_EQ(detail::interpolate(t, y, -1.0), 0.0);
  EXPECT_DOUBLE_EQ(detail::interpolate(t, y, 9.0), 6.0);
  EXPECT_EQ(detail::interpolate(std::vector{2.0}, std::vector{7.0}, 2.0), 7.0);
}

// Interpolation is exact for a cubic, also if two times nearly coincide and one of their values has a round-off
// error.
TEST(Compare, InterpolatesByCubicsThatSkipCrumbs) {
  auto const cubic = [](double t) { return 1.0 + t * (2.0 - t * (3.0 - t)); };
  std::vector<double> const t{0.0, 0.4, 1.0, 1.0 + 1e-12, 2.0, 2.5, 3.5};
  std::vector<double> y;
  for (double const x : t) y.push_back(cubic(x));
  y[2] += 1e-15;
  for (double const x : {0.2, 0.7, 1.5, 2.2, 2.4, 3.0}) EXPECT_NEAR(detail::interpolate(t, y, x), cubic(x), 1e-13) << x;
  EXPECT_EQ(detail::interpolate(t, y, 2.5), y[5]);
}

TEST(WorkPrecision, ErrorOfASecondOrderMethodFallsWithTheSquareOfTheStep) {
  Ideal const ideal{"ideal", {}, {.rho_inf = 0.9}};
  std::vector<double> const steps{2e-2, 1e-2, 5e-3, 2.5e-3};
  WorkCurve const full = work_precision(Pendulum{}, ideal, steps, exact_tip);
  WorkCurve const end = work_precision(Pendulum{}, ideal, steps, -std::cos(end_angle));
  EXPECT_EQ(full.name, "ideal");
  EXPECT_EQ(full.output, "tip y [m]");
  ASSERT_EQ(full.points.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(full.points[i].setting, steps[i]);
    EXPECT_EQ(full.points[i].steps, std::lround(0.5 / steps[i]));
    EXPECT_EQ(full.points[i].failure, "");
    EXPECT_LE(end.points[i].error, full.points[i].error * (1.0 + 1e-6));
    if (i > 0) {
      EXPECT_NEAR(std::log2(full.points[i - 1].error / full.points[i].error), 2.0, 0.2) << steps[i];
      EXPECT_NEAR(std::log2(end.points[i - 1].error / end.points[i].error), 2.0, 0.2) << steps[i];
    }
  }
  // CPU time is measured in clock ticks, but eight times the steps take more than zero
  EXPECT_GT(full.points[3].cpu, 0.0);
}

TEST(WorkPrecision, TakesTheRunOfAnotherIntegratorForTheTruth) {
  Ideal const ideal{"ideal", {}, {.rho_inf = 0.9}};
  OutputHistory const fine = reference_run(Pendulum{}, Explicit{}, 1.1e-3);
  EXPECT_EQ(fine.times.size(), 456u);  // 0.5 s/1.1 ms, plus the start
  double const by_run = work_precision(Pendulum{}, ideal, {7e-3}, fine).points[0].error;
  double const exact = work_precision(Pendulum{}, ideal, {7e-3}, exact_tip).points[0].error;
  EXPECT_NEAR(by_run, exact, 1e-5 * exact);
}

TEST(WorkPrecision, ToleranceIsTheSettingOfAnIntegratorThatControlsItsStep) {
  DormandPrince<> adaptive;
  adaptive.absolute_tolerance = 1e-3 * adaptive.relative_tolerance;
  RunOptions options{.end_time = 1.0, .step = 0.1};
  detail::set_accuracy(adaptive, options, 1e-5);
  EXPECT_EQ(adaptive.relative_tolerance, 1e-5);
  EXPECT_NEAR(adaptive.absolute_tolerance, 1e-8, 1e-22);
  EXPECT_EQ(double(options.step), 0.1);
}

TEST(WorkPrecision, GoesOnWhereOneRunFails) {
  Ideal const hasty{"hasty", {}, {.rho_inf = 0.9, .newton = {.max_iterations = 2}}};
  WorkCurve const curve = work_precision(Pendulum{}, hasty, {0.25, 1e-3}, exact_tip);
  EXPECT_TRUE(has(curve.points[0].failure, "Newton"));
  EXPECT_EQ(curve.points[1].failure, "");
  EXPECT_LT(curve.points[1].error, 1e-5);
  WorkCurve const lost = work_precision(Pendulum{}, Ideal{}, {0.05}, nowhere);
  EXPECT_TRUE(has(lost.points[0].failure, "The error of \"tip y [m]\" is not finite at t = 0 s"));
}

TEST(WorkPrecision, RefusesWhatIsNoSetting) {
  EXPECT_TRUE(
      has(refusal([] { work_precision(Pendulum{}, Ideal{}, {}, 0.0); }), "at least one step or tolerance is needed"));
  EXPECT_TRUE(
      has(refusal([] { work_precision(Pendulum{}, Ideal{}, {0.0}, 0.0); }), "a step or tolerance must be positive"));
  EXPECT_TRUE(has(refusal([] { work_precision(Pendulum{}, Ideal{}, {1e-3}, 0.0, 1); }),
                  "output 1 does not exist; the case has 1"));
}

}  // namespace compare_test
