#pragma once
#include <polybody/joints/constraint_functions.hpp>

namespace polybody::planar {

/// Rigid connection in the plane: points coincide without relative rotation. 3 constraint equations
///   g = [r_b − r_a; a₂·b₁].
struct Weld {
  static constexpr char const* name = "planar::Weld";
  static constexpr int rows = 3;
  static constexpr MarkerKind needs = MarkerKind::frame;
  static constexpr World world = World::plane;
  static constexpr bool opposite_ends = true;
  static constexpr FreeDirections free = {};

  Mat3 triad() const { return identity(); }

  template <StateScalar T>
  ConstraintTerms<3, T> constraint_function(Frame<T> const& a, Frame<T> const& b, double) const {
    ConstraintTerms<3, T> terms;
    for (int i = 0; i < 2; ++i) {
      terms.g[i] = b.r[i] - a.r[i];
      terms.Ga(i, i) = T(-1.0);
      terms.Gb(i, i) = T(1.0);
    }
    polybody::constraint_functions::perpendicular(axis_of(a, 1), axis_of(b, 0), terms, 2);
    return terms;
  }
  template <StateScalar T>
  Vec<T, 3> gamma(Frame<T> const& a, Frame<T> const& b, double) const {
    Vec<T, 3> gamma = detail::zeros<Vec<T, 3>>();
    gamma[2] = polybody::constraint_functions::perpendicular_gamma(axis_of(a, 1), axis_of(b, 0), a, b);
    return gamma;
  }
  template <class = void>  // compiled only if used
  Mat<double, 12, 12> wrench_gradient(Frame<double> const& a, Frame<double> const& b,
                                      Vec<double, 3> const& lambda) const {
    auto k = detail::zeros<Mat<double, 12, 12>>();
    polybody::constraint_functions::perpendicular_gradient(axis_of(a, 1), axis_of(b, 0), lambda[2], k);
    return k;
  }
};

}  // namespace polybody::planar
