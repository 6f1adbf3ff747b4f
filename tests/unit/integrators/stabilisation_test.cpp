// Constraint stabilisation in explicit steps, and the drift of constraint equations without it.

#include <polybody/integrators/coordinate_partitioning.hpp>

#include <gtest/gtest.h>

#include <polybody/integrators/runge_kutta.hpp>
#include <polybody/integrators/symplectic.hpp>
#include <polybody/testing/integrator_laws.hpp>

#include "support/held.hpp"
#include "support/integrator_cases.hpp"
#include "support/refusal.hpp"

using namespace polybody;
using namespace polybody::laws;

namespace stabilisation_test {

struct PartitionedBar {
  using Model = SwingingBar;
  static auto integrators() { return std::vector<RungeKutta4<CoordinatePartitioning>>(1); }
  static constexpr double end_time = 0.5;
  static constexpr int steps = 16;
};
struct PartitionedTop {
  using Model = SlowTop;
  static auto integrators() { return std::vector<RungeKutta4<CoordinatePartitioning>>(1); }
  static constexpr double end_time = 0.5;
  static constexpr int steps = 16;
};
struct PartitionedDifferences {
  using Model = SwingingBar;
  static auto integrators() { return std::vector<CentralDifference<CoordinatePartitioning>>(1); }
  static constexpr double end_time = 0.5;
  static constexpr int steps = 32;
  static constexpr bool keeps_accelerations = false;  // the accelerations belong to the predicted velocities
};

}  // namespace stabilisation_test

namespace polybody {
bool const stabilisation_obey[] = {
    obeys<stabilisation_test::PartitionedBar, IntegratorLaws>("PartitionedBar"),
    obeys<stabilisation_test::PartitionedTop, IntegratorLaws>("PartitionedTop"),
    obeys<stabilisation_test::PartitionedDifferences, IntegratorLaws>("PartitionedDifferences")};
}  // namespace polybody

namespace stabilisation_test {

/// Largest difference over 1 s between Φ of a bar with an initial violation of its pin and `expected(t, Φ₀, Φ̇₀)`,
/// relative to the initial value.
template <class I, class Expected>
double worst_of_open_pin(I const& integrator, Expected expected) {
  SwingingBar bar;
  System system(bar.model);
  State x = bar.start;
  x.q[0] += 1e-3;
  x.v[1] += 2e-2;
  VecX phi0 = VecX::Zero(2), rate0 = phi0, phi = phi0;
  system.evaluate(x.q, x.v, 0.0);
  system.violation(phi0);
  system.violation_rate(rate0);
  auto const method = method_of(integrator);
  auto workspace = method.template workspace<DenseLu>(system);
  double const h = 1e-3;
  method.start(system, x, h, workspace);
  double worst = 0.0;
  for (int i = 1; i <= 1000; ++i) {
    method.step(system, x, h, workspace);
    system.evaluate(x.q, x.v, x.t);
    system.violation(phi);
    worst = std::max(worst, (phi - expected(i * h, phi0, rate0)).norm());
  }
  return worst / (phi0.norm() + rate0.norm());
}

// The solution of Φ̈ = 0 is Φ = Φ₀ + Φ̇₀ t.
TEST(NoStabilisation, LeavesTheRowsToThemselves) {
  auto const straight = [](double t, VecX const& phi, VecX const& rate) { return VecX(phi + t * rate); };
  held_within({"closed forms", "violation of a pin that starts open, over 1 s, of its start", By::closed_form,
               "Φ₀ + Φ̇₀ t", "Runge–Kutta 4, NoStabilisation"},
              worst_of_open_pin(RungeKutta4<NoStabilisation>{}, straight), 1e-7, {.scale = 1.0});
}

// The solution of Φ̈ + 2α Φ̇ + β² Φ = 0 is Φ = e^{−αt} (Φ₀ cos ωt + (Φ̇₀ + α Φ₀) sin ωt / ω), ω² = β² − α².
TEST(Baumgarte, LetsAViolationDieAwayAsItsEquationSays) {
  double const alpha = 3.0, beta = 5.0, omega = 4.0;
  auto const damped = [&](double t, VecX const& phi, VecX const& rate) {
    return VecX(std::exp(-alpha * t) *
                (phi * std::cos(omega * t) + (rate + alpha * phi) * (std::sin(omega * t) / omega)));
  };
  Baumgarte const given{.alpha = alpha, .beta = beta};
  held_within({"closed forms", "violation of a pin that starts open, over 1 s, of its start", By::closed_form,
               "Φ̈ + 2α Φ̇ + β² Φ = 0", "Runge–Kutta 4, Baumgarte"},
              worst_of_open_pin(RungeKutta4<Baumgarte>{.stabilisation = given}, damped), 1e-7, {.scale = 1.0});
}

// The reference is the exact pendulum: stabilisation does not change the order of the method.
template <class I>
double order_on_the_pendulum(I const& integrator, int steps) {
  SwingingBar bar;
  std::vector<double> errors;
  for (int const n : {steps, 2 * steps}) {
    State x = bar.start;
    simulate(bar.model, x, integrator, {.end_time = 0.5, .step = 0.5 / n}).run();
    errors.push_back(std::abs(x.q[2] + 0.5 * std::numbers::pi - bar.exact(bar.phase + 0.5).angle));
  }
  EXPECT_GT(errors.back(), 1e-12);
  EXPECT_LT(errors.back(), 1e-3);
  return slopes(errors).back();
}

TEST(Stabilisation, KeepsTheOrderOfTheMethod) {
  Baumgarte const given{.alpha = 10.0, .beta = 10.0};
  EXPECT_GT(order_on_the_pendulum(RungeKutta4<NoStabilisation>{}, 16), 3.8);
  EXPECT_GT(order_on_the_pendulum(RungeKutta4<Baumgarte>{.stabilisation = given}, 16), 3.8);
  EXPECT_GT(order_on_the_pendulum(CentralDifference<NoStabilisation>{}, 64), 1.9);
  EXPECT_GT(order_on_the_pendulum(CentralDifference<Baumgarte>{.stabilisation = given}, 64), 1.9);
}

/// A crank of 1 m, a coupler of 3.5 m and a rocker of 3 m over a base of 4 m. 1 + 4 < 3.5 + 3, so the crank rotates
/// fully and no configuration is singular [Grashof]. The crank starts upright at 3 rad/s, under gravity.
struct CrankRocker {
  using Pin = Joint<planar::Revolute, Constraint>;
  Model<Bodies<planar::Rigid>, Joints<Pin>> model{Gravity{0, -9.81, 0}};
  State x;

  CrankRocker() {
    Vec2 const a(0, 0), b(0, 1), d(4, 0);
    // C is 3.5 m from B and 3 m from D, above the base
    Vec2 const along = (d - b).normalized();
    double const bd = (d - b).norm(), s = (bd * bd + 3.5 * 3.5 - 9.0) / (2.0 * bd);
    Vec2 const c = b + s * along + std::sqrt(3.5 * 3.5 - s * s) * Vec2(-along[1], along[0]);
    auto const bar = [&](Vec2 const& from, Vec2 const& to, char const* name) {
      Vec2 const middle = 0.5 * (from + to), u = to - from;
      Placement const place = Placement::planar(middle[0], middle[1], std::atan2(u[1], u[0]));
      return model.add(planar::Rigid(1.0, u.squaredNorm() / 12.0, place), name);
    };
    auto const crank = bar(a, b, "crank"), coupler = bar(b, c, "coupler"), rocker = bar(c, d, "rocker");
    model.connect(Pin{}, model.ground().at({0, 0, 0}), crank.at(Vec2(-0.5, 0)), "A");
    model.connect(Pin{}, crank.at(Vec2(0.5, 0)), coupler.at(Vec2(-1.75, 0)), "B");
    model.connect(Pin{}, coupler.at(Vec2(1.75, 0)), rocker.at(Vec2(-1.5, 0)), "C");
    model.connect(Pin{}, rocker.at(Vec2(1.5, 0)), model.ground().at({4, 0, 0}), "D");
    x = model.reference_state();
    // simulate makes the other velocities consistent with the constraint equations
    model.set_velocity(x, crank, Vec3::Zero(), Vec3(0, 0, 3));
  }
};

/// Largest constraint violations over [0, 10 s] and over [0, 100 s], and the largest change of energy relative to the
/// weight times 1 m.
struct LongRun {
  Violation early, all;
  double energy = 0.0;

  template <class I>
  explicit LongRun(I const& integrator) {
    CrankRocker mechanism;
    System system(mechanism.model);
    double start = std::numeric_limits<double>::quiet_NaN();
    auto run = simulate(mechanism.model, mechanism.x, integrator, {.end_time = 100.0, .step = 0.01});
    for (State const& now : run) {
      Violation const open = largest_violation(system, now);
      all.position = std::max(all.position, open.position);
      all.velocity = std::max(all.velocity, open.velocity);
      all.acceleration = std::max(all.acceleration, open.acceleration);
      if (now.t <= 10.0) early = all;
      double const total = polybody::energy(system, now).total();
      if (now.t == 0.0) start = total;
      energy = std::max(energy, std::abs(total - start) / (3.0 * 9.81));
    }
  }
};

// 1e4 steps. Tolerance of Φ: that of the policy. Tolerance of Φ̇ and Φ̈: round-off of terms of 10 m/s and 100 m/s².
TEST(CoordinatePartitioning, KeepsEveryLevelOfAFourBarFor100Seconds) {
  LongRun const kept(RungeKutta4<CoordinatePartitioning>{});
  auto const claim = [](char const* what, char const* source) {
    return Claim{"closed forms", what, By::closed_form, source, "Runge–Kutta 4, CoordinatePartitioning, h = 0.01 s"};
  };
  held_within(claim("gap of a crank-rocker in 100 s [m]", "rows hold"), kept.all.position, 1e-11, {.scale = 1.0});
  held_within(claim("rate of the gap of a crank-rocker in 100 s [m/s]", "rows hold"), kept.all.velocity, 1e-12,
              {.scale = 10.0});
  held_within(claim("rate of rate of the gap of a crank-rocker in 100 s [m/s²]", "rows hold"), kept.all.acceleration,
              1e-11, {.scale = 100.0});
  held_within(claim("change of energy of a crank-rocker in 100 s, of its weight times 1 m", "invariant"), kept.energy,
              1e-2, {.scale = 1.0});
}

TEST(NoStabilisation, DriftsOffAFourBar) {
  LongRun const drifting(RungeKutta4<NoStabilisation>{});
  EXPECT_GT(drifting.all.position, 1e-4);
  EXPECT_GT(drifting.all.position, 5.0 * drifting.early.position);
  EXPECT_GT(drifting.all.velocity, 1e-6);
  EXPECT_LT(drifting.all.acceleration, 1e-11);  // the augmented form enforces the accelerations only
}

TEST(Baumgarte, HoldsAFourBarWithinASmallGap) {
  LongRun const held(RungeKutta4<Baumgarte>{.stabilisation = {.alpha = 10.0, .beta = 10.0}});
  EXPECT_LT(held.all.position, 1e-5);
  EXPECT_LT(held.all.position, 3.0 * held.early.position);  // the violation does not grow
  EXPECT_GT(held.all.position, 1e-11);                      // the violation does not decay
}

/// Steps of a partitioned run to `end_time`, and the number of choices of independent velocities.
template <class M>
long choices(M const& model, State& x, double h, double end_time) {
  System system(model);
  RungeKutta4<CoordinatePartitioning> const integrator;
  auto const method = method_of(integrator);
  auto workspace = method.template workspace<DenseLu>(system);
  method.start(system, x, h, workspace);
  for (long i = std::lround(end_time / h); i > 0; --i) method.step(system, x, h, workspace);
  return workspace.scratch.rows.choices;
}

// The middle of a rod 2 m from its pin is at (2 sin θ, −2 cos θ) at the angle θ from the vertical. The rotation is
// dependent because its moment arm is the largest entry. y is independent if |cot θ| < 10, x if |tan θ| < 10. So a
// rod that starts level with y changes to x and back, by atan 0.1 before each quarter rotation.
TEST(CoordinatePartitioning, ChangesItsChoiceAsARodTurnsOver) {
  using Pin = Joint<planar::Revolute, Constraint>;
  Model<Bodies<planar::Rigid>, Joints<Pin>> model{Gravity{0, -9.81, 0}};
  auto const rod = model.add(planar::Rigid(1.0, 1.0 / 3.0, Placement::planar(2.0, 0.0)), "rod");
  model.connect(Pin{}, model.ground().at({0, 0, 0}), rod.at(Vec2(-2, 0)), "pin");
  State x = model.reference_state();
  model.set_velocity(x, rod, Vec3::Zero(), Vec3(0, 0, 6));
  double const start = energy(model, x).total();
  long const counted = choices(model, x, 1e-3, 10.0);
  EXPECT_GT(x.q[2], 8.0 * std::numbers::pi);
  EXPECT_EQ(counted, 1 + std::lround(std::floor((x.q[2] + std::atan(0.1)) / (0.5 * std::numbers::pi))));
  EXPECT_NEAR(energy(model, x).total(), start, 1e-6);
  System system(model);
  EXPECT_LT(largest_violation(system, x).position, 1e-11);
}

// Revolute joint test of Chrono against ADAMS (J2): three swings in 5 s, released level. The third swing is within 1°
// of its end. In each swing the choice changes to x and back.
TEST(CoordinatePartitioning, FollowsTheAdamsCase) {
  using Pin = Joint<Revolute, Constraint>;
  Model<Bodies<Rigid<>>, Joints<Pin>> model{Gravity{0, 0, -9.80665}};
  Mat3 const inertia = Vec3(0.04, 0.1, 0.1).asDiagonal();
  auto const bar = model.add(Rigid<>(1.0, inertia, Placement::at({2, 0, 0})), "bar");
  model.connect(Pin{Revolute{.axis = Vec3::UnitY()}, {}}, model.ground().at({0, 0, 0}), bar.at(Vec3(-2, 0, 0)), "pin");
  State x = model.reference_state();
  EXPECT_EQ(choices(model, x, 1e-3, 5.0), 7);
  held_within({"J2", "middle of the bar at 5 s [m]", By::independent, "ordinary solver of order eight",
               "Revolute, Runge–Kutta 4, CoordinatePartitioning"},
              (x.q.head<3>() - Vec3(-1.999683869, 0, -0.035558748)).norm(), 1e-8, {.scale = 2.0});
}

TEST(CoordinatePartitioning, StartForgetsTheChoice) {
  SwingingBar bar;
  System system(bar.model);
  RungeKutta4<CoordinatePartitioning> const integrator;
  auto const method = method_of(integrator);
  auto workspace = method.workspace<DenseLu>(system);
  State x = bar.start;
  for (long const expected : {1, 2}) {
    method.start(system, x, 1e-3, workspace);
    for (int i = 0; i < 10; ++i) method.step(system, x, 1e-3, workspace);
    EXPECT_EQ(workspace.scratch.rows.choices, expected);
  }
}

// The constraint equations of a pin are linear in the position of its rod, so one iteration is enough. The equations
// of a loop are nonlinear.
TEST(CoordinatePartitioning, SaysThatThePositionsCannotBeBroughtBack) {
  CrankRocker mechanism;
  assemble(mechanism.model, mechanism.x);
  System system(mechanism.model);
  RungeKutta4<CoordinatePartitioning> const integrator{.stabilisation = {.max_iterations = 1}};
  auto const method = method_of(integrator);
  auto workspace = method.workspace<DenseLu>(system);
  State x = mechanism.x;
  method.start(system, x, 0.2, workspace);
  State const before = x;
  EXPECT_TRUE(has(message_of<NewtonConvergenceFailure>([&] { method.step(system, x, 0.2, workspace); }),
                  "Take a smaller step"));
  EXPECT_EQ(x.q, before.q);
  EXPECT_EQ(x.t, before.t);
}

TEST(Stabilisation, RefusesOptionsThatCannotBeMeant) {
  SwingingBar bar;
  auto const told = [&](auto const& integrator) {
    State x = bar.start;
    return refusal([&] { simulate(bar.model, x, integrator, {.end_time = 1.0, .step = 0.1}); });
  };
  using Damped = RungeKutta4<Baumgarte>;
  EXPECT_TRUE(has(told(Damped{.stabilisation = {.alpha = 0.0, .beta = 1.0}}), "Baumgarte: alpha must be positive"));
  EXPECT_TRUE(has(told(Damped{.stabilisation = {.alpha = 1.0, .beta = -1.0}}), "Baumgarte: beta must be positive"));
  EXPECT_TRUE(has(told(RungeKutta4<Projection>{.stabilisation = {.tolerance = 0.0}}), "Projection: the tolerance"));
  using Partitioned = RungeKutta4<CoordinatePartitioning>;
  EXPECT_TRUE(has(told(Partitioned{.stabilisation = {.tolerance = -1.0}}), "CoordinatePartitioning: the tolerance"));
  EXPECT_TRUE(
      has(told(Partitioned{.stabilisation = {.largest_ratio = 0.5}}), "largest_ratio must be at least 1, but is 0.5"));
}

/// Writes G as constraint equations of a tangent, and r and 2r as right-hand sides.
void write(PartitionedConstraints& rows, MatX const& g, VecX const& r) {
  rows.begin();
  rows.add(g.cols(), 0, g);
  for (Index i = 0; i < r.size(); ++i) {
    rows.right(0, i) = r[i];
    rows.right(1, i) = 2.0 * r[i];
  }
}

// The third row is the sum of the others, so the rank is 2. Then the row changes and the rank is 3.
TEST(PartitionedConstraints, FindTheRankAndSolve) {
  MatX g(3, 4);
  g << 1, 2, 0, 4, 3, -1, 5, 0, 4, 1, 5, 4;
  Vec3 const r(1, 2, 3);
  PartitionedConstraints rows(3, 4);
  write(rows, g, r);
  EXPECT_FALSE(rows.reduce(10.0));  // no new choice
  write(rows, g, r);
  rows.choose();
  EXPECT_EQ(rows.rank(), 2);
  VecX b = VecX::Zero(4);
  for (int const side : {0, 1}) {
    rows.solution(side, b);
    EXPECT_LT((g * b - (1 + side) * r).norm(), 1e-14);
    for (Index j = 0; j < 4; ++j) EXPECT_EQ(rows.is_dependent(j), b[j] != 0.0);
  }
  write(rows, g, r);
  EXPECT_TRUE(rows.reduce(10.0));
  rows.solution(0, b);
  EXPECT_LT((g * b - r).norm(), 1e-14);

  g(2, 0) += 1e-3;
  write(rows, g, r);
  EXPECT_FALSE(rows.reduce(10.0));
  write(rows, g, r);
  rows.choose();
  EXPECT_EQ(rows.rank(), 3);
  rows.solution(0, b);
  EXPECT_LT((g * b - r).norm(), 1e-10);
  EXPECT_EQ(rows.choices, 2);
}

// One row (1, s): the first column remains dependent until its ratio to the second exceeds the limit.
TEST(PartitionedConstraints, ChooseAnewWhereADependentSpeedMovesTooMuch) {
  PartitionedConstraints rows(1, 2);
  MatX g(1, 2);
  VecX const r = VecX::Ones(1);
  g << 1.0, 0.5;
  write(rows, g, r);
  rows.choose();
  for (double const s : {0.5, 3.0, 9.9}) {
    g(0, 1) = s;
    write(rows, g, r);
    EXPECT_TRUE(rows.reduce(10.0)) << s;
    EXPECT_TRUE(rows.is_dependent(0));
  }
  g(0, 1) = 10.1;
  write(rows, g, r);
  EXPECT_FALSE(rows.reduce(10.0));
  write(rows, g, r);
  rows.choose();
  EXPECT_TRUE(rows.is_dependent(1));
  EXPECT_FALSE(rows.is_dependent(0));
}

}  // namespace stabilisation_test
