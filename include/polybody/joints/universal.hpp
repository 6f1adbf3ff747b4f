#pragma once
#include <polybody/joints/joint_axis.hpp>
#include <polybody/joints/joint_motion.hpp>

namespace polybody {

/// Universal joint (Cardan joint): two points coincide, and the first axis, fixed in a, stays perpendicular to the
/// second axis, fixed in b. The axes are the arms of the cross. 4 constraint equations
///   g = [r_b − r_a; a₁·b₃]      [Haug 1989, §9.4].
struct Universal {
  static constexpr char const* name = "Universal";
  static constexpr int rows = 4;
  static constexpr MarkerKind needs = MarkerKind::frame;
  static constexpr MarkerKind needs_of_second = MarkerKind::axis;
  static constexpr World world = World::space;
  static constexpr bool opposite_ends = true;

  JointAxis first = {};   ///< (3) unit vector a₁, world axes at the reference configuration
  JointAxis second = {};  ///< (3) unit vector b₃, perpendicular to `first`

  template <class = void>  // compiled only if used
  Mat3 triad() const {
    return polybody::constraint_functions::triad_of(first.required("Universal: the first axis"),
                                                    second.required("Universal: the second axis"), "Universal");
  }
  /// Rotation about a₁, then about b₃.
  JointMotions motions() const {
    return {.list = {JointMotion{JointMotion::Kind::turn, 0}, JointMotion{JointMotion::Kind::turn, 2}}, .count = 2};
  }

  template <StateScalar T>
  ConstraintTerms<4, T> constraint_function(Frame<T> const& a, Frame<T> const& b, double) const {
    ConstraintTerms<4, T> terms;
    polybody::constraint_functions::coincident(a, b, terms);
    polybody::constraint_functions::perpendicular(axis_of(a, 0), axis_of(b, 2), terms, 3);
    return terms;
  }
  template <StateScalar T>
  Vec<T, 4> gamma(Frame<T> const& a, Frame<T> const& b, double) const {
    Vec<T, 4> gamma = detail::zeros<Vec<T, 4>>();
    gamma[3] = polybody::constraint_functions::perpendicular_gamma(axis_of(a, 0), axis_of(b, 2), a, b);
    return gamma;
  }
  template <class = void>  // compiled only if used
  Mat<double, 12, 12> wrench_gradient(Frame<double> const& a, Frame<double> const& b,
                                      Vec<double, 4> const& lambda) const {
    auto k = detail::zeros<Mat<double, 12, 12>>();
    polybody::constraint_functions::perpendicular_gradient(axis_of(a, 0), axis_of(b, 2), lambda[3], k);
    return k;
  }
};

}  // namespace polybody
