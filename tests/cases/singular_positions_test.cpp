// Four-bars (R2) pass their singular configuration with the methods whose matrix must include the change of the
// constraint Jacobian there. The α-methods are in redundant_joints_test.cpp.

#include <gtest/gtest.h>

#include <polybody/integrators/energy_momentum.hpp>
#include <polybody/integrators/generalised_alpha.hpp>
#include <polybody/integrators/radau.hpp>
#include <polybody/integrators/runge_kutta.hpp>
#include <polybody/run/probe.hpp>
#include <polybody/run/simulate.hpp>
#include <polybody/solvers/block_factor.hpp>

#include "support/linkages.hpp"
#include "support/refusal.hpp"

namespace polybody {
namespace singular_positions_test {

/// Result of a run of four-bars.
struct Turned {
  double off = 0.0, gained = 0.0;  ///< error of the corner B₀ [m]; energy gained [J]
  std::vector<std::string> warnings;
};
template <class Solver = DefaultSolver, class I>
Turned turn(int n, double end_time, I const& integrator, double step) {
  FourBars<InPlane<Constraint>> bars(n);
  double const before = energy(bars.model, bars.x).total();
  RunReport const report = simulate<Solver>(bars.model, bars.x, integrator, {.end_time = end_time, .step = step}).run();
  Turned out{0.0, energy(bars.model, bars.x).total() - before, report.warnings};
  for (Corner const& c : breakpoints)
    if (c.n == n && c.t == end_time) out.off = (bars.corner() - Vec3(c.x, c.y, 0)).norm();
  return out;
}

// The mean of G over the step differs from G at its end. The difference is as large as the distance of G from a
// rank-deficient matrix.
TEST(SingularPosition, IsPassedByStepsThatConserveEnergy) {
  Turned const r = turn(2, 1, EnergyMomentum{}, 1e-3);
  EXPECT_LT(r.off, 1e-5);
  EXPECT_LT(std::abs(r.gained), 1e-7);
  EXPECT_TRUE(r.warnings.empty());
}
// A step at this configuration also has a solution on the kite's branch, and full Newton iterations may converge to
// it.
TEST(SingularPosition, IsPassedOnTheBranchThatChangesSpeedsLeast) {
  for (double const step : {1e-3, 5e-4}) {
    Turned const r = turn(1, 4, EnergyMomentum{}, step);
    EXPECT_LT(r.off, 2e-5) << step;
    EXPECT_LT(std::abs(r.gained), 1e-6) << step;
    EXPECT_TRUE(r.warnings.empty()) << step;
  }
}
// The tangent of such a step is not symmetric. `BlockLdlt::Unsymmetric` factorises it.
TEST(SingularPosition, IsPassedBySolversThatReadOneHalfOfAMatrix) {
  static_assert(std::is_same_v<UnsymmetricSolver<BlockLdlt>, BlockLu>);
  Turned const r = turn<BlockLdlt>(1, 4, EnergyMomentum{}, 1e-3);
  EXPECT_LT(r.off, 2e-5);
  EXPECT_LT(std::abs(r.gained), 1e-6);
}
TEST(SingularPosition, IsPassedByStepsThatLoseEnergy) {  // of order one
  Turned const r = turn(2, 1, EnergyDecaying{.rho_inf = 0.95}, 1e-3);
  EXPECT_LT(r.off, 1e-2);
  EXPECT_LT(r.gained, 0.0);
  EXPECT_GT(r.gained, -0.1);
}
// G differs as much between the stages.
TEST(SingularPosition, IsPassedByRadau) {
  Turned const r = turn(2, 1, Radau{}, 2.5e-4);
  EXPECT_LT(r.off, 1e-8);
  EXPECT_LT(std::abs(r.gained), 1e-8);
  EXPECT_TRUE(r.warnings.empty());
}

// Forty windows. The distance of a step's end from the singular configuration is 3 % of its length. There corrections
// of 3e-4 m/s² are round-off, which exceeds the tolerance of four last digits.
TEST(SingularPosition, MayBePassedWithoutTheMultipliersOfStabilisedSteps) {
  Turned const r = turn(40, 10, GeneralisedAlpha{.rho_inf = 0.95, .stabilised = true}, 2e-3);
  EXPECT_LT(r.off, 1.5e-4);
  EXPECT_LT(std::abs(r.gained), 1e-3);  // of 620 J; round-off: 1.7e-4 to 6.6e-4 J, by the solver
  EXPECT_TRUE(r.warnings.empty());
}

// A step ends 1.5e-6 rad from the singular configuration. The equations of its stages are also singular there,
// because Radau's nodes make ∫ (1 − t)(t − c₁)(t − c₂)(t − 1) dt zero. Round-off then determines the multipliers of
// the lost constraint equations.
TEST(SingularPosition, MayBeWhereAStepOfRadauEnds) {
  FourBars<InPlane<Constraint>> bars(3);
  double const before = energy(bars.model, bars.x).total();
  simulate(bars.model, bars.x, Radau{}, {.end_time = 1.2, .step = 1e-3}).run();
  simulate(bars.model, bars.x, Radau{}, {.end_time = 1.3, .step = 6.25e-5}).run();
  EXPECT_LT(std::abs(energy(bars.model, bars.x).total() - before), 1e-8);  // of 55 J
  for (int i = 1; i <= 3; ++i) EXPECT_NEAR(bars.x.q[3 * i + 2], bars.x.q[2], 1e-8);
}

/// Two windows to 0.7 s. The next steps are such that the k-th one is at the flat configuration after the fraction
/// `share` of its length.
void expect_passes_with_node_at(double share) {
  for (int const k : {12, 50, 230}) {
    FourBars<InPlane<Constraint>> bars(2);
    double const before = energy(bars.model, bars.x).total(), flat = 0.7143555292929605;  // R2
    simulate(bars.model, bars.x, Radau{}, {.end_time = 0.7, .step = 1e-3}).run();
    double const step = (flat - bars.x.t) / (k - 1 + share);
    simulate(bars.model, bars.x, Radau{}, {.end_time = flat + 8.0 * step, .step = step}).run();
    EXPECT_LT(std::abs(energy(bars.model, bars.x).total() - before), 1e-9) << k;  // of 36 J
    for (int i = 1; i <= 2; ++i) EXPECT_NEAR(bars.x.q[3 * i + 2], bars.x.q[2], 1e-11) << k;
  }
}
// If a step ends there, three equations of the stages coincide. At another node the multipliers of the lost
// constraint equations are undetermined, and full Newton iterations diverge. The cause is not round-off.
TEST(SingularPosition, MayBeAnEndOfAStepOfRadau) {
  for (double const beside : {0.0, 1e-9, -1e-6, 1e-4}) expect_passes_with_node_at(1.0 + beside);
}
TEST(SingularPosition, MayBeAnyNodeOfRadau) {
  for (double const node : {0.155, detail::RadauTableau::c[0], 0.645, detail::RadauTableau::c[1]})
    expect_passes_with_node_at(node);
}

/// One window in its flat configuration. \param crank, coupler angular velocities [rad/s] of the first crank and of
/// the coupler; `coupler` is zero on the parallelogram's branch, `crank` on the kite's branch
FourBars<InPlane<Constraint>> flat_window(double crank, double coupler) {
  FourBars<InPlane<Constraint>> bars(1);
  auto const lay = [&](int link, double x, double speed, double rate) {
    bars.x.q.segment<3>(3 * link) = Vec3(x, 0.0, 0.0);
    bars.x.v.segment<3>(3 * link) = Vec3(0.0, speed, rate);
  };
  lay(0, 0.5, 0.5 * crank, crank);
  lay(1, 1.5, 0.5 * (crank + coupler), crank + coupler);
  lay(2, 1.5, crank + 0.5 * coupler, coupler);
  return bars;
}
template <class I>
std::vector<std::string> warnings_of_flat_start(I const& integrator, double crank, double coupler) {
  auto bars = flat_window(crank, coupler);
  return simulate(bars.model, bars.x, integrator, {.end_time = 0.01, .step = 1e-3}).run().warnings;
}

TEST(SingularPosition, IsReportedWhereARunStartsInItWithoutABranch) {
  auto const expect = [](auto const& integrator) {
    std::vector<std::string> const rest = warnings_of_flat_start(integrator, 0.0, 0.0);
    ASSERT_FALSE(rest.empty());  // the change of branch, some steps later, is also reported
    EXPECT_TRUE(
        has(rest[0], "The run starts in a singular configuration at t = 0 s: the constraint equations of joint \""));
    EXPECT_TRUE(has(rest[0], "Start near this configuration, or with velocities of one branch"));
    EXPECT_TRUE(warnings_of_flat_start(integrator, -4.0, 0.0).empty());
  };
  expect(Radau{});
  expect(GeneralisedAlpha{});
  expect(RungeKutta4<Projection>{});
  EXPECT_TRUE(warnings_of_flat_start(Radau{}, 0.0, -4.0).empty());  // the kite
}
// The angular velocities ω₀ and ω_c of crank and coupler must satisfy ω₀ ω_c = 0.
TEST(SingularPosition, RefusesSpeedsOfNoBranch) {
  std::string const told =
      message_of<InconsistentInitialConditions>([] { warnings_of_flat_start(Radau{}, -4.0, 4.0); });
  EXPECT_TRUE(has(told, "contradict each other by"));
  EXPECT_TRUE(has(told, "in a singular configuration, start with the velocities of one branch"));
}
// In space the pins of the loop have three redundant constraint equations in every configuration.
TEST(SingularPosition, IsNotTakenForRowsThatAlwaysRepeat) {
  FourBars<InSpace<Constraint>> bars(1);
  bars.x.v.setZero();
  EXPECT_TRUE(
      simulate(bars.model, bars.x, GeneralisedAlpha{}, {.end_time = 0.01, .step = 1e-3}).run().warnings.empty());
}

// The constraint equations that lose rank at the start are satisfied afterwards.
TEST(SingularPosition, MayBeWhereARunOfRadauStarts) {
  for (int const n : {1, 3}) {
    FourBars<InPlane<Constraint>> bars(n);
    auto const lay = [&](int link, double x, double speed, double rate) {
      bars.x.q.segment<3>(3 * link) = Vec3(x, 0.0, 0.0);
      bars.x.v.segment<3>(3 * link) = Vec3(0.0, speed, rate);
    };
    for (int i = 0; i <= n; ++i) lay(i, i + 0.5, -2.0, -4.0);
    for (int i = 0; i < n; ++i) lay(n + 1 + i, i + 1.5, -4.0, 0.0);
    double const before = energy(bars.model, bars.x).total();
    simulate(bars.model, bars.x, Radau{}, {.end_time = 0.1, .step = 1e-3}).run();
    EXPECT_LT(std::abs(energy(bars.model, bars.x).total() - before), 1e-9) << n;
    for (int i = 1; i <= n; ++i) EXPECT_NEAR(bars.x.q[3 * i + 2], bars.x.q[2], 1e-12) << n;
  }
}

/// Reverses the motion in the step that reaches a given time. The jump of the velocities satisfies the constraint
/// equations and conserves energy, like a change of branch.
struct TurningRound : RungeKutta4<Projection> {
  double at = 0.0;  ///< [s]
  template <class W>
  StepReport step(System& system, State& x, double h, W& w) const {
    StepReport const report = RungeKutta4<Projection>::step(system, x, h, w);
    if (x.t >= at && x.t < at + 0.5 * h) x.v = -x.v;
    return report;
  }
};

// One window is flat at 0.7085 s. There the motion can continue as the parallelogram or as the kite, in which B₀(1)
// stays at (1, 0). At 0.3 s the continuation is unique.
TEST(SingularPosition, IsReportedWhereTheSpeedsJumpThere) {
  auto const warnings = [](double at) {
    TurningRound integrator;
    integrator.at = at;
    return turn(1, at + 0.005, integrator, 1e-3).warnings;
  };
  std::vector<std::string> const flat = warnings(0.709), far = warnings(0.3);
  ASSERT_EQ(flat.size(), 1u);
  EXPECT_TRUE(has(flat[0], "The constraint equations lose rank near t = 0.709 s"));
  EXPECT_TRUE(far.empty());
}

}  // namespace singular_positions_test
}  // namespace polybody
