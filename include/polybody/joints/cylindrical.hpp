#pragma once
#include <polybody/joints/joint_axis.hpp>

namespace polybody {

/// Cylindrical joint: b rotates about the axis fixed in a and slides along it. 4 constraint equations
///   g = [a₁·d; a₂·d; a₁·b₃; a₂·b₃],  d = r_b − r_a      [Haug 1989, §9.4].
struct Cylindrical {
  static constexpr char const* name = "Cylindrical";
  static constexpr int rows = 4;
  static constexpr MarkerKind needs = MarkerKind::frame;
  static constexpr MarkerKind needs_of_second = MarkerKind::axis;
  static constexpr World world = World::space;
  static constexpr FreeDirections free = {false, false, true, false, false, true};

  JointAxis axis = {};  ///< (3) unit vector of translation and rotation, world axes at the reference configuration

  template <class = void>  // compiled only if used
  Mat3 triad() const {
    return polybody::constraint_functions::triad_about(axis, "Cylindrical: the axis");
  }

  template <StateScalar T>
  ConstraintTerms<4, T> constraint_function(Frame<T> const& a, Frame<T> const& b, double) const {
    ConstraintTerms<4, T> terms;
    polybody::constraint_functions::on_axis(a, b, terms, 0);
    polybody::constraint_functions::same_direction(a, b, terms, 2);
    return terms;
  }
  template <StateScalar T>
  Vec<T, 4> gamma(Frame<T> const& a, Frame<T> const& b, double) const {
    Vec<T, 2> const on_axis = polybody::constraint_functions::on_axis_gamma(a, b),
                    parallel = polybody::constraint_functions::same_direction_gamma(a, b);
    return {on_axis[0], on_axis[1], parallel[0], parallel[1]};
  }
  template <class = void>  // compiled only if used
  Mat<double, 12, 12> wrench_gradient(Frame<double> const& a, Frame<double> const& b,
                                      Vec<double, 4> const& lambda) const {
    auto k = detail::zeros<Mat<double, 12, 12>>();
    polybody::constraint_functions::on_axis_gradient(a, b, {lambda[0], lambda[1]}, k);
    polybody::constraint_functions::same_direction_gradient(a, b, {lambda[2], lambda[3]}, k);
    return k;
  }
};

}  // namespace polybody
