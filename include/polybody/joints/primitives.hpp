#pragma once
/// \file
/// Primitive geometries. Several of them between the same two markers form other joints:
///   Revolute = CoincidentPoints + ParallelAxes            Universal   = CoincidentPoints + PerpendicularAxes
///   Prismatic = PointOnLine + ConstantOrientation         Weld        = CoincidentPoints + ConstantOrientation
///   Cylindrical = PointOnLine + ParallelAxes              PlanarJoint = PointInPlane + ParallelAxes
///   PointOnLine = two of PointInPlane                     ConstantOrientation = ParallelAxes + PerpendicularAxes
/// The named joint has the same motion and evaluates its frames only once.      [Haug 1989, §9.4]

#include <polybody/joints/constant_orientation.hpp>
#include <polybody/joints/point_in_plane.hpp>
#include <polybody/joints/point_on_line.hpp>
#include <polybody/joints/spherical.hpp>

namespace polybody {

/// Two points coincide. Alias of the spherical joint as a primitive.
using CoincidentPoints = Spherical;

/// The first axis, fixed in a, stays perpendicular to the second axis, fixed in b. 1 constraint equation g = a₁·b₃.
struct PerpendicularAxes {
  static constexpr char const* name = "PerpendicularAxes";
  static constexpr int rows = 1;
  static constexpr MarkerKind needs = MarkerKind::frame;
  static constexpr MarkerKind needs_of_second = MarkerKind::axis;
  static constexpr World world = World::space;
  static constexpr bool opposite_ends = true;

  JointAxis first = {};   ///< (3) unit vector a₁, world axes at the reference configuration
  JointAxis second = {};  ///< (3) unit vector b₃, perpendicular to `first`

  template <class = void>  // compiled only if used
  Mat3 triad() const {
    return polybody::constraint_functions::triad_of(first.required("PerpendicularAxes: the first axis"),
                                                    second.required("PerpendicularAxes: the second axis"),
                                                    "PerpendicularAxes");
  }

  template <StateScalar T>
  ConstraintTerms<1, T> constraint_function(Frame<T> const& a, Frame<T> const& b, double) const {
    ConstraintTerms<1, T> terms;
    polybody::constraint_functions::perpendicular(axis_of(a, 0), axis_of(b, 2), terms, 0);
    return terms;
  }
  template <StateScalar T>
  Vec<T, 1> gamma(Frame<T> const& a, Frame<T> const& b, double) const {
    return Vec<T, 1>(polybody::constraint_functions::perpendicular_gamma(axis_of(a, 0), axis_of(b, 2), a, b));
  }
  template <class = void>  // compiled only if used
  Mat<double, 12, 12> wrench_gradient(Frame<double> const& a, Frame<double> const& b,
                                      Vec<double, 1> const& lambda) const {
    auto k = detail::zeros<Mat<double, 12, 12>>();
    polybody::constraint_functions::perpendicular_gradient(axis_of(a, 0), axis_of(b, 2), lambda[0], k);
    return k;
  }
};

/// An axis of b stays parallel to an axis of a. 2 constraint equations g = [a₁·b₃; a₂·b₃].
struct ParallelAxes {
  static constexpr char const* name = "ParallelAxes";
  static constexpr int rows = 2;
  static constexpr MarkerKind needs = MarkerKind::frame;
  static constexpr MarkerKind needs_of_second = MarkerKind::axis;
  static constexpr World world = World::space;
  static constexpr bool opposite_ends = true;
  static constexpr FreeDirections free = {true, true, true, false, false, true};

  JointAxis axis = {};  ///< (3) unit vector, world axes at the reference configuration

  template <class = void>  // compiled only if used
  Mat3 triad() const {
    return polybody::constraint_functions::triad_about(axis, "ParallelAxes: the axis");
  }

  template <StateScalar T>
  ConstraintTerms<2, T> constraint_function(Frame<T> const& a, Frame<T> const& b, double) const {
    ConstraintTerms<2, T> terms;
    polybody::constraint_functions::same_direction(a, b, terms, 0);
    return terms;
  }
  template <StateScalar T>
  Vec<T, 2> gamma(Frame<T> const& a, Frame<T> const& b, double) const {
    return polybody::constraint_functions::same_direction_gamma(a, b);
  }
  template <class = void>  // compiled only if used
  Mat<double, 12, 12> wrench_gradient(Frame<double> const& a, Frame<double> const& b,
                                      Vec<double, 2> const& lambda) const {
    auto k = detail::zeros<Mat<double, 12, 12>>();
    polybody::constraint_functions::same_direction_gradient(a, b, lambda, k);
    return k;
  }
};

}  // namespace polybody
