#pragma once
/// \file
/// Numbers that carry the values of a function at both ends of a step and its secant slopes.
/// Theory: Eq. 6.18.

#include <polybody/math/dual.hpp>

namespace polybody {

/// Secant: values `a` = f₀ and `b` = f₁ of a function f at the two ends of a step, and slopes `d` = s with respect to N
/// variables x, with f₁ − f₀ = s·(x₁ − x₀). Formulas propagate slopes as dual numbers propagate derivatives [slopes:
/// Krawczyk & Neumaier 1985; Rump 1996]. The rules are symmetric in the two ends:
///   s(f g) = f̄ s(g) + ḡ s(f),   s(f/g) = (ḡ s(f) − f̄ s(g))/(g₀ g₁),   f̄ = ½ (f₀ + f₁).
/// Therefore s is a discrete gradient [Gonzalez 1996]: f₁ − f₀ = s·(x₁ − x₀) holds exactly, and s is the gradient at
/// the midpoint up to O(|x₁ − x₀|²). For a quadratic form, s is the gradient at the midpoint. For a function of
/// quadratic forms that is invariant under a rotation, s is orthogonal to the rotations of the midpoint.
template <int N>
struct Secant {
  static_assert(N > 0, "A secant needs at least one variable.");
  using Slope = Eigen::Array<double, N, 1>;  ///< (N) column of slopes

  double a = 0.0, b = 0.0;  ///< values at both ends of the step, in the unit of the quantity
  Slope d = Slope::Zero();  ///< (N) slopes over the step with respect to the variables

  Secant() = default;
  /// The constant `value`: equal at both ends, all slopes zero.
  Secant(double value) : a(value), b(value) {}  // NOLINT(google-explicit-constructor): a constant is a secant
  /// Values at both ends, `from` and `to`, and the slopes.
  Secant(double from, double to, Slope const& slope) : a(from), b(to), d(slope) {}

  /// Independent variable number `i`, which changes from `from` to `to`.
  static Secant variable(double from, double to, int i) {
    Secant x(from, to, Slope::Zero());
    x.d[i] = 1.0;
    return x;
  }

  double mean() const { return 0.5 * (a + b); }  ///< ½ (a + b)
  double change() const { return b - a; }        ///< b − a

  /// s(f + g) = s(f) + s(g).
  Secant& operator+=(Secant const& y) {
    a += y.a;
    b += y.b;
    d += y.d;
    return *this;
  }
  /// s(f − g) = s(f) − s(g).
  Secant& operator-=(Secant const& y) {
    a -= y.a;
    b -= y.b;
    d -= y.d;
    return *this;
  }
  /// s(f g) = ḡ s(f) + f̄ s(g).
  Secant& operator*=(Secant const& y) {
    d = d * y.mean() + y.d * mean();
    a *= y.a;
    b *= y.b;
    return *this;
  }
  /// s(f/g) = (ḡ s(f) − f̄ s(g))/(g₀ g₁); g must not be zero at either end.
  Secant& operator/=(Secant const& y) {
    d = (d * y.mean() - y.d * mean()) / (y.a * y.b);
    a /= y.a;
    b /= y.b;
    return *this;
  }

  friend Secant operator+(Secant x, Secant const& y) { return x += y; }
  friend Secant operator-(Secant x, Secant const& y) { return x -= y; }
  friend Secant operator*(Secant x, Secant const& y) { return x *= y; }
  friend Secant operator/(Secant x, Secant const& y) { return x /= y; }
  friend Secant operator-(Secant const& x) { return {-x.a, -x.b, -x.d}; }
  friend Secant operator+(Secant const& x) { return x; }

  friend bool operator==(Secant const& x, Secant const& y) { return x.mean() == y.mean(); }
  friend auto operator<=>(Secant const& x, Secant const& y) { return x.mean() <=> y.mean(); }

  friend Secant sqrt(Secant const& x) {
    double const from = std::sqrt(x.a), to = std::sqrt(x.b);
    if (from + to == 0.0)
      return {from, to, (x.d == 0.0).select(0.0, x.d / 0.0)};  // the slope of a constant zero is zero
    return {from, to, x.d / (from + to)};
  }
  /// Slopes by sin b − sin a = 2 cos ½(a + b) sin ½(b − a) and cos b − cos a = −2 sin ½(a + b) sin ½(b − a).
  friend Secant sin(Secant const& x) { return {std::sin(x.a), std::sin(x.b), x.d * (std::cos(x.mean()) * chord(x))}; }
  friend Secant cos(Secant const& x) { return {std::cos(x.a), std::cos(x.b), x.d * (-std::sin(x.mean()) * chord(x))}; }
  /// The angle changes by φ = atan2(X, D), X = x₀ y₁ − y₀ x₁ = x̄ Δy − ȳ Δx, D = x₀ x₁ + y₀ y₁, |φ| < π.
  friend Secant atan2(Secant const& y, Secant const& x) {
    double const across = x.a * y.b - y.a * x.b, along = x.a * x.b + y.a * y.b, t = across / along;
    double const turn = std::atan2(across, along), from = std::atan2(y.a, x.a);
    double const each =
        along > 0.0 && std::abs(t) < 1e-3 ? (1.0 - t * t * (1.0 / 3.0 - t * t / 5.0)) / along : turn / across;
    return {from, from + turn, (y.d * x.mean() - x.d * y.mean()) * each};
  }
  friend Secant atan(Secant const& x) { return atan2(x, Secant(1.0)); }
  friend Secant abs2(Secant const& x) { return x * x; }
  friend bool isfinite(Secant const& x) { return std::isfinite(x.a) && std::isfinite(x.b) && x.d.allFinite(); }

 private:
  /// sin(h)/h for half of the change, h = (b − a)/2.
  static double chord(Secant const& x) {
    double const half = 0.5 * x.change();
    return std::abs(half) < 1e-4 ? 1.0 - half * half / 6.0 : std::sin(half) / half;
  }
};

/// Mean of the two values of `x`. Formulas use it to choose between branches.
template <int N>
double value_of(Secant<N> const& x) {
  return x.mean();
}

}  // namespace polybody

template <int N>
struct Eigen::NumTraits<polybody::Secant<N>> : Eigen::NumTraits<double> {
  using Real = polybody::Secant<N>;
  using NonInteger = polybody::Secant<N>;
  using Nested = polybody::Secant<N>;
  enum {
    IsComplex = 0,
    IsInteger = 0,
    IsSigned = 1,
    RequireInitialization = 1,
    ReadCost = 2 + N,
    AddCost = 2 + N,
    MulCost = 2 + 2 * N
  };
};

template <int N, class BinaryOp>
struct Eigen::ScalarBinaryOpTraits<polybody::Secant<N>, double, BinaryOp> {
  using ReturnType = polybody::Secant<N>;
};
template <int N, class BinaryOp>
struct Eigen::ScalarBinaryOpTraits<double, polybody::Secant<N>, BinaryOp> {
  using ReturnType = polybody::Secant<N>;
};
