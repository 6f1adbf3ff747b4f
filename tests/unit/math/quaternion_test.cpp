#include <polybody/math/quaternion.hpp>

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <numbers>
#include <vector>

using namespace polybody;

namespace quaternion_test {

using Q = Quaternion<double>;
double const pi = std::numbers::pi;

std::vector<Vec3> const directions = {Vec3(0.6, -0.3, 0.5).normalized(), Vec3(-0.1, 0.9, 0.2).normalized(),
                                      Vec3(1, 0, 0), Vec3(0, 0, -1)};
std::vector<double> const angles = {0.0, 1e-12, 1e-8, 1e-4, 1e-3, 1e-2, 0.49, 0.51, 1.0, 3.0, pi - 1e-6, pi - 1e-12};

Q const p = quaternion_exp<double>(Vec3(0.3, -1.4, 0.8));
Q const q = quaternion_exp<double>(Vec3(-2.1, 0.6, 0.5));

Mat3 matrix(Q const& a) { return rotation_matrix<double>(a); }

TEST(Quaternion, ExpIsTheHalfAngleForm) {
  for (Vec3 const& n : directions)
    for (double const angle : {0.0, 1e-12, 1e-8, 1e-4, 1e-2, 0.99, 1.01, 3.0, 5.0, 7.0}) {
      Q expected;
      expected << std::cos(angle / 2), std::sin(angle / 2) * n;
      EXPECT_LT((quaternion_exp<double>(angle * n) - expected).norm(), 1e-15) << angle;
    }
}

TEST(Quaternion, ExpHasNormOne) {
  for (Vec3 const& n : directions)
    for (double const angle : angles) EXPECT_NEAR(quaternion_exp<double>(angle * n).norm(), 1.0, 1e-15) << angle;
}

TEST(Quaternion, MatrixIsThatOfTheRotationVector) {
  for (Vec3 const& n : directions)
    for (double const angle : angles)
      EXPECT_LT((matrix(quaternion_exp<double>(angle * n)) - exp_so3<double>(angle * n)).norm(), 3e-15) << angle;
}

TEST(Quaternion, ProductIsTheProductOfMatrices) {
  EXPECT_LT((matrix(quaternion_product<double>(p, q)) - matrix(p) * matrix(q)).norm(), 2e-15);
  // Hamilton's rule i j = k fixes the convention.
  EXPECT_EQ(quaternion_product<double>(Q(0, 1, 0, 0), Q(0, 0, 1, 0)), Q(0, 0, 0, 1));
}

TEST(Quaternion, ProductIsAssociativeAndKeepsTheNorm) {
  Q const r(0.1, 2.0, -0.3, 0.7);
  EXPECT_LT((quaternion_product<double>(quaternion_product<double>(p, q), r) -
             quaternion_product<double>(p, quaternion_product<double>(q, r)))
                .norm(),
            2e-15);
  EXPECT_NEAR(quaternion_product<double>(p, r).norm(), r.norm(), 1e-15);
}

TEST(Quaternion, ConjugateIsTheInverseRotation) {
  EXPECT_LT((quaternion_product<double>(p, conjugate<double>(p)) - Q(1, 0, 0, 0)).norm(), 1e-15);
  EXPECT_LT((matrix(conjugate<double>(p)) - matrix(p).transpose()).norm(), 1e-15);
}

TEST(Quaternion, LogOfExpIsIdentityThroughZeroAndToPi) {
  for (Vec3 const& n : directions)
    for (double const angle : angles) {
      Vec3 const phi = angle * n;
      EXPECT_LT((quaternion_log<double>(quaternion_exp<double>(phi)) - phi).norm(), 2e-15 * angle + 1e-300) << angle;
    }
}

TEST(Quaternion, LogHasNoStepWhereItsSeriesEnds) {
  // |v| = 1e-4: the angle is 2 asin(1e-4); tests on both sides of it and slightly apart
  double const edge = 2.0 * std::asin(1e-4);
  for (double const angle : {edge * (1 - 1e-9), edge * (1 + 1e-9)})
    EXPECT_NEAR(quaternion_log<double>(quaternion_exp<double>(Vec3(0, angle, 0)))[1] / angle, 1.0, 4e-16);
}

TEST(Quaternion, LogOfTheOppositeIsTheSame) {
  EXPECT_LT((quaternion_log<double>(p) - quaternion_log<double>(-p)).norm(), 1e-15);
  EXPECT_EQ(quaternion_log<double>(Q(1, 0, 0, 0)), Vec3::Zero());
  EXPECT_EQ(quaternion_log<double>(Q(-1, 0, 0, 0)).norm(), 0.0);
}

TEST(Quaternion, LogOfAHalfTurnHasLengthPi) {
  for (Vec3 const& n : directions) {
    Q half;
    half << 0.0, n;
    EXPECT_NEAR(std::abs(quaternion_log<double>(half).dot(n)), pi, 1e-15);
  }
}

TEST(Quaternion, MinusUndoesPlus) {
  for (Vec3 const& n : directions)
    for (double const angle : angles) {
      Vec3 const delta = angle * n;
      Q const moved = quaternion_plus<double>(p, delta);
      EXPECT_LT((quaternion_minus<double>(moved, p) - delta).norm(), 1e-15) << angle;
    }
}

TEST(Quaternion, PlusUndoesMinus) {
  Q const back = quaternion_plus<double>(p, quaternion_minus<double>(q, p));
  EXPECT_LT((matrix(back) - matrix(q)).norm(), 2e-15);
}

TEST(Quaternion, PlusActsInBodyAxes) {
  Vec3 const delta(0.2, -0.7, 0.4);
  EXPECT_LT((matrix(quaternion_plus<double>(p, delta)) - matrix(p) * exp_so3<double>(delta)).norm(), 2e-15);
}

// The result has unit norm for any norm of the argument.
TEST(Quaternion, PlusNormalises) {
  Q moved = p * (1.0 + 1e-6);
  moved = quaternion_plus<double>(moved, Vec3(1e-3, 0, 0));
  EXPECT_NEAR(moved.norm(), 1.0, 1e-15);
  for (int i = 0; i < 1000; ++i) moved = quaternion_plus<double>(moved, Vec3(0.3, -0.1, 0.2));
  EXPECT_NEAR(moved.norm(), 1.0, 1e-15);
}

/// The derivative of `f`, a matrix of duals, at δ = 0 along the unit vector i.
template <class F>
auto derivative_at_zero(F&& f, int i) {
  Vec<Dual<1>, 3> delta = Vec<Dual<1>, 3>::Zero();
  delta[i].d[0] = 1.0;
  return f(delta).unaryExpr([](Dual<1> const& x) { return x.d[0]; }).eval();
}

// To first order q ⊞ δ = q + ½ q (0, δ): the kinematic equation q˙ = ½ q ∘ (0, Ω).
TEST(Quaternion, DerivativeOfPlusAtZeroIsHalfTheProduct) {
  Q const i_axes[] = {Q(0, 1, 0, 0), Q(0, 0, 1, 0), Q(0, 0, 0, 1)};
  for (int i = 0; i < 3; ++i) {
    Q const slope = derivative_at_zero([](auto const& d) { return quaternion_plus<Dual<1>>(q.cast<Dual<1>>(), d); }, i);
    EXPECT_LT((slope - 0.5 * quaternion_product<double>(q, i_axes[i])).norm(), 1e-15);
  }
}

TEST(Quaternion, MatrixTurnsWithBodyAngularVelocity) {
  for (int i = 0; i < 3; ++i) {
    Mat3 const slope = derivative_at_zero(
        [](auto const& d) { return rotation_matrix<Dual<1>>(quaternion_plus<Dual<1>>(q.cast<Dual<1>>(), d)); }, i);
    EXPECT_LT((slope - matrix(q) * skew<double>(Vec3::Unit(i))).norm(), 2e-15);
  }
}

// log is the inverse of exp to first order as well, at zero and away from it: d(q ⊟ q) = δ.
TEST(Quaternion, DerivativeOfMinusAtZeroIsTheIdentity) {
  for (int i = 0; i < 3; ++i) {
    Vec3 const slope = derivative_at_zero(
        [](auto const& d) {
          Quaternion<Dual<1>> const base = q.cast<Dual<1>>();
          return quaternion_minus<Dual<1>>(quaternion_plus<Dual<1>>(base, d), base);
        },
        i);
    EXPECT_LT((slope - Vec3::Unit(i)).norm(), 1e-15);
  }
}

// log(exp(φ) exp(δ)) = φ + Jr⁻¹(φ) δ to first order.
TEST(Quaternion, DerivativeOfLogIsTheInverseJacobian) {
  for (double const angle : {1e-8, 1e-5, 1e-3, 0.3, 2.0, 3.1})
    for (int i = 0; i < 3; ++i) {
      Vec3 const phi = angle * directions[0];
      Vec3 const slope = derivative_at_zero(
          [&](auto const& d) {
            Quaternion<Dual<1>> const base = quaternion_exp<double>(phi).template cast<Dual<1>>();
            return quaternion_log<Dual<1>>(quaternion_plus<Dual<1>>(base, d));
          },
          i);
      EXPECT_LT((slope - right_jacobian_inverse<double>(phi).col(i)).norm(), 1e-14) << angle;
    }
}

TEST(Quaternion, OfAMatrixGivesTheMatrixBack) {
  for (Vec3 const& n : directions)
    for (double const angle : angles) {
      Mat3 const a = exp_so3<double>(angle * n);
      Q const b = quaternion_of(a);
      EXPECT_LT((matrix(b) - a).norm(), 4e-15) << angle;
      EXPECT_NEAR(b.norm(), 1.0, 1e-15);
      EXPECT_GE(b[0], 0.0);
    }
}

TEST(Quaternion, OfHalfTurnsAboutEveryAxis) {
  for (int i = 0; i < 3; ++i) {
    Mat3 a = -Mat3::Identity();
    a(i, i) = 1.0;
    EXPECT_LT((matrix(quaternion_of(a)) - a).norm(), 1e-15);
  }
}

}  // namespace quaternion_test
