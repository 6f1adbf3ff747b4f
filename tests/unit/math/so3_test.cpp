#include <polybody/math/so3.hpp>

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <numbers>
#include <vector>

#include <polybody/math/quaternion.hpp>

using namespace polybody;

namespace so3_test {

double const pi = std::numbers::pi;

/// Directions in general position, except the last.
std::vector<Vec3> const directions = {Vec3(0.6, -0.3, 0.5).normalized(), Vec3(-0.1, 0.9, 0.2).normalized(),
                                      Vec3(-0.5, -0.5, -0.7).normalized(), Vec3(0, 0, 1)};

/// Angles around zero, around the switch from series to closed form at |φ| = 0.5, and up to π.
std::vector<double> const angles = {0.0,  1e-12, 1e-8, 1e-4, 1e-2, 0.1,       0.49,
                                    0.51, 1.0,   2.0,  3.0,  3.14, pi - 1e-7, pi - 1e-12};

/// Σ (−x)ᵏ/(2k + first)! in long double: sin θ/θ (first = 1), (1 − cos θ)/θ² (2), (θ − sin θ)/θ³ (3).
long double factorial_series(long double x, int first) {
  long double sum = 0.0L, term = 1.0L;
  for (int i = 2; i <= first; ++i) term /= i;
  for (int k = 0; k < 40; ++k) {
    sum += term;
    term *= -x / ((2 * k + first + 1.0L) * (2 * k + first + 2.0L));
  }
  return sum;
}

/// (1 − (a/2b))/x without cancellation: [Σ (−x)ᵏ⁻¹ k/((k+1)(2k+1)!)]/2b, k ≥ 1.
long double inverse_coefficient(long double x) {
  long double sum = 0.0L, factor = 1.0L / 6.0L;  // (−x)ᵏ⁻¹/(2k+1)!
  for (int k = 1; k < 40; ++k) {
    sum += factor * k / (k + 1);
    factor *= -x / ((2 * k + 2.0L) * (2 * k + 3.0L));
  }
  return sum / (2.0L * factorial_series(x, 2));
}

TEST(So3, SkewIsTheCrossProduct) {
  Vec3 const a(0.3, -1.2, 2.5), b(-0.7, 0.4, 1.1);
  EXPECT_LT((skew<double>(a) * b - a.cross(b)).norm(), 1e-15);
  EXPECT_EQ(skew<double>(a).transpose(), -skew<double>(a));
}

TEST(So3, CoefficientsAreThoseOfHighPrecision) {
  for (double const angle : {0.0, 1e-12, 1e-8, 1e-4, 1e-2, 0.3, 0.49, 0.51, 1.0, 2.0, 3.0, 6.0}) {
    double const x = angle * angle;
    RotationSeries<double> const s(x);
    EXPECT_NEAR(s.a, double(factorial_series(x, 1)), 1e-15) << angle;
    EXPECT_NEAR(s.b, double(factorial_series(x, 2)), 1e-15) << angle;
    EXPECT_NEAR(s.c, double(factorial_series(x, 3)), 2e-15) << angle;
  }
}

TEST(So3, CoefficientsHaveNoStepWhereTheSeriesEnds) {
  RotationSeries<double> const below(std::nextafter(0.25, 0.0)), above(0.25);
  EXPECT_NEAR(below.a, above.a, 1e-15);
  EXPECT_NEAR(below.b, above.b, 1e-15);
  EXPECT_NEAR(below.c, above.c, 1e-15);
}

// The derivatives of the coefficients with respect to x are continuous as well; with dual numbers.
TEST(So3, SlopesOfTheCoefficientsHaveNoStepEither) {
  using D = Dual<1>;
  RotationSeries<D> const below(D::variable(std::nextafter(0.25, 0.0), 0)), above(D::variable(0.25, 0));
  EXPECT_NEAR(below.a.d[0], above.a.d[0], 1e-14);
  EXPECT_NEAR(below.b.d[0], above.b.d[0], 1e-14);
  EXPECT_NEAR(below.c.d[0], above.c.d[0], 1e-14);
}

TEST(So3, ExpIsOrthogonalWithDeterminantOne) {
  for (Vec3 const& n : directions)
    for (double const angle : angles) {
      Mat3 const a = exp_so3<double>(angle * n);
      EXPECT_LT((a.transpose() * a - Mat3::Identity()).norm(), 2e-15) << angle;
      EXPECT_NEAR(a.determinant(), 1.0, 2e-15) << angle;
    }
}

TEST(So3, ExpTurnsByTheAngleAboutTheAxis) {
  for (Vec3 const& n : directions)
    for (double const angle : {1e-8, 1e-4, 1e-2, 0.49, 0.51, 3.0, 5.0, 7.0})
      EXPECT_LT((exp_so3<double>(angle * n) - Eigen::AngleAxisd(angle, n).toRotationMatrix()).norm(), 4e-15) << angle;
}

// Small contributions keep their relative accuracy: A − 1 = a φ̃ + b φ̃² from long double.
TEST(So3, ExpIsSmoothThroughZero) {
  Vec3 const n = directions[0];
  for (double const angle : {1e-8, 1e-4, 1e-2}) {
    Mat3 const h = skew<double>(angle * n);
    long double const x = (long double)(angle)*angle;
    Mat3 const expected = double(factorial_series(x, 1)) * h + double(factorial_series(x, 2)) * h * h;
    EXPECT_LT((exp_so3<double>(angle * n) - Mat3::Identity() - expected).norm(), 3e-16) << angle;
  }
}

TEST(So3, LogOfExpIsIdentityThroughZero) {
  for (Vec3 const& n : directions)
    for (double const angle : angles) {
      Vec3 const phi = angle * n;
      EXPECT_LT((log_so3(exp_so3<double>(phi)) - phi).norm(), 1e-15 + 4e-15 * angle) << angle;
    }
}

// Small rotations keep their relative accuracy.
TEST(So3, LogKeepsTinyAngles) {
  for (double const angle : {1e-12, 1e-8, 1e-4})
    EXPECT_LT((log_so3(exp_so3<double>(angle * directions[0])) - angle * directions[0]).norm(), 1e-15 * angle);
}

TEST(So3, LogOfAHalfTurnIsOneOfTheTwoVectors) {
  for (Vec3 const& n : directions) {
    Vec3 const phi = log_so3(exp_so3<double>(pi * n));
    EXPECT_NEAR(phi.norm(), pi, 1e-14);
    EXPECT_NEAR(std::abs(phi.dot(n)), pi, 1e-14);
  }
}

TEST(So3, LogOfMoreThanAHalfTurnIsTheShortWay) {
  Vec3 const n = directions[1];
  EXPECT_LT((log_so3(exp_so3<double>(4.0 * n)) - (4.0 - 2.0 * pi) * n).norm(), 1e-14);
}

/// The directional derivative of `f` at φ along δ, by dual numbers.
template <class F>
Mat3 derivative(F&& f, Vec3 const& phi, Vec3 const& delta) {
  using D = Dual<1>;
  Vec<D, 3> moved = phi.cast<D>();
  for (int i = 0; i < 3; ++i) moved[i].d[0] = delta[i];
  return f(moved).unaryExpr([](D const& x) { return x.d[0]; });
}

// exp(φ + εδ) = exp(φ) exp(ε Jr δ) = exp(ε Jl δ) exp(φ) to first order.
TEST(So3, JacobiansAreTheDerivativeOfExp) {
  auto const exp = [](auto const& phi) { return exp_so3<Dual<1>>(phi); };
  for (Vec3 const& n : directions)
    for (double const angle : angles)
      for (int i = 0; i < 3; ++i) {
        Vec3 const phi = angle * n, delta = Vec3::Unit(i);
        Mat3 const a = exp_so3<double>(phi), slope = derivative(exp, phi, delta);
        EXPECT_LT((slope - a * skew<double>(right_jacobian<double>(phi) * delta)).norm(), 1e-14) << angle;
        EXPECT_LT((slope - skew<double>(left_jacobian<double>(phi) * delta) * a).norm(), 1e-14) << angle;
      }
}

TEST(So3, JacobiansAreThoseOfHighPrecision) {
  for (double const angle : {1e-8, 1e-4, 1e-2, 0.49, 0.51, 2.0, 5.0}) {
    double const x = angle * angle;
    Mat3 const h = skew<double>(angle * directions[0]);
    Mat3 const forward = Mat3::Identity() - double(factorial_series(x, 2)) * h + double(factorial_series(x, 3)) * h * h;
    Mat3 const inverse = Mat3::Identity() + 0.5 * h + double(inverse_coefficient(x)) * h * h;
    EXPECT_LT((right_jacobian<double>(angle * directions[0]) - forward).norm(), 4e-15 * (1 + x)) << angle;
    EXPECT_LT((right_jacobian_inverse<double>(angle * directions[0]) - inverse).norm(), 4e-15 * (1 + x)) << angle;
  }
}

TEST(So3, LeftJacobianIsTheTransposeOfTheRight) {
  Vec3 const phi(0.4, -1.1, 0.8);
  EXPECT_LT((left_jacobian<double>(phi) - right_jacobian<double>(phi).transpose()).norm(), 1e-15);
  EXPECT_LT((left_jacobian<double>(phi) - exp_so3<double>(phi) * right_jacobian<double>(phi)).norm(), 2e-15);
}

TEST(So3, InverseJacobianUndoesTheJacobian) {
  for (Vec3 const& n : directions)
    for (double const angle : {0.0, 1e-12, 1e-8, 1e-4, 1e-2, 0.49, 0.51, 1.0, 3.0, 5.0, 6.0}) {
      Vec3 const phi = angle * n;
      Mat3 const product = right_jacobian<double>(phi) * right_jacobian_inverse<double>(phi);
      EXPECT_LT((product - Mat3::Identity()).norm(), 1e-13) << angle;  // 2π is near: the inverse grows
    }
}

TEST(So3, InverseJacobianHasNoStepWhereTheSeriesEnds) {
  Vec3 const below(0, 0, std::nextafter(0.5, 0.0)), above(0, 0, 0.5);
  EXPECT_LT((right_jacobian_inverse<double>(below) - right_jacobian_inverse<double>(above)).norm(), 1e-15);
}

// d/dε Jr⁻¹(φ + εδ) = −Jr⁻¹ (d/dε Jr) Jr⁻¹: both sides use independent series.
TEST(So3, DerivativeOfTheInverseJacobianMatchesThatOfTheJacobian) {
  auto const forward = [](auto const& phi) { return right_jacobian<Dual<1>>(phi); };
  auto const backward = [](auto const& phi) { return right_jacobian_inverse<Dual<1>>(phi); };
  for (double const angle : {0.0, 1e-8, 1e-4, 1e-2, 0.49, 0.51, 2.0})
    for (int i = 0; i < 3; ++i) {
      Vec3 const phi = angle * directions[1], delta = Vec3::Unit(i);
      Mat3 const inverse = right_jacobian_inverse<double>(phi);
      EXPECT_LT((derivative(backward, phi, delta) + inverse * derivative(forward, phi, delta) * inverse).norm(), 1e-14)
          << angle;
    }
}

// b′ = Σ k (−1)ᵏ xᵏ⁻¹/(2k + 2)! and c′ = Σ k (−1)ᵏ xᵏ⁻¹/(2k + 3)!, k ≥ 1, in long double.
TEST(So3, SlopesAreThoseOfHighPrecision) {
  auto const slope = [](long double x, int first) {
    long double sum = 0.0L, factor = -1.0L;  // (−1)ᵏ xᵏ⁻¹/(2k + first)!
    for (int i = 2; i <= first + 2; ++i) factor /= i;
    for (int k = 1; k < 40; ++k) {
      sum += k * factor;
      factor *= -x / ((2 * k + first + 1.0L) * (2 * k + first + 2.0L));
    }
    return double(sum);
  };
  for (double const angle : {0.0, 1e-8, 1e-4, 1e-2, 0.3, 0.49, 0.51, 1.0, 3.0, 6.0}) {
    double const x = angle * angle;
    RotationDerivatives<double> const s(x);
    EXPECT_NEAR(s.b, slope(x, 2), 2e-15) << angle;
    EXPECT_NEAR(s.c, slope(x, 3), 2e-15) << angle;
  }
}

/// m = (1 − atan t/t)/t² in long double: by Σ (−z)ᵏ/(2k + 3) for z ≤ 0.3, else by the formula.
long double arctan_rest(long double z) {
  if (z > 0.3L) return (1.0L - std::atan(std::sqrt(z)) / std::sqrt(z)) / z;
  long double sum = 0.0L, power = 1.0L;
  for (int k = 0; k < 40; ++k) {
    sum += power / (2 * k + 3);
    power *= -z;
  }
  return sum;
}

// The derivatives follow from the differential equation 2 z a′ + a = 1/(1 + z), with a = 1 − z m.
TEST(So3, ArctanIsThatOfHighPrecision) {
  for (double const t :
       {0.0, 1e-12, 1e-8, 1e-4, 1e-2, 0.1, 0.3, 0.316, 0.3163, 0.5, 0.99}) {  // the series ends at √0.1
    double const z = t * t;
    long double const m = arctan_rest(z);
    ArctanSeries<double> const s(z);
    EXPECT_NEAR(s.m, double(m), 2e-15) << t;
    EXPECT_NEAR(s.a, double(1.0L - z * m), 2e-16) << t;
    if (t > 0.0) {
      EXPECT_NEAR(s.a * t, std::atan(t), 2e-16 * t) << t;
    }
    if (t < 0.05) continue;  // below 0.05 the quotients lose their digits
    long double const da = (1.0L / (1.0L + z) - (1.0L - z * m)) / (2.0L * z);
    EXPECT_NEAR(s.da, double(da), 1e-14) << t;
    EXPECT_NEAR(s.dm, double(-(da + m) / z), 1e-13) << t;
  }
  ArctanSeries<double> const zero(0.0);
  EXPECT_EQ(zero.da, -1.0 / 3.0);  // 1 − z/3 + z²/5 − ...
  EXPECT_EQ(zero.dm, -0.2);
}

TEST(So3, SlopesOfTheArctanAreItsDerivatives) {
  using D = Dual<1>;
  for (double const z : {0.0, 1e-8, 1e-4, 0.01, 0.0999, 0.1001, 0.5}) {
    ArctanSeries<D> const s(D::variable(z, 0));
    EXPECT_NEAR(s.a.d[0], s.da.v, 1e-14) << z;
    EXPECT_NEAR(s.m.d[0], s.dm.v, 1e-13) << z;
  }
}

// Jr(φ + εy) x, for x and y in general position relative to φ.
TEST(So3, DerivativeOfTheJacobianIsWhatItSays) {
  Vec3 const x(0.7, -1.3, 0.4);
  auto const applied = [&](auto const& phi) -> Mat<Dual<1>, 3, 3> {
    Mat<Dual<1>, 3, 3> out;
    for (int j = 0; j < 3; ++j) out.col(j) = right_jacobian<Dual<1>>(phi) * x.cast<Dual<1>>();
    return out;
  };
  for (double const angle : {0.0, 1e-8, 1e-4, 1e-2, 0.49, 0.51, 2.0, 5.0})
    for (int i = 0; i < 3; ++i) {
      Vec3 const phi = angle * directions[1];
      Vec3 const slope = derivative(applied, phi, Vec3::Unit(i)).col(0);
      EXPECT_LT((right_jacobian_derivative<double>(phi, x).col(i) - slope).norm(), 1e-14) << angle;
    }
}

}  // namespace so3_test
