#pragma once
/// \file
/// Body and reference values of a case for the law tests of bodies, and matrix functions that these tests use.

#include <algorithm>
#include <limits>
#include <span>
#include <vector>

#include <polybody/bodies/shared/bar.hpp>
#include <polybody/bodies/shared/body.hpp>

namespace polybody::laws {

/// Read access to the entries of the vector x.
template <class V>
auto view(V const& x) {
  return std::span<typename V::Scalar const>(x.data(), std::size_t(x.size()));
}
/// Write access to the entries of the vector x.
template <class V>
auto mutable_view(V& x) {
  return std::span<typename V::Scalar>(x.data(), std::size_t(x.size()));
}

/// Derivatives (coefficients of ε) in a matrix of dual numbers.
inline MatX epsilon_of(MatXOf<Dual<1>> const& m) {
  return m.unaryExpr([](Dual<1> const& x) { return x.d[0]; });
}

/// Relative difference |a − b| / max(1, |b|).
inline double mismatch(MatX const& a, MatX const& b) { return (a - b).norm() / std::max(1.0, b.norm()); }

/// Smallest entry of D in L D Lᵀ = m, without pivoting. It is positive if and only if m is positive definite.
inline double smallest_pivot(MatX m) {
  double smallest = std::numeric_limits<double>::infinity();
  for (Index k = 0; k < m.rows(); ++k) {
    smallest = std::min(smallest, m(k, k));
    for (Index i = k + 1; i < m.rows(); ++i)
      for (Index j = k + 1; j < m.rows(); ++j) m(i, j) -= m(i, k) * m(k, j) / m(k, k);
  }
  return smallest;
}

/// Case whose body is made from a Bar.
template <class Case>
concept MadeFromBar = requires { Case::body(Case::bar()); };

/// Body of a case and its reference values. For a case with a Bar, a specialisation computes the reference values.
template <class Case>
struct BodyOf {
  static auto body() { return Case::body(); }  ///< body of the case, with damping
  /// Body without damping: `Case::undamped()` if it exists, otherwise the body of the case.
  static auto undamped() {
    if constexpr (requires { Case::undamped(); })
      return Case::undamped();
    else
      return Case::body();
  }
  static double mass() { return Case::mass(); }  ///< mass given by the case [kg]
  /// (3) Centre of mass in the reference configuration, world axes [m].
  static Vec3 centre() { return Case::centre(); }
  /// Scale of the tolerances for forces: largest elastic constant of the case, or 1 if it does not define `stiffness`.
  static double stiffness() {
    if constexpr (requires { Case::stiffness; })
      return Case::stiffness;
    else
      return 1.0;
  }
};
/// Body of a case with a Bar, and reference values computed from the Bar.
template <MadeFromBar Case>
struct BodyOf<Case> {
  static auto body() { return Case::body(Case::bar()); }  ///< body made from the case's bar, with damping
  /// Body made from the case's bar, without damping.
  static auto undamped() {
    Bar bar = Case::bar();
    bar.damping = {};
    return Case::body(bar);
  }
  /// Mass of the bar [kg].
  static double mass() { return constants(Case::bar()).mass_per_length * Case::bar().length; }
  /// (3) Middle of the bar in the reference configuration, world axes [m].
  static Vec3 centre() {
    Bar const bar = Case::bar();
    return bar.placement.origin + bar.placement.axes.col(0) * (0.5 * bar.length);
  }
  /// Scale of the tolerances for forces: EA + EI of the bar.
  static double stiffness() {
    BarConstants const c = constants(Case::bar());
    return c.EA + c.EI;
  }
};

}  // namespace polybody::laws
