#include <polybody/math/dual.hpp>

#include <gtest/gtest.h>

#include <polybody/testing/differences.hpp>

#include <Eigen/Dense>
#include <limits>
#include <numbers>
#include <type_traits>

using namespace polybody;
using namespace polybody::laws;

namespace dual_test {

using D = Dual<2>;
using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;
using Vec3D = Eigen::Matrix<D, 3, 1>;
using Mat3D = Eigen::Matrix<D, 3, 3>;

static_assert(StateScalar<double> && StateScalar<Dual<1>> && StateScalar<Dual<12>>);
static_assert(!StateScalar<std::string> && !StateScalar<void*>);

D const x = D::variable(0.7, 0);
D const y = D::variable(-1.3, 1);

void expect_dual(D const& a, double value, double by_x, double by_y) {
  EXPECT_DOUBLE_EQ(a.v, value);
  EXPECT_DOUBLE_EQ(a.d[0], by_x);
  EXPECT_DOUBLE_EQ(a.d[1], by_y);
}

TEST(Dual, AConstantHasNoDerivative) {
  expect_dual(D(3.5), 3.5, 0, 0);
  expect_dual(D(), 0, 0, 0);
  expect_dual(x, 0.7, 1, 0);
  expect_dual(y, -1.3, 0, 1);
}

TEST(Dual, ArithmeticFollowsTheRulesOfDifferentiation) {
  expect_dual(x + y, 0.7 - 1.3, 1, 1);
  expect_dual(x - y, 0.7 + 1.3, 1, -1);
  expect_dual(x * y, 0.7 * -1.3, -1.3, 0.7);
  expect_dual(x / y, 0.7 / -1.3, 1 / -1.3, -0.7 / (1.3 * 1.3));
  expect_dual(-x, -0.7, -1, 0);
  expect_dual(+x, 0.7, 1, 0);
}

TEST(Dual, MixesWithDoublesOnBothSides) {
  expect_dual(x + 2.0, 2.7, 1, 0);
  expect_dual(2.0 - x, 1.3, -1, 0);
  expect_dual(2.0 * x, 1.4, 2, 0);
  expect_dual(x / 2.0, 0.35, 0.5, 0);
  expect_dual(2.0 / x, 2.0 / 0.7, -2.0 / (0.7 * 0.7), 0);
  expect_dual(2 * x + 1, 2.4, 2, 0);
}

TEST(Dual, AssignsInPlaceEvenToItself) {
  D a = x;
  D const& same = a;
  a *= same;
  expect_dual(a, 0.49, 1.4, 0);
  a = x, a /= same;
  expect_dual(a, 1, 0, 0);
  a = x, a += same;
  expect_dual(a, 1.4, 2, 0);
  a = x, a -= same;
  expect_dual(a, 0, 0, 0);
  a = x, a *= y, a /= y;
  EXPECT_NEAR(a.d[0], 1.0, 1e-15);
  EXPECT_NEAR(a.d[1], 0.0, 1e-15);
}

TEST(Dual, ComparesByValueAlone) {
  EXPECT_TRUE(x == D(0.7) && x == 0.7 && x != y);
  EXPECT_TRUE(y < x && x > 0.0 && x >= 0.7 && -1.0 > y && y <= y);
  double const nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(D(nan) < x || D(nan) > x || D(nan) == D(nan));
}

/// One function of one variable, for doubles and duals, with its derivative in closed form.
struct Function {
  char const* name;
  double (*plain)(double);
  D (*dual)(D const&);
  double (*derivative)(double);
  std::vector<double> at;
};

std::vector<Function> const functions = {
    {"sqrt",
     [](double a) { return std::sqrt(a); },
     [](D const& a) { return sqrt(a); },
     [](double a) { return 0.5 / std::sqrt(a); },
     {0.2, 1.0, 9.0}},
    {"sin",
     [](double a) { return std::sin(a); },
     [](D const& a) { return sin(a); },
     [](double a) { return std::cos(a); },
     {-2.0, 0.0, 0.3, 4.0}},
    {"cos",
     [](double a) { return std::cos(a); },
     [](D const& a) { return cos(a); },
     [](double a) { return -std::sin(a); },
     {-2.0, 0.0, 0.3, 4.0}},
    {"tan",
     [](double a) { return std::tan(a); },
     [](D const& a) { return tan(a); },
     [](double a) { return 1.0 / (std::cos(a) * std::cos(a)); },
     {-1.0, 0.0, 0.3, 2.0}},
    {"asin",
     [](double a) { return std::asin(a); },
     [](D const& a) { return asin(a); },
     [](double a) { return 1.0 / std::sqrt(1.0 - a * a); },
     {-0.8, 0.0, 0.5}},
    {"acos",
     [](double a) { return std::acos(a); },
     [](D const& a) { return acos(a); },
     [](double a) { return -1.0 / std::sqrt(1.0 - a * a); },
     {-0.8, 0.0, 0.5}},
    {"atan",
     [](double a) { return std::atan(a); },
     [](D const& a) { return atan(a); },
     [](double a) { return 1.0 / (1.0 + a * a); },
     {-5.0, 0.0, 0.5}},
    {"exp",
     [](double a) { return std::exp(a); },
     [](D const& a) { return exp(a); },
     [](double a) { return std::exp(a); },
     {-3.0, 0.0, 1.5}},
    {"log",
     [](double a) { return std::log(a); },
     [](D const& a) { return log(a); },
     [](double a) { return 1.0 / a; },
     {0.2, 1.0, 7.0}},
    {"tanh",
     [](double a) { return std::tanh(a); },
     [](D const& a) { return tanh(a); },
     [](double a) { return 1.0 / (std::cosh(a) * std::cosh(a)); },
     {-1.5, 0.0, 0.4}},
    {"abs",
     [](double a) { return std::abs(a); },
     [](D const& a) { return abs(a); },
     [](double a) { return a < 0.0 ? -1.0 : 1.0; },
     {-1.5, 0.4}},
    {"abs2",
     [](double a) { return a * a; },
     [](D const& a) { return abs2(a); },
     [](double a) { return 2.0 * a; },
     {-1.5, 0.0, 0.4}},
    {"pow 2.5",
     [](double a) { return std::pow(a, 2.5); },
     [](D const& a) { return pow(a, 2.5); },
     [](double a) { return 2.5 * std::pow(a, 1.5); },
     {0.3, 2.0}},
    {"pow 3",
     [](double a) { return a * a * a; },
     [](D const& a) { return pow(a, 3.0); },
     [](double a) { return 3.0 * a * a; },
     {-1.2, 0.0, 2.0}},
    {"pow −2",
     [](double a) { return std::pow(a, -2.0); },
     [](D const& a) { return pow(a, -2.0); },
     [](double a) { return -2.0 / (a * a * a); },
     {-1.2, 2.0}},
};

TEST(Dual, FunctionsKeepTheirValueAndClosedFormDerivative) {
  for (Function const& f : functions)
    for (double const a : f.at) {
      D const out = f.dual(D(a, {1.0, -3.0}));  // chain rule: both partials scale alike
      double const slope = f.derivative(a);
      EXPECT_DOUBLE_EQ(out.v, f.plain(a)) << f.name << '(' << a << ')';
      EXPECT_NEAR(out.d[0], slope, 1e-14 * (1 + std::abs(slope))) << f.name << '(' << a << ')';
      EXPECT_NEAR(out.d[1], -3 * slope, 4e-14 * (1 + std::abs(slope))) << f.name << '(' << a << ')';
    }
}

TEST(Dual, FunctionsAgreeWithDifferences) {
  for (Function const& f : functions)
    for (double const a : f.at) {
      double const slope = slope_at_zero([&](double h) { return f.plain(a + h); }, 1e-3);
      EXPECT_NEAR(f.dual(D::variable(a, 0)).d[0], slope, 1e-8 * (1 + std::abs(slope))) << f.name << '(' << a << ')';
    }
}

TEST(Dual, Atan2KnowsAllFourQuadrants) {
  for (double const angle : {0.3, 1.5, 2.8, -2.8, -1.0}) {
    D const s = D::variable(2.0 * std::sin(angle), 0), c = D::variable(2.0 * std::cos(angle), 1);
    D const a = atan2(s, c);
    EXPECT_NEAR(a.v, angle, 1e-15);
    EXPECT_NEAR(a.d[0], 0.5 * std::cos(angle), 1e-15);
    EXPECT_NEAR(a.d[1], -0.5 * std::sin(angle), 1e-15);
  }
}

TEST(Dual, HypotIsTheLength) {
  D const h = hypot(D::variable(3.0, 0), D::variable(-4.0, 1));
  expect_dual(h, 5.0, 0.6, -0.8);
}

TEST(Dual, MinAndMaxTakeTheBranchWithItsDerivative) {
  expect_dual(max(x, y), 0.7, 1, 0);
  expect_dual(max(y, x), 0.7, 1, 0);
  expect_dual(min(x, y), -1.3, 0, 1);
  expect_dual(min(x, D(5.0)), 0.7, 1, 0);
  expect_dual(max(x, D(5.0)), 5.0, 0, 0);
}

// The derivative of √ at zero is infinite, but a constant has derivative zero: the norm of a vector that remains zero
// is not NaN.
TEST(Dual, RootOfAConstantZeroIsAConstantZero) {
  EXPECT_EQ(sqrt(Dual<2>(0.0)).d[0], 0.0);
  EXPECT_EQ(sqrt(Dual<2>::variable(0.0, 1)).d[0], 0.0);
  EXPECT_EQ(sqrt(Dual<2>::variable(0.0, 1)).d[1], std::numeric_limits<double>::infinity());
}

TEST(Dual, BranchesByValue) {
  auto const clamp = [](auto const& a) { return a > 1.0 ? decltype(a * a)(1.0) : a * a; };
  expect_dual(clamp(x), 0.49, 1.4, 0);
  expect_dual(clamp(x + 1.0), 1.0, 0, 0);
  EXPECT_EQ(value_of(x), 0.7);
  EXPECT_EQ(value_of(0.7), 0.7);
}

TEST(Dual, IsFiniteOnlyWithAllItsPartials) {
  double const nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(isfinite(x));
  EXPECT_FALSE(isfinite(D(nan)));
  EXPECT_FALSE(isfinite(D(1.0, {0.0, nan})));
  EXPECT_FALSE(isfinite(log(D(0.0))));
}

TEST(Dual, ChainsThroughAWholeExpression) {
  auto const f = [](auto const& a, auto const& b) {
    using std::atan2, std::cos, std::exp, std::sin, std::sqrt;
    return exp(sin(a) * b) / sqrt(1.0 + a * a) - atan2(b, a) * cos(a * b);
  };
  D const out = f(x, y);
  EXPECT_DOUBLE_EQ(out.v, f(0.7, -1.3));
  EXPECT_NEAR(out.d[0], slope_at_zero([&](double h) { return f(0.7 + h, -1.3); }), 1e-10);
  EXPECT_NEAR(out.d[1], slope_at_zero([&](double h) { return f(0.7, -1.3 + h); }), 1e-10);
}

// --- in Eigen ---------------------------------------------------------------------------------------------

Mat3 const a0 = (Mat3() << 2.0, -0.3, 0.5, 0.1, 1.7, -0.8, 0.4, 0.6, -1.1).finished();
Mat3 const a1 = (Mat3() << 0.2, 1.3, -0.5, 2.1, 0.7, 0.8, -0.4, 0.3, 0.9).finished();
Mat3 const b0 = (Mat3() << 1.0, 0.3, 0.5, -0.1, 0.7, 0.2, 0.9, 0.6, 3.1).finished();
Mat3 const b1 = (Mat3() << -0.2, 0.3, 1.5, 2.0, 0.1, 0.4, -0.4, 0.2, 0.5).finished();

/// value + slope ε₀.
template <class Derived>
auto dual_of(Eigen::MatrixBase<Derived> const& value, Eigen::MatrixBase<Derived> const& slope) {
  Eigen::Matrix<D, Derived::RowsAtCompileTime, Derived::ColsAtCompileTime> out = value.template cast<D>();
  for (Eigen::Index i = 0; i < value.size(); ++i) out(i).d[0] = slope(i);
  return out;
}
template <class Derived>
auto slope_of(Eigen::MatrixBase<Derived> const& m) {
  return m.unaryExpr([](D const& a) { return a.d[0]; }).eval();
}

Mat3D const a_dual = dual_of(a0, a1);
Mat3D const b_dual = dual_of(b0, b1);

TEST(DualInEigen, MatrixProductObeysTheProductRule) {
  Mat3D const c = a_dual * b_dual;
  EXPECT_LT((values_of(c) - a0 * b0).norm(), 1e-15);
  EXPECT_LT((slope_of(c) - (a1 * b0 + a0 * b1)).norm(), 1e-14);
}

TEST(DualInEigen, DynamicAndTransposedProductsToo) {
  Eigen::Matrix<D, Eigen::Dynamic, Eigen::Dynamic> const a = a_dual, b = b_dual;
  auto const c = (a.transpose() * b).eval();
  EXPECT_LT((values_of(c) - a0.transpose() * b0).norm(), 1e-14);
  EXPECT_LT((slope_of(c) - (a1.transpose() * b0 + a0.transpose() * b1)).norm(), 1e-14);
}

// Large enough that Eigen chooses its blocked kernel.
TEST(DualInEigen, BlockedProductIsRightAsWell) {
  Eigen::MatrixXd const p = Eigen::MatrixXd::Random(40, 50), q = Eigen::MatrixXd::Random(50, 30);
  Eigen::MatrixXd const dp = Eigen::MatrixXd::Random(40, 50), dq = Eigen::MatrixXd::Random(50, 30);
  auto const c = (dual_of(p, dp) * dual_of(q, dq)).eval();
  EXPECT_LT((values_of(c) - p * q).norm(), 1e-12);
  EXPECT_LT((slope_of(c) - (dp * q + p * dq)).norm(), 1e-12);
}

TEST(DualInEigen, DoubleMatricesMultiplyDuals) {
  Mat3D const left = a0 * b_dual, right = b_dual * a0;
  EXPECT_LT((slope_of(left) - a0 * b1).norm(), 1e-14);
  EXPECT_LT((slope_of(right) - b1 * a0).norm(), 1e-14);
}

TEST(DualInEigen, DoubleAndDualFactorsScaleDualsAndDoubles) {
  EXPECT_LT((slope_of((2.0 * a_dual).eval()) - 2.0 * a1).norm(), 1e-15);
  EXPECT_LT((slope_of((a_dual / 2.0).eval()) - 0.5 * a1).norm(), 1e-15);
  EXPECT_LT((slope_of((a_dual * x).eval()) - (0.7 * a1 + a0)).norm(), 1e-15);
  EXPECT_LT((slope_of((a0 * x).eval()) - a0).norm(), 1e-15);
  EXPECT_LT((slope_of((a_dual + a0.cast<D>()).eval()) - a1).norm(), 1e-15);
}

TEST(DualInEigen, VectorOperations) {
  Vec3 const u0 = a0.col(0), u1 = a1.col(0), w0 = b0.col(1), w1 = b1.col(1);
  Vec3D const u = dual_of(u0, u1), w = dual_of(w0, w1);
  EXPECT_NEAR(u.dot(w).d[0], u1.dot(w0) + u0.dot(w1), 1e-15);
  EXPECT_LT((slope_of(u.cross(w)) - u1.cross(w0) - u0.cross(w1)).norm(), 1e-15);
  EXPECT_NEAR(u.squaredNorm().d[0], 2 * u0.dot(u1), 1e-15);
  EXPECT_NEAR(u.norm().d[0], u0.dot(u1) / u0.norm(), 1e-15);
  EXPECT_NEAR(u.sum().d[0], u1.sum(), 1e-15);
}

// (det A)˙ = det A tr(A⁻¹ A˙),  (A⁻¹)˙ = −A⁻¹ A˙ A⁻¹.
TEST(DualInEigen, DeterminantAndInverse) {
  Mat3 const inverse = a0.inverse();
  EXPECT_NEAR(a_dual.determinant().d[0], a0.determinant() * (inverse * a1).trace(), 1e-13);
  EXPECT_LT((slope_of(a_dual.inverse().eval()) + inverse * a1 * inverse).norm(), 1e-13);
}

TEST(DualInEigen, SolvesLinearSystems) {
  Vec3 const rhs(1.0, -2.0, 0.5), solution = a0.partialPivLu().solve(rhs);
  Vec3D const s = a_dual.partialPivLu().solve(rhs.cast<D>());
  EXPECT_LT((values_of(s) - solution).norm(), 1e-14);
  EXPECT_LT((slope_of(s) + a0.partialPivLu().solve(a1 * solution)).norm(), 1e-13);
}

// Comparisons of Eigen and of duals use the values; only isfinite(x) checks the partials.
TEST(DualInEigen, AllFiniteLooksAtValues) {
  Vec3D u = a_dual.col(0);
  EXPECT_TRUE(u.allFinite());
  u[1].v = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(u.allFinite());
}

}  // namespace dual_test
