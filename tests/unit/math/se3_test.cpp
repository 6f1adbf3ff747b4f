#include <polybody/math/se3.hpp>

#include <gtest/gtest.h>

#include <numbers>
#include <vector>

#include <polybody/testing/differences.hpp>

namespace polybody {
namespace se3_test {

using D = Dual<1>;

/// Angles around zero, around the ends of the series (0.2 and 2), and up to π.
std::vector<double> const angles = {0.0, 1e-9, 1e-4, 0.1, 0.199, 0.201, 0.7, 1.9, 1.999, 2.001, 2.5, 3.1};

ScrewVector<double> screw(double angle) { return {Vec3(0.9, -0.4, 1.3), angle * Vec3(0.6, -0.48, 0.64)}; }
Vec6 vector(ScrewVector<double> const& x) { return (Vec6() << x.translation, x.rotation).finished(); }
ScrewVector<double> screw_of(Vec6 const& x) { return {x.head<3>(), x.tail<3>()}; }

ScrewVector<D> along(ScrewVector<double> const& x, ScrewVector<double> const& rate) {
  ScrewVector<D> out;
  for (int i = 0; i < 3; ++i) {
    out.translation[i] = D(x.translation[i], D::Partials(rate.translation[i]));
    out.rotation[i] = D(x.rotation[i], D::Partials(rate.rotation[i]));
  }
  return out;
}
Vec6 slope_of(ScrewVector<D> const& x) {
  Vec6 out;
  for (int i = 0; i < 3; ++i) {
    out[i] = x.translation[i].d[0];
    out[3 + i] = x.rotation[i].d[0];
  }
  return out;
}
ScrewVector<D> constant(ScrewVector<double> const& x) { return along(x, {Vec3::Zero(), Vec3::Zero()}); }

/// Homogeneous matrix of a motion, and the matrix of a screw.
Mat<double, 4, 4> matrix(RigidMotion<double> const& h) {
  Mat<double, 4, 4> m = Mat<double, 4, 4>::Identity();
  m.topLeftCorner<3, 3>() = h.A;
  m.topRightCorner<3, 1>() = h.r;
  return m;
}
Mat<double, 4, 4> matrix(ScrewVector<double> const& d) {
  Mat<double, 4, 4> m = Mat<double, 4, 4>::Zero();
  m.topLeftCorner<3, 3>() = skew<double>(d.rotation);
  m.topRightCorner<3, 1>() = d.translation;
  return m;
}

// exp(d) = Σ dᵏ/k! of the matrices 4×4.
TEST(Se3, ExpIsTheExponentialOfTheMatrix) {
  for (double const angle : angles) {
    Mat<double, 4, 4> expected = Mat<double, 4, 4>::Identity(), term = expected;
    for (int k = 1; k < 40; ++k) {
      term = term * matrix(screw(angle)) / k;
      expected += term;
    }
    EXPECT_LT((matrix(exp_se3<double>(screw(angle))) - expected).norm(), 1e-14) << angle;
  }
}

TEST(Se3, LogOfExpIsIdentity) {
  for (double const angle : angles) {
    auto const h = exp_se3<double>(screw(angle));
    auto const d = log_se3<double>(h.r, quaternion_of(h.A));
    EXPECT_LT((vector(d) - vector(screw(angle))).norm(), 1e-14) << angle;
  }
}

// exp(d)⁻¹ d/dt exp(d) is the matrix of the screw T(d) ḋ.
TEST(Se3, TangentIsTheBodyTwistOfExp) {
  for (double const angle : angles)
    for (int k = 0; k < 6; ++k) {
      ScrewVector<double> const rate = screw_of(Vec6::Unit(k)), d = screw(angle);
      auto const moving = exp_se3<D>(along(d, rate));
      auto const h = exp_se3<double>(d);
      Mat3 const a = h.A.transpose() * moving.A.unaryExpr([](D const& x) { return x.d[0]; });
      Vec3 const v = h.A.transpose() * moving.r.unaryExpr([](D const& x) { return x.d[0]; });
      auto const twist = se3_tangent<double>(d)(rate);
      EXPECT_LT((a - skew<double>(twist.rotation)).norm(), 1e-14) << angle;
      EXPECT_LT((v - twist.translation).norm(), 1e-14) << angle;
    }
}

TEST(Se3, InverseTangentUndoesTheTangent) {
  for (double const angle : angles) {
    auto const d = screw(angle);
    Mat<double, 6, 6> const one = product(se3_tangent<double>(d), se3_tangent_inverse<double>(d)).full();
    EXPECT_LT((one - Mat<double, 6, 6>::Identity()).norm(), 2e-14) << angle;
    EXPECT_LT((se3_tangent<double>(d).diagonal - right_jacobian<double>(d.rotation)).norm(), 1e-14);
    EXPECT_LT((se3_tangent_inverse<double>(d).diagonal - right_jacobian_inverse<double>(d.rotation)).norm(), 1e-14);
  }
}

// Ad(H) = [A, r̃ A; 0, A] of H = exp(d), T(−d) = Ad(exp(d)) T(d), and blockwise transposition is the change of sign of
// d.
TEST(Se3, AdjointMapAndOppositeMotions) {
  for (double const angle : angles) {
    auto const d = screw(angle), back = opposite(d);
    auto const h = exp_se3<double>(d);
    EXPECT_LT((se3_adjoint<double>(d).diagonal - h.A).norm(), 1e-14);
    EXPECT_LT((se3_adjoint<double>(d).coupling - skew<double>(h.r) * h.A).norm(), 1e-14) << angle;
    auto const left = product(se3_adjoint<double>(d), se3_tangent<double>(d));
    EXPECT_LT((left.full() - se3_tangent<double>(back).full()).norm(), 1e-14) << angle;
    auto const turned = blockwise_transposed(se3_tangent_inverse<double>(d));
    EXPECT_LT((turned.full() - se3_tangent_inverse<double>(back).full()).norm(), 1e-14) << angle;
  }
}

// exp(x) exp(y) exp(−x) = exp(Ad(exp(x)) y), and the bracket is its derivative with respect to x.
TEST(Se3, BracketIsTheDerivativeOfTheAdjointMap) {
  auto const x = screw(0.9), y = screw_of((Vec6() << 0.3, 0.5, -0.8, 0.2, -1.1, 0.4).finished());
  Mat<double, 4, 4> const direct =
      matrix(exp_se3<double>(x)) * matrix(exp_se3<double>(y)) * matrix(exp_se3<double>(opposite(x)));
  EXPECT_LT((matrix(exp_se3<double>(se3_adjoint<double>(x)(y))) - direct).norm(), 1e-14);
  auto const moved = se3_adjoint<D>(along({Vec3::Zero(), Vec3::Zero()}, x))(constant(y));
  EXPECT_LT((slope_of(moved) - vector(bracket(x, y))).norm(), 1e-15);
  Mat<double, 4, 4> const commutator = matrix(x) * matrix(y) - matrix(y) * matrix(x);
  EXPECT_LT((matrix(bracket(x, y)) - commutator).norm(), 1e-15);
}

/// Compares a map of screws with dual numbers, and with differences of f.
template <class F, class G>
void expect_derivative(ScrewMap<double> const& map, ScrewVector<double> const& d, F&& of_dual, G&& of_double,
                       double angle) {
  for (int k = 0; k < 6; ++k) {
    Vec6 const unit = Vec6::Unit(k), expected = vector(map(screw_of(unit)));
    EXPECT_LT((slope_of(of_dual(along(d, screw_of(unit)))) - expected).norm(), 1e-13) << angle << ", " << k;
    Vec6 const slope = laws::slope_at_zero(
        [&](double h) -> Vec6 { return vector(of_double(sum(d, scaled(screw_of(unit), h)))); }, 1e-2);
    EXPECT_LT((slope - expected).norm(), 1e-10) << angle << ", " << k;
  }
}

TEST(Se3, DerivativesOfTheTangentOperators) {
  ScrewVector<double> const y = screw_of((Vec6() << 0.3, 0.5, -0.8, 0.2, -1.1, 0.4).finished());
  for (double const angle : angles) {
    auto const d = screw(angle);
    expect_derivative(
        se3_tangent_derivative<double>(d, y), d, [&](auto const& x) { return se3_tangent<D>(x)(constant(y)); },
        [&](auto const& x) { return se3_tangent<double>(x)(y); }, angle);
    expect_derivative(
        se3_tangent_inverse_derivative<double>(d, y), d,
        [&](auto const& x) { return se3_tangent_inverse<D>(x)(constant(y)); },
        [&](auto const& x) { return se3_tangent_inverse<double>(x)(y); }, angle);
  }
}

// Value, first and second derivative of every coefficient are continuous at the ends of the series, x = 0.04 and 4.
TEST(Se3, CoefficientsHaveNoStepWhereTheSeriesEnds) {
  for (double const end : {0.04, 4.0})
    for (auto const series : {&exp_series<double>, &tangent_series<double>, &tangent_inverse_series<double>}) {
      OperatorSeries<double> const below = series(std::nextafter(end, 0.0)), above = series(end);
      EXPECT_NEAR(below.f, above.f, 1e-15) << end;
      EXPECT_NEAR(below.g, above.g, 1e-15) << end;
      EXPECT_NEAR(below.df, above.df, 1e-15) << end;
      EXPECT_NEAR(below.dg, above.dg, 1e-15) << end;
      EXPECT_NEAR(below.ddf, above.ddf, 1e-15) << end;
      EXPECT_NEAR(below.ddg, above.ddg, 1e-15) << end;
    }
}

// The derivatives of the coefficients, compared with dual numbers in the coefficients themselves.
TEST(Se3, DerivativesOfTheCoefficients) {
  for (double const x : {0.0, 1e-6, 0.03, 0.05, 1.0, 3.9, 4.1, 9.0, 25.0})
    for (int kind = 0; kind < 3; ++kind) {
      D const at = D::variable(x, 0);
      OperatorSeries<D> const s = kind == 0   ? exp_series<D>(at)
                                  : kind == 1 ? tangent_series<D>(at)
                                              : tangent_inverse_series<D>(at);
      double const size = kind == 2 && x > 20.0 ? 10.0 : 1.0;  // cot(θ/2) grows towards 2π
      EXPECT_NEAR(s.f.d[0], s.df.v, 1e-15 * size) << x << ", " << kind;
      EXPECT_NEAR(s.g.d[0], s.dg.v, 1e-15 * size) << x << ", " << kind;
      EXPECT_NEAR(s.df.d[0], s.ddf.v, 1e-15 * size) << x << ", " << kind;
      EXPECT_NEAR(s.dg.d[0], s.ddg.v, 1e-15 * size) << x << ", " << kind;
    }
}

}  // namespace se3_test
}  // namespace polybody
