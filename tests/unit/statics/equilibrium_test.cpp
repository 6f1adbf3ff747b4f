#include <polybody/statics/equilibrium.hpp>

#include <polybody/bodies/lrvf/planar_lrvf.hpp>
#include <polybody/bodies/rigid/planar_rigid.hpp>
#include <polybody/forces/loads.hpp>
#include <polybody/forces/springs.hpp>
#include <polybody/joints/planar/joints.hpp>
#include <polybody/joints/policies/penalty.hpp>
#include <polybody/joints/policies/policy.hpp>
#include <polybody/run/probe.hpp>

#include <gtest/gtest.h>

#include "support/refusal.hpp"

using namespace polybody;

namespace equilibrium_test {

using planar::Lrvf;
using Clamp = Joint<planar::Weld, Constraint>;
using SoftClamp = Joint<planar::Weld, Penalty>;

/// Function of time that is 1, and NaN from t = 1 on.
struct Breaks {
  Motion operator()(double t) const { return {t < 1.0 ? 1.0 : std::numeric_limits<double>::quiet_NaN()}; }
};

using Structure = Model<Bodies<Lrvf>, Joints<Clamp, SoftClamp>, Forces<PointForce<>, PointForce<Breaks>>>;

Bar bar(double stiffness) {
  return {.length = 1.0,
          .constants = BarConstants{.EA = stiffness, .EI = 1.0, .mass_per_length = 1.0, .GA = stiffness}};
}

/// Body clamped at the origin, with the tip force `force`.
struct Held {
  Structure model;
  BodyHandle<Lrvf> beam;
  ElementHandle<Clamp> clamp;

  Held(Bar const& bar, Index n, Vec3 const& force, LoadAxes axes = LoadAxes::world, Gravity const& gravity = {})
      : model(gravity),
        beam(model.add(Lrvf::from(bar, n), "beam")),
        clamp(model.connect(Clamp{}, model.ground().at({0, 0, 0}), beam.at(0.0), "clamp")) {
    model.apply(PointForce<>{.force = force, .axes = axes}, beam.at(1.0));
  }
};

/// Message of the E that equilibrium throws. The state must be bitwise unchanged.
template <class E>
std::string refused(Structure const& model, State x, EquilibriumOptions const& options = {}) {
  x.v.setConstant(0.25);
  x.a.setConstant(0.5);
  State const before = x;
  std::string const message = message_of<E>([&] { equilibrium(model, x, options); });
  EXPECT_TRUE(x.q == before.q && x.v == before.v && x.a == before.a && x.lambda == before.lambda && x.t == before.t);
  return message;
}

// In a stiff beam the contraction rate of Newton's method alternates (θ = 0.01, 0.8, 1e-4, …). A single good rate as
// a stopping criterion would leave an error of 3e-9.
TEST(Equilibrium, DoesNotDependOnTheLoadSteps) {
  Held const s(bar(1e6), 16, {0, 1, 0});
  State once = s.model.reference_state();
  equilibrium(s.model, once);
  for (int const steps : {2, 3, 10, 20, 40}) {
    State x = s.model.reference_state();
    EXPECT_GE(equilibrium(s.model, x, {.load_steps = steps}).load_steps, steps);
    EXPECT_LT((x.q - once.q).cwiseAbs().maxCoeff(), 1e-11) << steps;
    EXPECT_LT((x.lambda - once.lambda).cwiseAbs().maxCoeff(), 1e-7) << steps;  // round-off: EA · 1e-16 · elements
  }
}

TEST(Equilibrium, BalancesForcesWithTheReactions) {
  Held const s(bar(1e4), 10, {0.3, 2, 0}, LoadAxes::world, Gravity{0, -0.7, 0});
  State x = s.model.reference_state();
  x.v.setConstant(1.0);
  equilibrium(s.model, x);
  Wrench<double> const support = reaction(s.model, x, s.clamp);
  EXPECT_LT((support.f - Vec3(-0.3, 0.7 - 2.0, 0)).norm(), 1e-9);
  EXPECT_TRUE(x.v.isZero(0.0) && x.a.isZero(0.0));
  EXPECT_LT(constraint_violation(s.model, x, s.clamp).norm(), 1e-12);
}

TEST(Equilibrium, OfAStateInEquilibriumIsThatState) {
  Held const s(bar(1e4), 10, {0, 2, 0});
  State x = s.model.reference_state();
  equilibrium(s.model, x, {.load_steps = 3});
  State again = x;
  EXPECT_EQ(equilibrium(s.model, again).iterations, 1);
  EXPECT_LT((again.q - x.q).cwiseAbs().maxCoeff(), 1e-12);
}

// With the complete tangent, including the terms of the follower load and of the reaction, the convergence is
// quadratic. Nine more digits cost two iterations. (A linear rate of 0.1 would cost nine.)
TEST(Equilibrium, ConvergesQuadratically) {
  for (LoadAxes const axes : {LoadAxes::world, LoadAxes::marker}) {
    Held const s(bar(100.0), 8, {0.5, 2, 0}, axes);
    int count[3];
    double const tolerance[3] = {1e-3, 1e-6, 1e-12};
    for (int i = 0; i < 3; ++i) {
      State x = s.model.reference_state();
      count[i] = equilibrium(s.model, x, {.tolerance = tolerance[i]}).iterations;
    }
    EXPECT_LE(count[1] - count[0], 1);
    EXPECT_LE(count[2] - count[0], 2);
    EXPECT_LE(count[2], 9);
  }
}

// The dense solver is used for 4 elements, the sparse one for 40.
TEST(Equilibrium, NamesTheBodyThatNothingHolds) {
  for (Index const n : {4, 40})
    for (double const weight : {0.0, -9.81}) {
      Held s(bar(1e4), n, {0, 1, 0}, LoadAxes::world, Gravity{0, weight, 0});
      Bar loose = bar(1e4);
      loose.placement = Placement::planar(0.3, 0.2, 0.7);
      auto const body = s.model.add(Lrvf::from(loose, n), "loose");
      s.model.apply(PointForce<>{.force = {0, 1, 0}}, body.at(1.0));
      std::string const text = refused<SingularMatrix>(s.model, s.model.reference_state());
      EXPECT_TRUE(has(text, "body \"loose\"")) << n;
      EXPECT_TRUE(has(text, "Fix every body")) << n;
    }
}

// A duplicate clamp: the second one is dropped and named, and the result is unchanged. At another position it is
// refused.
TEST(Equilibrium, DropsTheJointThatIsThereTwice) {
  for (Index const n : {4, 40}) {
    Held once(bar(1e4), n, {0, 1, 0}), twice(bar(1e4), n, {0, 1, 0}), apart(bar(1e4), n, {0, 1, 0});
    auto const again = twice.model.connect(Clamp{}, twice.model.ground().at({0, 0, 0}), twice.beam.at(0.0), "again");
    State x = once.model.reference_state(), y = twice.model.reference_state();
    EXPECT_TRUE(equilibrium(once.model, x).redundant.empty());
    EquilibriumReport const report = equilibrium(twice.model, y);
    EXPECT_EQ(report.redundant, std::vector<std::string>{"joint \"again\""});
    EXPECT_TRUE(report.free_motions.empty());
    EXPECT_LT((x.q - y.q).cwiseAbs().maxCoeff(), 1e-10) << n;
    EXPECT_LT((reaction(once.model, x, once.clamp).m - reaction(twice.model, y, twice.clamp).m).norm(), 1e-8) << n;
    EXPECT_EQ(reaction(twice.model, y, again).f, Vec3(0, 0, 0)) << n;

    apart.model.connect(Clamp{}, apart.model.ground().at({0, 0.01, 0}), apart.beam.at(0.0), "elsewhere");
    EXPECT_TRUE(has(refused<InconsistentInitialConditions>(apart.model, apart.model.reference_state()), "joint \""))
        << n;
  }
}

TEST(Equilibrium, SaysThatNewtonStalled) {
  Held const s(bar(1e6), 8, {0, 50, 0});
  std::string const text = refused<NewtonConvergenceFailure>(s.model, s.model.reference_state(), {.max_iterations = 1});
  EXPECT_TRUE(has(text, "load steps"));
}

TEST(Equilibrium, HalvesAPartThatFailsAndGetsThere) {
  Held const s(bar(1e6), 16, {0, 50, 0});
  State x = s.model.reference_state(), small = x;
  EXPECT_GT(equilibrium(s.model, x).load_steps, 1);
  equilibrium(s.model, small, {.load_steps = 40});
  EXPECT_LT((x.q - small.q).cwiseAbs().maxCoeff(), 1e-10);
}

// Stiffness and force are multiplied by 2ᵏ. The coordinates and the multipliers divided by 2ᵏ are bitwise identical.
// The constraint equations are not scaled. They must not be lost compared with pivots of 1e24 N/m, nor dominate those
// of 1e-12.
TEST(Equilibrium, DoesNotDependOnTheUnitOfForce) {
  for (Index const n : {4, 40}) {
    State reference;
    for (int const k : {0, -60, 40, 60}) {
      Bar const b{
          .length = 1.0,
          .constants = BarConstants{
              .EA = std::ldexp(1e6, k), .EI = std::ldexp(1.0, k), .mass_per_length = 1.0, .GA = std::ldexp(1e6, k)}};
      Held const s(b, n, {0, std::ldexp(5.0, k), 0});
      State x = s.model.reference_state();
      equilibrium(s.model, x);
      if (k == 0) reference = x;
      EXPECT_TRUE(x.q == reference.q) << n << ' ' << k;
      EXPECT_TRUE(x.lambda == std::ldexp(1.0, k) * reference.lambda) << n << ' ' << k;
    }
  }
}

// The full load requires several substeps. From the equilibrium under half of it one or two are sufficient.
TEST(Equilibrium, GoesOnFromWhereItIs) {
  Held const half(bar(1e6), 16, {0, 25, 0}), full(bar(1e6), 16, {0, 50, 0});
  State x = full.model.reference_state(), y = x;
  EXPECT_GT(equilibrium(full.model, x).load_steps, 2);
  equilibrium(half.model, y);
  EXPECT_LE(equilibrium(full.model, y).load_steps, 2);
  EXPECT_LT((x.q - y.q).cwiseAbs().maxCoeff(), 1e-10);
}

TEST(Equilibrium, SaysThatAForceIsNotFinite) {
  Held s(bar(1e4), 4, {0, 1, 0});
  s.model.apply(PointForce<Breaks>{.force = {0, 1, 0}}, s.beam.at(0.5));
  State x = s.model.reference_state();
  x.t = 1.0;
  refused<NonFiniteValue>(s.model, x);
  x.t = 0.5;
  EXPECT_NO_THROW(equilibrium(s.model, x));
  EXPECT_EQ(x.t, 0.5);
}

// A clamped column buckles at (2i − 1)² π² EI/4L². The number of negative pivots of its straight state is the number
// of such loads below the actual one.
TEST(Equilibrium, CountsTheNegativePivotsOfAStraightColumn) {
  double const first = 0.25 * std::numbers::pi * std::numbers::pi;
  for (Index const n : {12, 40})
    for (auto const& [factor, negative] : {std::pair{0.98, 0}, {1.05, 1}, {3.0, 1}, {8.5, 1}, {9.6, 2}, {30.0, 3}}) {
      Held const s(bar(1e8), n, {-factor * first, 0, 0});
      State x = s.model.reference_state();
      EquilibriumReport const report = equilibrium(s.model, x);
      EXPECT_EQ(report.negative_pivots, negative) << n << ' ' << factor;
      ASSERT_EQ(report.warnings.size(), negative > 0 ? 1u : 0u);
      if (negative == 0) continue;
      EXPECT_TRUE(
          has(report.warnings[0], "The equilibrium is unstable: the stiffness has " + std::to_string(negative)));
      EXPECT_TRUE(has(report.warnings[0], "body \"beam\" changes its shape"));
    }
}

/// Chain of rods on pins, hanging or inverted.
struct Rods {
  using Pin = Joint<planar::Revolute, Constraint>;
  Model<Bodies<planar::Rigid>, Joints<Pin>> model;
  Rods(int rods, double gravity, bool twice) : model{Gravity{0, -gravity, 0}} {
    std::vector<BodyHandle<planar::Rigid>> chain;
    for (int i = 0; i < rods; ++i) {
      chain.push_back(model.add(planar::Rigid(1.0, 0.1, Placement::planar(0.0, -0.5 - i, -0.5 * std::numbers::pi))));
      for (int k = 0; k < (twice ? 2 : 1); ++k)
        if (i == 0)
          model.connect(Pin{}, model.ground().at({0, 0, 0}), chain[0].at(Vec2(-0.5, 0)));
        else
          model.connect(Pin{}, chain[std::size_t(i) - 1].at(Vec2(0.5, 0)), chain[std::size_t(i)].at(Vec2(-0.5, 0)));
    }
  }
};

// The complete stiffness is due to the multipliers. In the inverted position each rod is unstable. Doubled pins have
// no influence.
TEST(Equilibrium, CountsTheNegativePivotsOfRodsThatHangAndStand) {
  for (int const rods : {1, 2, 7})
    for (bool const twice : {false, true})
      for (double const gravity : {9.81, -9.81}) {
        Rods const chain(rods, gravity, twice);
        State x = chain.model.reference_state();
        EXPECT_EQ(equilibrium(chain.model, x).negative_pivots, gravity > 0.0 ? 0 : rods) << rods << ' ' << twice;
      }
}

/// Truss of two springs of 2400 N/m from (±1, 0) m to a load F downwards at (0, 0.2) m. In equilibrium F = 2 k (L₀ −
/// L) y/L, L² = 1 + y². The limit load is 7.0735 N at y = 0.1158 m.
struct Truss {
  Model<Bodies<planar::Rigid>, Joints<Joint<planar::Prismatic, Constraint>>, Forces<SpringDamper, PointForce<>>> model;
  State x;
  explicit Truss(double F) {
    auto const tip = model.add(planar::Rigid(1.0, 1.0, Placement::planar(0.0, 0.2)), "tip");
    model.connect(Joint<planar::Prismatic, Constraint>{{.axis = Vec3::UnitY()}, {}}, model.ground().at({0, 0, 0}),
                  tip.at(Vec2(0, 0)), "rail");
    for (double const side : {-1.0, 1.0})
      model.apply(SpringDamper{.stiffness = 2400.0, .free_length = std::hypot(1.0, 0.2)},
                  model.ground().at({side, 0, 0}), tip.at(Vec2(0, 0)));
    model.apply(PointForce<>{.force = {0, -F, 0}}, tip.at(Vec2(0, 0)));
    x = model.reference_state();
  }
  static double force(double y) { return 4800.0 * (std::hypot(1.0, 0.2) / std::hypot(1.0, y) - 1.0) * y; }
};

// Beyond the limit load the truss snaps through. For all load steps, this is either refused or reported with a
// warning that gives the load factor. Below the limit load the state is on the path from the start.
TEST(Equilibrium, WarnsOfALimitPoint) {
  double limit = 0.0;
  for (double y = 0.0; y < 0.2; y += 1e-5) limit = std::max(limit, Truss::force(y));
  for (int const steps : {1, 3, 10})
    for (double const part : {0.3, 0.9, 0.99, 1.02, 1.1, 1.3, 2.0, 3.0, 10.0}) {
      Truss truss(part * limit);
      EquilibriumReport report;
      try {
        report = equilibrium<AutoLu>(truss.model, truss.x, {.load_steps = steps});
      } catch (Error const&) {
        EXPECT_GT(part, 1.0);
        continue;
      }
      EXPECT_NEAR(Truss::force(truss.x.q[1]), part * limit, 1e-6 * limit);
      EXPECT_EQ(report.negative_pivots, 0);
      if (part < 1.0) {
        EXPECT_GT(truss.x.q[1], 0.115) << part;
        EXPECT_TRUE(report.warnings.empty()) << part;
      } else {
        EXPECT_LT(truss.x.q[1], -0.2);
        ASSERT_EQ(report.warnings.size(), 1u) << steps << ' ' << part;
        EXPECT_TRUE(has(report.warnings[0], "has a limit point near load factor"));
        EXPECT_NEAR(report.limit_point * part, 1.0, 2e-3);
      }
    }
}

// The deflection of a penalty clamp follows from its load, g = F/k and k g = M. A stiffer clamp approaches the
// constraint.
TEST(Equilibrium, PenaltySupportsYieldByForceOverStiffness) {
  Vec3 const force(0.4, 2, 0);
  Held const ideal(bar(1e4), 8, force);
  State exact = ideal.model.reference_state();
  equilibrium(ideal.model, exact);
  Vec3 const moment = reaction(ideal.model, exact, ideal.clamp).m;
  double error[3];
  for (int i = 0; i < 3; ++i) {
    double const k = std::pow(10.0, 5 + 2 * i);
    Structure model;
    auto const beam = model.add(Lrvf::from(bar(1e4), 8), "beam");
    auto const clamp = model.connect(SoftClamp{{}, Penalty{.stiffness = k, .damping = 0.0}},
                                     model.ground().at({0, 0, 0}), beam.at(0.0), "soft clamp");
    model.apply(PointForce<>{.force = force}, beam.at(1.0));
    State x = model.reference_state();
    equilibrium(model, x);
    Vec3 const g = constraint_violation(model, x, clamp);
    EXPECT_NEAR(g[0], force[0] / k, 1e-9 * force[0] / k + 1e-15);
    EXPECT_NEAR(g[1], force[1] / k, 1e-9 * force[1] / k + 1e-15);
    Wrench<double> const r = reaction(model, x, clamp);
    EXPECT_LT((r.f + force).norm(), 1e-6);
    EXPECT_NEAR(r.m[2], moment[2], 20.0 * std::abs(moment[2]) / k);
    error[i] = (x.q - exact.q).cwiseAbs().maxCoeff();
  }
  EXPECT_NEAR(error[0] / error[1], 100.0, 1.0);
  EXPECT_NEAR(error[1] / error[2], 100.0, 1.0);
}

}  // namespace equilibrium_test
