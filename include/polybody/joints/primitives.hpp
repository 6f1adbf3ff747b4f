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
  static constexpr World world = World::space;
  using Equations = EquationList<Perpendicular<0, 2>>;

  JointAxis first = {};   ///< (3) unit vector a₁, world axes at the reference configuration
  JointAxis second = {};  ///< (3) unit vector b₃, perpendicular to `first`

  template <class = void>  // compiled only if used
  Mat3 triad() const {
    return polybody::constraint_functions::triad_of(first.required("PerpendicularAxes: the first axis"),
                                                    second.required("PerpendicularAxes: the second axis"),
                                                    "PerpendicularAxes");
  }
};

/// An axis of b stays parallel to an axis of a. 2 constraint equations g = [a₁·b₃; a₂·b₃].
struct ParallelAxes {
  static constexpr char const* name = "ParallelAxes";
  static constexpr World world = World::space;
  using Equations = EquationList<Perpendicular<0, 2>, Perpendicular<1, 2>>;

  JointAxis axis = {};  ///< (3) unit vector, world axes at the reference configuration

  template <class = void>  // compiled only if used
  Mat3 triad() const {
    return polybody::constraint_functions::triad_about(axis, "ParallelAxes: the axis");
  }
};

}  // namespace polybody
