#pragma once
#include <polybody/joints/constraint_functions.hpp>

namespace polybody::planar {

/// Revolute joint in the plane: two points coincide. 2 constraint equations.
struct Revolute {
  static constexpr char const* name = "planar::Revolute";
  static constexpr int rows = 2;
  static constexpr MarkerKind needs = MarkerKind::point;
  static constexpr World world = World::plane;
  static constexpr bool opposite_ends = true;
  static constexpr FreeDirections free = {false, false, false, false, false, true};

  Mat3 triad() const { return identity(); }

  template <StateScalar T>
  ConstraintTerms<2, T> constraint_function(Frame<T> const& a, Frame<T> const& b, double) const {
    ConstraintTerms<2, T> terms;
    for (int i = 0; i < 2; ++i) {
      terms.g[i] = b.r[i] - a.r[i];
      terms.Ga(i, i) = T(-1.0);
      terms.Gb(i, i) = T(1.0);
    }
    return terms;
  }
  template <StateScalar T>
  Vec<T, 2> gamma(Frame<T> const&, Frame<T> const&, double) const {
    return detail::zeros<Vec<T, 2>>();
  }
  template <class = void>  // compiled only if used
  Mat<double, 12, 12> wrench_gradient(Frame<double> const&, Frame<double> const&, Vec<double, 2> const&) const {
    return detail::zeros<Mat<double, 12, 12>>();
  }
};

}  // namespace polybody::planar
