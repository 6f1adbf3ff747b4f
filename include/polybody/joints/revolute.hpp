#pragma once
#include <polybody/joints/joint_axis.hpp>

namespace polybody {

/// Revolute joint in space: two points coincide and the axis stays parallel. 5 constraint equations
///   g = [r_b − r_a; a₁·b₃; a₂·b₃]   [thesis §3.5.1, the special case of the spherical joint].
/// The second marker needs only an axis. A cable, whose markers have only a tangent, can be the second body if the
/// joint axis is along the tangent (a clamp).
struct Revolute {
  static constexpr char const* name = "Revolute";
  static constexpr int rows = 5;
  static constexpr MarkerKind needs = MarkerKind::frame;
  static constexpr MarkerKind needs_of_second = MarkerKind::axis;
  static constexpr World world = World::space;
  static constexpr bool opposite_ends = true;
  static constexpr FreeDirections free = {false, false, false, false, false, true};

  JointAxis axis = {};  ///< (3) unit vector of the joint axis, world axes at the reference configuration

  template <class = void>  // compiled only if used
  Mat3 triad() const {
    return polybody::constraint_functions::triad_about(axis, "Revolute: the axis");
  }

  template <StateScalar T>
  ConstraintTerms<5, T> constraint_function(Frame<T> const& a, Frame<T> const& b, double) const {
    ConstraintTerms<5, T> terms;
    polybody::constraint_functions::coincident(a, b, terms);
    polybody::constraint_functions::perpendicular(axis_of(a, 0), axis_of(b, 2), terms, 3);
    polybody::constraint_functions::perpendicular(axis_of(a, 1), axis_of(b, 2), terms, 4);
    return terms;
  }
  template <StateScalar T>
  Vec<T, 5> gamma(Frame<T> const& a, Frame<T> const& b, double) const {
    Vec<T, 5> gamma = detail::zeros<Vec<T, 5>>();
    gamma[3] = polybody::constraint_functions::perpendicular_gamma(axis_of(a, 0), axis_of(b, 2), a, b);
    gamma[4] = polybody::constraint_functions::perpendicular_gamma(axis_of(a, 1), axis_of(b, 2), a, b);
    return gamma;
  }
  template <class = void>  // compiled only if used
  Mat<double, 12, 12> wrench_gradient(Frame<double> const& a, Frame<double> const& b,
                                      Vec<double, 5> const& lambda) const {
    auto k = detail::zeros<Mat<double, 12, 12>>();
    polybody::constraint_functions::perpendicular_gradient(axis_of(a, 0), axis_of(b, 2), lambda[3], k);
    polybody::constraint_functions::perpendicular_gradient(axis_of(a, 1), axis_of(b, 2), lambda[4], k);
    return k;
  }
};

}  // namespace polybody
