#pragma once
#include <polybody/joints/joint_axis.hpp>

namespace polybody {

/// Planar joint in space: a plane of b slides and rotates on a plane of a. 3 constraint equations
///   g = [a₃·d; a₁·b₃; a₂·b₃],  d = r_b − r_a      [Haug 1989, §9.4].
/// The name is not `Planar`, because namespace `planar` contains the bodies and joints in the plane.
struct PlanarJoint {
  static constexpr char const* name = "PlanarJoint";
  static constexpr int rows = 3;
  static constexpr MarkerKind needs = MarkerKind::frame;
  static constexpr MarkerKind needs_of_second = MarkerKind::axis;
  static constexpr World world = World::space;
  static constexpr FreeDirections free = {true, true, false, false, false, true};

  JointAxis normal = {};  ///< (3) unit vector, world axes at the reference configuration

  template <class = void>  // compiled only if used
  Mat3 triad() const {
    return polybody::constraint_functions::triad_about(normal, "PlanarJoint: the normal");
  }

  template <StateScalar T>
  ConstraintTerms<3, T> constraint_function(Frame<T> const& a, Frame<T> const& b, double) const {
    ConstraintTerms<3, T> terms;
    polybody::constraint_functions::no_slide(axis_of(a, 2), a, b, terms, 0);
    polybody::constraint_functions::same_direction(a, b, terms, 1);
    return terms;
  }
  template <StateScalar T>
  Vec<T, 3> gamma(Frame<T> const& a, Frame<T> const& b, double) const {
    Vec<T, 2> const parallel = polybody::constraint_functions::same_direction_gamma(a, b);
    return {polybody::constraint_functions::no_slide_gamma(axis_of(a, 2), a, b), parallel[0], parallel[1]};
  }
  template <class = void>  // compiled only if used
  Mat<double, 12, 12> wrench_gradient(Frame<double> const& a, Frame<double> const& b,
                                      Vec<double, 3> const& lambda) const {
    auto k = detail::zeros<Mat<double, 12, 12>>();
    polybody::constraint_functions::no_slide_gradient(axis_of(a, 2), a, b, lambda[0], k);
    polybody::constraint_functions::same_direction_gradient(a, b, {lambda[1], lambda[2]}, k);
    return k;
  }
};

}  // namespace polybody
