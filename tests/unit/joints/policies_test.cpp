#include <polybody/joints/policies/penalty.hpp>
#include <polybody/joints/policies/policy.hpp>
#include <polybody/joints/standard_joints.hpp>

#include <gtest/gtest.h>

#include <polybody/testing/differences.hpp>

#include "support/refusal.hpp"

using namespace polybody;
using namespace polybody::laws;

namespace policies_test {

double const nan_ = std::numeric_limits<double>::quiet_NaN();
double const infinite = std::numeric_limits<double>::infinity();

Penalty const penalty{.stiffness = 2000.0, .damping = 30.0};

TEST(Penalty, MultiplierIsSpringPlusDamper) {
  Vec3 const g(1e-3, -2e-3, 0), rate(0.1, 0, -0.2);
  EXPECT_LT((penalty.multiplier<3, double>(g, rate) - Vec3(2 + 3, -4, -6)).norm(), 1e-13);
}

// slope(ck, cd) = ck ∂λ/∂g + cd ∂λ/∂ġ: g is seeded with ck, ġ with cd.
TEST(Penalty, SlopeIsTheDerivativeOfTheMultiplier) {
  using D = Dual<1>;
  for (auto const& [ck, cd] : {std::pair{1.0, 0.0}, {0.0, 1.0}, {0.7, 31.0}}) {
    D const g(1e-3, D::Partials(ck)), rate(-0.2, D::Partials(cd));
    auto const lambda = penalty.multiplier<3, D>(Vec<D, 3>::Constant(g), Vec<D, 3>::Constant(rate));
    auto const slope = penalty.slope<3>(ck, cd, Vec3::Constant(g.v), Vec3::Constant(rate.v));
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(lambda[i].d[0], slope.diagonal()[i], 1e-12);
  }
}

TEST(Penalty, ElasticMultiplierIsTheGradientOfThePotential) {
  Vec3 const g(0.3, -0.2, 0.9);
  for (int i = 0; i < 3; ++i) {
    double const slope = slope_at_zero([&](double h) { return penalty.potential<3>(g + Vec3::Unit(i) * h); });
    EXPECT_NEAR((penalty.multiplier<3, double>(g, Vec3::Zero())[i]), slope, 1e-9);
  }
  EXPECT_EQ(penalty.potential<3>(Vec3::Zero()), 0.0);
}

TEST(Penalty, DamperTakesPowerOut) {
  Numbers number;
  for (int k = 0; k < 5; ++k) {
    Vec3 const rate = number.vec<3>();
    EXPECT_GT((penalty.multiplier<3, double>(Vec3::Zero(), rate).dot(rate)), 0.0);
  }
}

// The constraint equations of coincident points are in world axes. A spring along d nevertheless has no moment: d × k
// d = 0.
TEST(Penalty, ElasticForcesOfAnOpenPinBalanceInMoment) {
  Numbers number;
  for (int k = 0; k < 3; ++k) {
    Frame<double> const a = number.frame(), b = number.frame();
    ConstraintTerms<5> const gap = constraint_function<double>(Revolute{}, a, b, 0.0);
    auto const lambda = penalty.multiplier<5, double>(gap.g, Vec<double, 5>::Zero());
    Vec6 const wa = gap.Ga.transpose() * lambda, wb = gap.Gb.transpose() * lambda;
    Vec3 const moment = wa.tail<3>() + a.r.cross(wa.head<3>()) + wb.tail<3>() + b.r.cross(wb.head<3>());
    EXPECT_GT(wa.norm(), 100.0);
    EXPECT_LT(moment.norm(), 1e-14 * wa.norm() * 10);
  }
}

TEST(Penalty, RefusesNumbersThatCannotBeMeantByName) {
  for (double const k : {0.0, -1.0, nan_, infinite}) {
    std::string const said = refusal([&] { Penalty{.stiffness = k, .damping = 0.0}.check("\"hinge\""); });
    EXPECT_TRUE(has(said, "\"hinge\": the penalty stiffness must be positive")) << k;
  }
  for (double const c : {-1.0, nan_, infinite}) {
    std::string const said = refusal([&] { Penalty{.stiffness = 1.0, .damping = c}.check("\"hinge\""); });
    EXPECT_TRUE(has(said, "\"hinge\": the penalty damping must be zero or positive")) << c;
  }
  EXPECT_NO_THROW((Penalty{.stiffness = 1.0, .damping = 0.0}.check("hinge")));
}

TEST(PenaltyPerEquation, OfEqualNumbersIsThePenalty) {
  PenaltyPerEquation<3> const rows{.stiffness = Vec3(2000, 2000, 2000), .damping = Vec3(30, 30, 30)};
  Vec3 const g(1e-3, -2e-3, 4e-3), rate(0.1, 0.3, -0.2);
  EXPECT_LT((rows.multiplier<3, double>(g, rate) - penalty.multiplier<3, double>(g, rate)).norm(), 1e-14);
  Mat3 const slope = rows.slope<3>(0.7, 31.0, g, rate), same = penalty.slope<3>(0.7, 31.0, g, rate);
  EXPECT_LT((slope - same).norm(), 1e-12);
  EXPECT_NEAR(rows.potential<3>(g), penalty.potential<3>(g), 1e-16);
}

TEST(PenaltyPerEquation, EachRowHasItsNumbers) {
  PenaltyPerEquation<3> const rows{.stiffness = Vec3(1, 10, 100), .damping = Vec3(0, 2, 4)};
  Vec3 const g(1, 2, -3), rate(5, 7, 9);
  EXPECT_LT((rows.multiplier<3, double>(g, rate) - Vec3(1, 20 + 14, -300 + 36)).norm(), 1e-12);
  EXPECT_LT((rows.slope<3>(2.0, 3.0, g, rate).diagonal() - Vec3(2, 20 + 6, 200 + 12)).norm(), 1e-12);
  EXPECT_NEAR(rows.potential<3>(g), 0.5 * (1 + 40 + 900), 1e-12);
}

TEST(PenaltyPerEquation, RefusesNumbersThatCannotBeMeantByNameAndRow) {
  EXPECT_TRUE(
      has(refusal([] { PenaltyPerEquation<2>{.stiffness = Vec2(1, 0), .damping = Vec2(0, 0)}.check("\"hinge\""); }),
          "\"hinge\": the penalty stiffness of constraint equation 2 must be positive"));
  EXPECT_TRUE(
      has(refusal([] { PenaltyPerEquation<2>{.stiffness = Vec2(1, 1), .damping = Vec2(-1, 0)}.check("\"hinge\""); }),
          "\"hinge\": the penalty damping of constraint equation 1 must be zero or positive"));
}

// --- concepts: a policy is of exactly one kind ----------------------------------------------------------------

struct Neither {};
struct Both : Penalty {
  static constexpr bool adds_constraints = true;
};
struct RowsDenied {
  static constexpr bool adds_constraints = false;
};
struct NoPotential {
  void check(std::string const&) const {}
  template <int m, StateScalar T>
  Vec<T, m> multiplier(Vec<T, m> const& g, Vec<T, m> const&) const {
    return g;
  }
  template <int m>
  Mat<double, m, m> slope(double, double, Vec<double, m> const&, Vec<double, m> const&) const {
    return {};
  }
};
static_assert(Policy<Constraint> && ConstrainingPolicy<Constraint> && !CompliantPolicy<Constraint>);
static_assert(Policy<Penalty> && CompliantPolicy<Penalty> && !ConstrainingPolicy<Penalty>);
static_assert(!Policy<Neither> && !Policy<Both> && !Policy<RowsDenied> && !Policy<NoPotential> && !Policy<int>);
static_assert(ConstrainingPolicy<Both> && CompliantPolicy<Both>);
static_assert(Policy<PenaltyPerEquation<2>> && CompliantLaw<PenaltyPerEquation<2>, 2> &&
              !CompliantLaw<PenaltyPerEquation<2>, 3>);
// their parameters have no default
static_assert(!std::is_default_constructible_v<Penalty> && !std::is_default_constructible_v<PenaltyPerEquation<2>>);

}  // namespace policies_test
