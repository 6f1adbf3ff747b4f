#pragma once
#include <polybody/joints/constraint_functions.hpp>

namespace polybody {

/// Rigid connection in space: points coincide and axes are parallel. 6 constraint equations
///   g = [r_b − r_a; a₁·b₂; a₂·b₃; a₃·b₁].
struct Weld {
  static constexpr char const* name = "Weld";
  static constexpr int rows = 6;
  static constexpr MarkerKind needs = MarkerKind::frame;
  static constexpr World world = World::space;
  static constexpr bool opposite_ends = true;
  static constexpr FreeDirections free = {};

  Mat3 triad() const { return identity(); }

  template <StateScalar T>
  ConstraintTerms<6, T> constraint_function(Frame<T> const& a, Frame<T> const& b, double) const {
    ConstraintTerms<6, T> terms;
    polybody::constraint_functions::coincident(a, b, terms);
    polybody::constraint_functions::parallel(a, b, terms, 3);
    return terms;
  }
  template <StateScalar T>
  Vec<T, 6> gamma(Frame<T> const& a, Frame<T> const& b, double) const {
    Vec<T, 6> gamma = detail::zeros<Vec<T, 6>>();
    Vec<T, 3> const parallel = polybody::constraint_functions::parallel_gamma(a, b);
    for (int i = 0; i < 3; ++i) gamma[3 + i] = parallel[i];
    return gamma;
  }
  template <class = void>  // compiled only if used
  Mat<double, 12, 12> wrench_gradient(Frame<double> const& a, Frame<double> const& b,
                                      Vec<double, 6> const& lambda) const {
    auto k = detail::zeros<Mat<double, 12, 12>>();
    polybody::constraint_functions::parallel_gradient(a, b, {lambda[3], lambda[4], lambda[5]}, k);
    return k;
  }
};

}  // namespace polybody
