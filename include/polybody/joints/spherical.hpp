#pragma once
#include <polybody/joints/constraint_functions.hpp>

namespace polybody {

/// Spherical joint in space: two points coincide. 3 constraint equations in world axes.
struct Spherical {
  static constexpr char const* name = "Spherical";
  static constexpr int rows = 3;
  static constexpr MarkerKind needs = MarkerKind::point;
  static constexpr World world = World::space;
  static constexpr bool opposite_ends = true;
  static constexpr FreeDirections free = {false, false, false, true, true, true};

  Mat3 triad() const { return identity(); }

  template <StateScalar T>
  ConstraintTerms<3, T> constraint_function(Frame<T> const& a, Frame<T> const& b, double) const {
    ConstraintTerms<3, T> terms;
    polybody::constraint_functions::coincident(a, b, terms);
    return terms;
  }
  template <StateScalar T>
  Vec<T, 3> gamma(Frame<T> const&, Frame<T> const&, double) const {
    return detail::zeros<Vec<T, 3>>();
  }
  template <class = void>  // compiled only if used
  Mat<double, 12, 12> wrench_gradient(Frame<double> const&, Frame<double> const&, Vec<double, 3> const&) const {
    return detail::zeros<Mat<double, 12, 12>>();
  }
};

}  // namespace polybody
