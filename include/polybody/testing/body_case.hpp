#pragma once
/// \file
/// What the laws of bodies read off a case, and the small things that they compute with.
///
/// Not in polybody.hpp: for tests.

#include <algorithm>
#include <limits>
#include <span>
#include <vector>

#include <polybody/bodies/shared/bar.hpp>
#include <polybody/bodies/shared/body.hpp>

namespace polybody::laws {

/// The entries of the vector x, to be read.
template <class V>
auto view(V const& x) {
  return std::span<typename V::Scalar const>(x.data(), std::size_t(x.size()));
}
/// The entries of the vector x, to be written.
template <class V>
auto mutable_view(V& x) {
  return std::span<typename V::Scalar>(x.data(), std::size_t(x.size()));
}

/// The ε part of a matrix of Dual<1>.
inline MatX epsilon_of(MatXOf<Dual<1>> const& m) {
  return m.unaryExpr([](Dual<1> const& x) { return x.d[0]; });
}

/// |a − b| against |b|, or against one where b is smaller.
inline double mismatch(MatX const& a, MatX const& b) { return (a - b).norm() / std::max(1.0, b.norm()); }

/// The smallest pivot of L D Lᵀ = m without exchanges: positive exactly for a positive definite matrix.
inline double smallest_pivot(MatX m) {
  double smallest = std::numeric_limits<double>::infinity();
  for (Index k = 0; k < m.rows(); ++k) {
    smallest = std::min(smallest, m(k, k));
    for (Index i = k + 1; i < m.rows(); ++i)
      for (Index j = k + 1; j < m.rows(); ++j) m(i, j) -= m(i, k) * m(k, j) / m(k, k);
  }
  return smallest;
}

/// The body of the case is made from a Bar.
template <class Case>
concept MadeFromBar = requires { Case::body(Case::bar()); };

/// What a case says of its body, with or without a Bar.
template <class Case>
struct BodyOf {
  static auto body() { return Case::body(); }  ///< the case's body, damping included
  /// The body without damping: the case's own, or the same where the case names no other.
  static auto undamped() {
    if constexpr (requires { Case::undamped(); })
      return Case::undamped();
    else
      return Case::body();
  }
  static double mass() { return Case::mass(); }  ///< mass that the case says [kg]
  /// (3) centre of mass in the reference configuration, world axes [m].
  static Vec3 centre() { return Case::centre(); }
  /// The largest elastic constant, by which errors of forces are measured; 1 where the case does not say.
  static double stiffness() {
    if constexpr (requires { Case::stiffness; })
      return Case::stiffness;
    else
      return 1.0;
  }
};
/// What a case says of a body that is made from a Bar.
template <MadeFromBar Case>
struct BodyOf<Case> {
  static auto body() { return Case::body(Case::bar()); }  ///< the body made from the case's bar, damping included
  /// The body made from the case's bar without its damping.
  static auto undamped() {
    Bar bar = Case::bar();
    bar.damping = {};
    return Case::body(bar);
  }
  /// Mass of the bar [kg].
  static double mass() { return constants(Case::bar()).mass_per_length * Case::bar().length; }
  /// (3) The bar's middle in the reference configuration, world axes [m].
  static Vec3 centre() {
    Bar const bar = Case::bar();
    return bar.placement.origin + bar.placement.axes.col(0) * (0.5 * bar.length);
  }
  /// EA + EI of the bar, by which errors of forces are measured.
  static double stiffness() {
    BarConstants const c = constants(Case::bar());
    return c.EA + c.EI;
  }
};

}  // namespace polybody::laws
