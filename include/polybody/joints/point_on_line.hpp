#pragma once
#include <polybody/joints/joint_axis.hpp>

namespace polybody {

/// The point of b stays on the line through the point of a along the axis fixed in a. 2 constraint equations
///   g = [a₁·d; a₂·d],  d = r_b − r_a      [Haug 1989, §9.4].
struct PointOnLine {
  static constexpr char const* name = "PointOnLine";
  static constexpr int rows = 2;
  static constexpr MarkerKind needs = MarkerKind::frame;
  static constexpr MarkerKind needs_of_second = MarkerKind::point;
  static constexpr World world = World::space;
  static constexpr FreeDirections free = {false, false, true, true, true, true};

  JointAxis axis = {};  ///< (3) unit vector of the line, world axes at the reference configuration

  template <class = void>  // compiled only if used
  Mat3 triad() const {
    return polybody::constraint_functions::triad_about(axis, "PointOnLine: the axis");
  }

  template <StateScalar T>
  ConstraintTerms<2, T> constraint_function(Frame<T> const& a, Frame<T> const& b, double) const {
    ConstraintTerms<2, T> terms;
    polybody::constraint_functions::on_axis(a, b, terms, 0);
    return terms;
  }
  template <StateScalar T>
  Vec<T, 2> gamma(Frame<T> const& a, Frame<T> const& b, double) const {
    return polybody::constraint_functions::on_axis_gamma(a, b);
  }
  template <class = void>  // compiled only if used
  Mat<double, 12, 12> wrench_gradient(Frame<double> const& a, Frame<double> const& b,
                                      Vec<double, 2> const& lambda) const {
    auto k = detail::zeros<Mat<double, 12, 12>>();
    polybody::constraint_functions::on_axis_gradient(a, b, lambda, k);
    return k;
  }
};

}  // namespace polybody
