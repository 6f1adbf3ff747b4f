#include <polybody/analysis/compare.hpp>
#include <polybody/bodies/planar/rigid.hpp>
#include <polybody/integrators/generalized_alpha.hpp>
#include <polybody/integrators/runge_kutta.hpp>
#include <polybody/joints/planar/revolute.hpp>

#include <gtest/gtest.h>

#include <sstream>

namespace compare_test {

using namespace polybody;

// A rod of 1 m and 1 kg on a pin, released horizontally.
struct Pendulum {
  template <class F>
  auto operator()(F const& f) const {
    using Pin = Joint<planar::Revolute, typename F::PolicyType>;
    using M = Model<Bodies<typename F::BodyType>, Joints<Pin>>;
    M model{Gravity{0, -9.81, 0}};
    auto const rod = model.add(
        F::BodyType::from({.length = 1.0, .constants = BarConstants{.EA = 1e6, .EI = 1e3, .mass_per_length = 1.0}}), "rod");
    model.connect(Pin{{}, f.policy}, model.ground().at({0, 0, 0}), rod.at(0.0), "pin");
    State const start = model.reference_state();
    auto const tip = rod.at(1.0);
    return Scenario<M>{std::move(model), start, {.until = 0.5, .step = 1e-3},
                       {{"tip y [m]", [tip](M const& m, State const& x) { return position(m, x, tip)[1]; }}}};
  }
};

using Ideal = Formulation<planar::Rigid, Constraint, GeneralizedAlpha>;
using Stiff = Formulation<planar::Rigid, Penalty, GeneralizedAlpha>;
using Explicit = Formulation<planar::Rigid, Constraint, RungeKutta4<Projection>>;

TEST(Compare, RunsOneCaseUnderSeveralFormulations) {
  Comparison const c = compare(Pendulum{}, Ideal{"ideal", {}, {.rho_inf = 0.9}},
                               Stiff{"penalty", {.stiffness = 1e7, .damping = 1e3}, {.rho_inf = 0.9}},
                               Explicit{"explicit", {}, {}});
  ASSERT_EQ(c.runs.size(), 3u);
  // Table 3.4's way of counting: the penalty takes no degree of freedom away.
  EXPECT_EQ(c.runs[0].census.degrees_of_freedom, 1);
  EXPECT_EQ(c.runs[1].census.degrees_of_freedom, 3);
  EXPECT_EQ(c.runs[0].census.rows, 2);
  EXPECT_EQ(c.runs[1].census.rows, 0);
  for (ComparedRun const& run : c.runs) {
    EXPECT_EQ(run.run.steps, 500);
    EXPECT_EQ(run.times.size(), 501u);
    // CASES.md J1 (Chrono/ADAMS-type rod pendulum): phi(0.5) = -0.090352089956 from the downward vertical
    EXPECT_NEAR(run.outputs[0].back(), -std::cos(0.090352089956), 2e-5) << run.name;
    EXPECT_NEAR(run.energy_end - run.energy_start, 0.0, 2e-3) << run.name;
    EXPECT_NEAR(run.peak_joint_force, 24.5, 0.2) << run.name;  // 2.5 m g at the bottom
  }
  EXPECT_EQ(c.runs[0].difference[0], 0.0);
  EXPECT_GT(c.runs[1].difference[0], 0.0);
  EXPECT_LT(c.runs[1].difference[0], 1e-4);
  EXPECT_LT(c.runs[0].violation.position, 1e-12);
  EXPECT_LT(c.runs[2].violation.velocity, 1e-10);
}

TEST(Compare, TypesAloneDoWhereEveryNumberHasADefault) {
  Comparison const c = compare<Ideal, Explicit>(Pendulum{});
  ASSERT_EQ(c.runs.size(), 2u);
  std::ostringstream text;
  text << c;
  for (char const* word : {"degrees of freedom", "Newton iterations a step", "peak joint force [N]", "end: tip y [m]"})
    EXPECT_NE(text.str().find(word), std::string::npos) << word;
}

TEST(Compare, InterpolatesHistories) {
  std::vector<double> const t{0.0, 1.0, 3.0}, y{0.0, 2.0, 6.0};
  EXPECT_DOUBLE_EQ(detail::interpolate(t, y, 0.5), 1.0);
  EXPECT_DOUBLE_EQ(detail::interpolate(t, y, 2.0), 4.0);
  EXPECT_DOUBLE_EQ(detail::interpolate(t, y, -1.0), 0.0);
  EXPECT_DOUBLE_EQ(detail::interpolate(t, y, 9.0), 6.0);
}

}  // namespace compare_test
