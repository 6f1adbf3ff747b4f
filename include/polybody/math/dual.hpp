#pragma once
/// \file
/// Dual numbers for forward differentiation.

#include <Eigen/Core>
#include <cmath>
#include <concepts>

#include <polybody/math/compiler.hpp>

namespace polybody {

/// Dual number x + Σ dᵢ εᵢ with εᵢεⱼ = 0: a value `v` and `N` partial derivatives `d`.
/// f(x + d ε) = f(x) + f′(x) d ε  [Griewank & Walther 2008, §3.1].
template <int N>
struct Dual {
  static_assert(N > 0, "A dual number needs at least one partial derivative.");
  using Partials = Eigen::Array<double, N, 1>;  ///< (N) column of partial derivatives

  double v = 0.0;                 ///< value, in the unit of the quantity
  Partials d = Partials::Zero();  ///< (N) partial derivatives with respect to the independent variables

  Dual() = default;
  /// The constant `value`; all its derivatives are zero.
  Dual(double value) : v(value) {}  // NOLINT(google-explicit-constructor): a constant is a dual
  Dual(double value, Partials const& partials) : v(value), d(partials) {}  ///< a value and its derivatives

  /// Independent variable number `i` with the value `value`.
  static Dual variable(double value, int i) {
    Dual x(value);
    x.d[i] = 1.0;
    return x;
  }

  /// d(a + b) = da + db.
  Dual& operator+=(Dual const& b) {
    v += b.v;
    d += b.d;
    return *this;
  }
  /// d(a − b) = da − db.
  Dual& operator-=(Dual const& b) {
    v -= b.v;
    d -= b.d;
    return *this;
  }
  /// d(a b) = b da + a db.
  Dual& operator*=(Dual const& b) {
    d = d * b.v + b.d * v;
    v *= b.v;
    return *this;
  }
  /// d(a/b) = (da − (a/b) db)/b. Division by b = 0 yields infinities or NaN and does not throw.
  Dual& operator/=(Dual const& b) {
    double const inverse = 1.0 / b.v;
    v *= inverse;
    d = (d - b.d * v) * inverse;
    return *this;
  }

  friend Dual operator+(Dual a, Dual const& b) { return a += b; }
  friend Dual operator-(Dual a, Dual const& b) { return a -= b; }
  friend Dual operator*(Dual a, Dual const& b) { return a *= b; }
  friend Dual operator/(Dual a, Dual const& b) { return a /= b; }
  friend Dual operator-(Dual const& a) { return {-a.v, -a.d}; }
  friend Dual operator+(Dual const& a) { return a; }

  friend bool operator==(Dual const& a, Dual const& b) { return a.v == b.v; }
  friend auto operator<=>(Dual const& a, Dual const& b) { return a.v <=> b.v; }

  friend Dual sqrt(Dual const& a) {
    double const s = std::sqrt(a.v);
    if (s == 0.0) return {s, (a.d == 0.0).select(0.0, a.d / 0.0)};  // the derivative of a constant zero is zero
    return {s, a.d * (0.5 / s)};
  }
  friend Dual sin(Dual const& a) { return {std::sin(a.v), a.d * std::cos(a.v)}; }
  friend Dual cos(Dual const& a) { return {std::cos(a.v), a.d * -std::sin(a.v)}; }
  friend Dual tan(Dual const& a) {
    double const t = std::tan(a.v);
    return {t, a.d * (1.0 + t * t)};
  }
  friend Dual asin(Dual const& a) { return {std::asin(a.v), a.d / std::sqrt(1.0 - a.v * a.v)}; }
  friend Dual acos(Dual const& a) { return {std::acos(a.v), a.d / -std::sqrt(1.0 - a.v * a.v)}; }
  friend Dual atan(Dual const& a) { return {std::atan(a.v), a.d / (1.0 + a.v * a.v)}; }
  friend Dual atan2(Dual const& y, Dual const& x) {
    double const r2 = x.v * x.v + y.v * y.v;
    return {std::atan2(y.v, x.v), (y.d * x.v - x.d * y.v) / r2};
  }
  friend Dual exp(Dual const& a) {
    double const e = std::exp(a.v);
    return {e, a.d * e};
  }
  friend Dual log(Dual const& a) { return {std::log(a.v), a.d / a.v}; }
  friend Dual pow(Dual const& a, double p) { return {std::pow(a.v, p), a.d * (p * std::pow(a.v, p - 1.0))}; }
  friend Dual tanh(Dual const& a) {
    double const t = std::tanh(a.v);
    return {t, a.d * (1.0 - t * t)};
  }
  friend Dual abs(Dual const& a) { return a.v < 0.0 ? -a : a; }
  friend Dual abs2(Dual const& a) { return a * a; }
  friend Dual hypot(Dual const& a, Dual const& b) { return sqrt(a * a + b * b); }
  friend Dual max(Dual const& a, Dual const& b) { return a.v < b.v ? b : a; }
  friend Dual min(Dual const& a, Dual const& b) { return b.v < a.v ? b : a; }
  friend bool isfinite(Dual const& a) { return std::isfinite(a.v) && a.d.allFinite(); }
};

/// Value of the scalar `x` without derivatives. Formulas choose between branches by this value.
inline double value_of(double x) { return x; }
/// Value of the dual number `x` without derivatives.
template <int N>
double value_of(Dual<N> const& x) {
  return x.v;
}

/// Values of the matrix `m` of dual numbers.
template <class Derived>
auto values_of(Eigen::MatrixBase<Derived> const& m) {
  return m.unaryExpr([](typename Derived::Scalar const& x) { return value_of(x); }).eval();
}

/// Scalar type of a state: double, dual number, secant or tape variable (`ReverseVar`).
template <class T>
concept StateScalar = requires(T x, double c) {
  { x + x } -> std::convertible_to<T>;
  { x* c } -> std::convertible_to<T>;
  { value_of(x) } -> std::same_as<double>;
};

}  // namespace polybody

template <int N>
struct Eigen::NumTraits<polybody::Dual<N>> : Eigen::NumTraits<double> {
  using Real = polybody::Dual<N>;
  using NonInteger = polybody::Dual<N>;
  using Nested = polybody::Dual<N>;
  enum {
    IsComplex = 0,
    IsInteger = 0,
    IsSigned = 1,
    RequireInitialization = 1,
    ReadCost = 1 + N,
    AddCost = 1 + N,
    MulCost = 1 + 2 * N
  };
};

template <int N, class BinaryOp>
struct Eigen::ScalarBinaryOpTraits<polybody::Dual<N>, double, BinaryOp> {
  using ReturnType = polybody::Dual<N>;
};
template <int N, class BinaryOp>
struct Eigen::ScalarBinaryOpTraits<double, polybody::Dual<N>, BinaryOp> {
  using ReturnType = polybody::Dual<N>;
};
