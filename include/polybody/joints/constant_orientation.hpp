#pragma once
#include <polybody/joints/constraint_functions.hpp>

namespace polybody {

/// The axes of b stay parallel to the axes of a; translations are free. 3 constraint equations g = [a₁·b₂; a₂·b₃;
/// a₃·b₁].
struct ConstantOrientation {
  static constexpr char const* name = "ConstantOrientation";
  static constexpr int rows = 3;
  static constexpr MarkerKind needs = MarkerKind::frame;
  static constexpr World world = World::space;
  static constexpr bool opposite_ends = true;
  static constexpr FreeDirections free = {true, true, true};

  Mat3 triad() const { return identity(); }

  template <StateScalar T>
  ConstraintTerms<3, T> constraint_function(Frame<T> const& a, Frame<T> const& b, double) const {
    ConstraintTerms<3, T> terms;
    polybody::constraint_functions::parallel(a, b, terms, 0);
    return terms;
  }
  template <StateScalar T>
  Vec<T, 3> gamma(Frame<T> const& a, Frame<T> const& b, double) const {
    return polybody::constraint_functions::parallel_gamma(a, b);
  }
  template <class = void>  // compiled only if used
  Mat<double, 12, 12> wrench_gradient(Frame<double> const& a, Frame<double> const& b,
                                      Vec<double, 3> const& lambda) const {
    auto k = detail::zeros<Mat<double, 12, 12>>();
    polybody::constraint_functions::parallel_gradient(a, b, lambda, k);
    return k;
  }
};

}  // namespace polybody
