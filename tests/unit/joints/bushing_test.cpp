#include <polybody/joints/joint.hpp>
#include <polybody/joints/policies/bushing.hpp>
#include <polybody/joints/standard_joints.hpp>

#include <gtest/gtest.h>

#include <polybody/testing/differences.hpp>

#include <Eigen/LU>

#include "support/refusal.hpp"

using namespace polybody;
using namespace polybody::laws;

namespace bushing_test {

using Matrix = Bushing::Matrix;

/// Symmetric and positive definite: BᵀB of a random B, with an addition on the diagonal.
Matrix coupled(unsigned seed, double size) {
  Numbers number(seed);
  Mat<double, 6, 6> b;
  for (int j = 0; j < 6; ++j) b.col(j) = number.vec<6>();
  return size * (b.transpose() * b + 0.5 * Matrix::Identity());
}

Bushing const bushing{.stiffness = coupled(1, 100.0), .damping = coupled(2, 3.0)};
NonlinearBushing const rubber{TabulatedLaw{MonotoneTable{{{-1.0, -9.0}, {-0.2, -1.0}, {0.3, 2.0}, {1.0, 20.0}}}, 0.5},
                              LinearLaw{.stiffness = 40.0, .damping = 2.0},
                              [](auto const& x, auto const& rate) { return x * x * x * 7.0 + x * 3.0 + x * x * rate; },
                              LinearLaw{.stiffness = 5.0, .damping = 0.0},
                              [](auto const& x, auto const&) {
                                using std::sin;
                                return 6.0 * sin(x) + 1.0;
                              },
                              TabulatedLaw{MonotoneTable{{{-1.0, -3.0}, {1.0, 4.0}}}, 0.1}};

Vec6 const x = Numbers(3).vec<6>(0.8), rate = Numbers(4).vec<6>(2.0);

// Multiplier of the linear bushing [Wallin 2016, Eq. 3.15].
TEST(Bushing, MultiplierIsStiffnessTimesPlacePlusDampingTimesRate) {
  Vec6 const expected = bushing.stiffness.value * x + bushing.damping.value * rate;
  EXPECT_LT((bushing.multiplier<6, double>(x, rate) - expected).norm(), 1e-12);
}

// slope(ck, cd) = ck ∂λ/∂x + cd ∂λ/∂ẋ: x is seeded with ck, ẋ with cd.
template <class P>
void expect_slope(P const& policy) {
  for (auto const& [ck, cd] : {std::pair{1.0, 0.0}, {0.0, 1.0}, {0.7, 31.0}})
    for (int j = 0; j < 6; ++j) {
      Vec6 const by_differences = slope_at_zero(
          [&, ck = ck, cd = cd](double h) {
            return Vec6(
                policy.template multiplier<6, double>(x + Vec6::Unit(j) * ck * h, rate + Vec6::Unit(j) * cd * h));
          },
          1e-4);
      Matrix const slope = policy.template slope<6>(ck, cd, x, rate);
      EXPECT_LT((slope.col(j) - by_differences).norm(), 1e-8 * (1.0 + slope.norm()));
    }
}

TEST(Bushing, SlopeIsTheDerivativeOfTheMultiplier) { expect_slope(bushing); }
TEST(NonlinearBushing, SlopeIsTheDerivativeOfTheMultiplier) { expect_slope(rubber); }

template <class P>
void expect_gradient_of_potential(P const& policy, std::initializer_list<int> components) {
  for (int const i : components) {
    double const slope = slope_at_zero([&](double h) { return policy.template potential<6>(x + Vec6::Unit(i) * h); });
    EXPECT_NEAR((policy.template multiplier<6, double>(x, Vec6::Zero())[i]), slope, 1e-9) << i;
  }
  EXPECT_NEAR(policy.template potential<6>(Vec6::Zero()), 0.0, 1e-15);
}

TEST(Bushing, ElasticMultiplierIsTheGradientOfThePotential) {
  expect_gradient_of_potential(bushing, {0, 1, 2, 3, 4, 5});
}
TEST(NonlinearBushing, ElasticMultiplierIsTheGradientOfThePotentialOfLawsThatHaveOne) {
  expect_gradient_of_potential(rubber, {0, 1, 3, 5});
}

TEST(NonlinearBushing, EachComponentHasItsLaw) {
  Vec6 const lambda = rubber.multiplier<6, double>(x, rate);
  EXPECT_DOUBLE_EQ(lambda[1], 40.0 * x[1] + 2.0 * rate[1]);
  EXPECT_DOUBLE_EQ(lambda[2], 7.0 * std::pow(x[2], 3) + 3.0 * x[2] + x[2] * x[2] * rate[2]);
  EXPECT_DOUBLE_EQ(lambda[4], 6.0 * std::sin(x[4]) + 1.0);
  EXPECT_NEAR(lambda[5], 3.5 * x[5] + 0.5 + 0.1 * rate[5], 1e-14);  // a table of two points is a line
}

TEST(NonlinearBushing, OfLinearLawsIsADiagonalBushing) {
  LinearLaw const push{.stiffness = 7.0, .damping = 0.3}, turn{.stiffness = 2.0, .damping = 0.1};
  NonlinearBushing const laws{push, push, push, turn, turn, turn};
  Bushing const same{.stiffness = Bushing::diagonal({7, 7, 7}, {2, 2, 2}),
                     .damping = Bushing::diagonal({0.3, 0.3, 0.3}, {0.1, 0.1, 0.1})};
  EXPECT_LT((laws.multiplier<6, double>(x, rate) - same.multiplier<6, double>(x, rate)).norm(), 1e-14);
  EXPECT_NEAR(laws.potential<6>(x), same.potential<6>(x), 1e-14);
}

// --- invalid parameters ---------------------------------------------------------------------------------------------

std::string said(Matrix const& k, Matrix const& c = Matrix::Zero()) {
  return refusal([&] { Bushing{.stiffness = k, .damping = c}.check("\"mount\""); });
}

TEST(Bushing, RefusesNegativeStiffnessAndDamping) {
  Matrix k = Matrix::Identity();
  k(2, 2) = -1.0;
  EXPECT_TRUE(has(said(k),
                  "\"mount\": the bushing's stiffness must be finite, symmetric and positive semidefinite (6×6), "
                  "but its entry (3, 3) is -1"));
  EXPECT_TRUE(has(said(Matrix::Identity(), k), "\"mount\": the bushing's damping must be"));
  k(2, 2) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(has(said(k), "its entry (3, 3) is"));
  k(2, 2) = std::numeric_limits<double>::infinity();
  EXPECT_TRUE(has(said(k), "its entry (3, 3) is inf"));
}

TEST(Bushing, RefusesAMatrixThatIsNotSymmetric) {
  Matrix k = Matrix::Identity();
  k(1, 4) = 0.5;
  EXPECT_TRUE(has(said(k), "its entry (2, 5) is 0.5 and its transposed entry is 0"));
}

// [1, c; c, 1] has the eigenvalues 1 ± c, for any units of the two entries. A zero on the diagonal permits no
// coupling.
TEST(Bushing, RefusesCouplingThatMakesTheStiffnessNegative) {
  for (double const unit : {1.0, 1e-4, 1e4}) {
    Matrix k = Matrix::Identity();
    k(4, 4) = unit * unit;
    k(0, 4) = k(4, 0) = 1.01 * unit;
    EXPECT_TRUE(has(said(k), "the coupling of its row 5 with other rows is too strong"));
    k(0, 4) = k(4, 0) = -0.99 * unit;
    EXPECT_NO_THROW((Bushing{.stiffness = k, .damping = k}.check("mount")));
    k(0, 4) = k(4, 0) = unit;  // semidefinite: it leaves one direction free
    EXPECT_NO_THROW((Bushing{.stiffness = k, .damping = k}.check("mount")));
    k(4, 5) = k(5, 4) = 0.1 * unit;  // a free direction permits no coupling
    EXPECT_TRUE(has(said(k), "the coupling of its row 5 with other rows is too strong"));
  }
  Matrix k = Bushing::diagonal({1, 1, 1}, {0, 0, 0});
  EXPECT_NO_THROW((Bushing{.stiffness = k, .damping = k}.check("mount")));
  k(0, 5) = k(5, 0) = 1e-3;
  EXPECT_TRUE(has(said(k), "its entry (1, 6) is 0.001 although a diagonal entry of its row or column is zero"));
}

// K − s v vᵀ is definite if s vᵀK⁻¹v < 1: its determinant is that of K times 1 − s vᵀK⁻¹v.
TEST(Bushing, TellsDefiniteMatricesFromOthers) {
  for (unsigned seed = 1; seed < 40; ++seed) {
    Matrix const k = coupled(seed, 1e5);
    EXPECT_NO_THROW((Bushing{.stiffness = k, .damping = k}.check("mount"))) << seed;
    Vec6 const v = Numbers(seed).vec<6>().normalized();
    double const limit = 1.0 / v.dot(k.inverse() * v);
    Matrix const below = k - 0.999 * limit * v * v.transpose(), beyond = k - 1.001 * limit * v * v.transpose();
    EXPECT_NO_THROW((Bushing{.stiffness = below, .damping = k}.check("mount"))) << seed;
    EXPECT_THROW((Bushing{.stiffness = beyond, .damping = k}.check("mount")), InvalidInput) << seed;
  }
}

TEST(NonlinearBushing, RefusesNumbersOfItsLawsByNameAndComponent) {
  LinearLaw const good{.stiffness = 1.0, .damping = 0.0}, bad{.stiffness = -1.0, .damping = 0.0};
  TabulatedLaw const tabled{MonotoneTable{{{0.0, 0.0}, {1.0, 1.0}}}, -2.0};
  EXPECT_TRUE(has(refusal([&] { NonlinearBushing(good, bad, good, good, good, good).check("\"mount\""); }),
                  "\"mount\": component 2 of the bushing: the stiffness must be zero or positive"));
  EXPECT_TRUE(has(refusal([&] { NonlinearBushing(good, good, good, good, good, tabled).check("\"mount\""); }),
                  "component 6 of the bushing: the damping"));
  EXPECT_NO_THROW(rubber.check("mount"));
}

// --- concepts -------------------------------------------------------------------------------------------------------

static_assert(Policy<Bushing> && CompliantPolicy<Bushing> && !ConstrainingPolicy<Bushing>);
static_assert(Policy<decltype(rubber)> && CompliantLaw<decltype(rubber), 6> && !CompliantLaw<decltype(rubber), 5>);
static_assert(Joint<Revolute, Bushing>::rows == 6 && Joint<Weld, Bushing>::rows == 6);
static_assert(std::is_same_v<Joint<Revolute, Bushing>::Measured, ConstrainedCoordinates<Revolute>>);
static_assert(std::is_same_v<Joint<Revolute, Penalty>::Measured, Revolute>);
static_assert(!std::is_default_constructible_v<Bushing>);  // its stiffness and damping have no default
static_assert(ForceLaw<LinearLaw> && ForceLaw<TabulatedLaw> && !ForceLaw<double>);

}  // namespace bushing_test
