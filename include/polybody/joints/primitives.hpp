#pragma once
/// \file
/// Primitive geometries. Several of them between the same two markers form other joints:
///   Revolute = CoincidentPoints + ParallelAxes            Universal   = CoincidentPoints + PerpendicularAxes
///   Prismatic = PointOnLine + ConstantOrientation         Weld        = CoincidentPoints + ConstantOrientation
///   Cylindrical = PointOnLine + ParallelAxes              PlanarJoint = PointInPlane + ParallelAxes
///   PointOnLine = two of PointInPlane                     ConstantOrientation = ParallelAxes + PerpendicularAxes
/// The joint on the left permits the same motion as the primitives and evaluates the frames of its markers only once.
/// [Haug 1989, §9.4]

#include <polybody/joints/constraint_functions.hpp>
#include <polybody/joints/joint_axis.hpp>
#include <polybody/joints/standard_joints.hpp>

namespace polybody {

/// The point of b stays in the plane through the point of a whose normal is fixed in a. 1 constraint equation
///   g = a₃·d,  d = r_b − r_a      [Haug 1989, §9.4].
/// In a planar model, the normal is a vector in the plane, and the point of b stays on the line perpendicular to it.
struct PointInPlane {
  static constexpr char const* name = "PointInPlane";
  static constexpr World world = World::both;
  using Equations = EquationList<NoTranslation<2>>;

  JointAxis normal = {};  ///< (3) unit vector, world axes at the reference configuration

  template <class = void>  // compiled only if used
  Mat3 triad() const {
    return polybody::constraint_functions::triad_about(normal, "PointInPlane: the normal");
  }
};

/// The point of b stays on the line through the point of a along the axis fixed in a. 2 constraint equations
///   g = [a₁·d; a₂·d],  d = r_b − r_a      [Haug 1989, §9.4].
struct PointOnLine {
  static constexpr char const* name = "PointOnLine";
  static constexpr World world = World::space;
  using Equations = EquationList<NoTranslation<0>, NoTranslation<1>>;

  JointAxis axis = {};  ///< (3) unit vector of the line, world axes at the reference configuration

  template <class = void>  // compiled only if used
  Mat3 triad() const {
    return polybody::constraint_functions::triad_about(axis, "PointOnLine: the axis");
  }
};

/// The axes of b stay parallel to the axes of a; translations are free. 3 constraint equations g = [a₁·b₂; a₂·b₃;
/// a₃·b₁].
struct ConstantOrientation {
  static constexpr char const* name = "ConstantOrientation";
  static constexpr World world = World::space;
  using Equations = EquationList<Perpendicular<0, 1>, Perpendicular<1, 2>, Perpendicular<2, 0>>;

  Mat3 triad() const { return identity(); }
};

/// Massless rod with a spherical joint at each end, in the plane and in space. 1 constraint equation
///   g = |r_b − r_a| − L      [Haug 1989, §9.4, there squared].
/// Since the distance is not squared, g is a length, λ is the tension of the rod [N], and a Penalty is a linear spring
/// for any elongation. The direction of the rod is undefined if the points coincide.
struct Distance {
  static constexpr char const* name = "Distance";
  static constexpr World world = World::both;

  Required<double> length;  ///< L [m]
  using Equations = EquationList<FixedDistance<&Distance::length>>;

  Mat3 triad() const { return identity(); }
  void check(std::string const& what) const {
    if (!(length > 0.0) || !std::isfinite(length))
      throw InvalidInput("distance.length",
                         {ErrorObject{what}, ": the length must be positive and finite, but is ", ErrorValue{length},
                          " m. For coincident points use Spherical or, in the plane, planar::Revolute."});
  }
};

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
