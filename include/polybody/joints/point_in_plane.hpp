#pragma once
#include <polybody/joints/joint_axis.hpp>

namespace polybody {

/// The point of b stays in the plane through the point of a whose normal is fixed in a. 1 constraint equation
///   g = a₃·d,  d = r_b − r_a      [Haug 1989, §9.4].
/// World::both: in the plane, the normal is a vector in the plane, and the point stays on the line perpendicular to it.
struct PointInPlane {
  static constexpr char const* name = "PointInPlane";
  static constexpr int rows = 1;
  static constexpr MarkerKind needs = MarkerKind::frame;
  static constexpr MarkerKind needs_of_second = MarkerKind::point;
  static constexpr World world = World::both;
  static constexpr FreeDirections free = {true, true, false, true, true, true};

  JointAxis normal = {};  ///< (3) unit vector, world axes at the reference configuration

  template <class = void>  // compiled only if used
  Mat3 triad() const {
    return polybody::constraint_functions::triad_about(normal, "PointInPlane: the normal");
  }

  template <StateScalar T>
  ConstraintTerms<1, T> constraint_function(Frame<T> const& a, Frame<T> const& b, double) const {
    ConstraintTerms<1, T> terms;
    polybody::constraint_functions::no_slide(axis_of(a, 2), a, b, terms, 0);
    return terms;
  }
  template <StateScalar T>
  Vec<T, 1> gamma(Frame<T> const& a, Frame<T> const& b, double) const {
    return Vec<T, 1>(polybody::constraint_functions::no_slide_gamma(axis_of(a, 2), a, b));
  }
  template <class = void>  // compiled only if used
  Mat<double, 12, 12> wrench_gradient(Frame<double> const& a, Frame<double> const& b,
                                      Vec<double, 1> const& lambda) const {
    auto k = detail::zeros<Mat<double, 12, 12>>();
    polybody::constraint_functions::no_slide_gradient(axis_of(a, 2), a, b, lambda[0], k);
    return k;
  }
};

}  // namespace polybody
