#pragma once
/// \file
/// Joints between two bodies in the plane.

#include <polybody/joints/constraint_functions.hpp>

namespace polybody::planar {

/// Revolute joint in the plane: two points coincide. 2 constraint equations.
struct Revolute {
  static constexpr char const* name = "planar::Revolute";
  static constexpr World world = World::plane;
  using Equations = EquationList<Coincident>;

  Mat3 triad() const { return identity(); }
};

/// Prismatic joint in the plane: b slides along the direction fixed in a without rotation. 2 constraint equations
///   g = [a₂·d; a₂·b₁],  d = r_b − r_a, a₁ the direction.
struct Prismatic {
  static constexpr char const* name = "planar::Prismatic";
  static constexpr World world = World::plane;
  using Equations = EquationList<NoTranslation<1>, Perpendicular<1, 0>>;

  Vec3 axis = Vec3::UnitX();  ///< (3) unit vector in the plane, world axes at the reference configuration

  /// \throws InvalidInput unless the direction is a unit vector in the plane.
  template <class = void>  // compiled only if used
  Mat3 triad() const {
    require_unit(axis, "planar::Prismatic: the axis");
    if (std::abs(axis.z()) > 1e-12)
      throw InvalidInput("joint.axis_out_of_plane",
                         {ErrorObject{"planar::Prismatic"},
                          ": the axis must lie in the plane, z = 0, but has z = ", ErrorValue{axis.z()}, "."});
    return polybody::constraint_functions::columns(axis, {-axis[1], axis[0], 0.0}, {0.0, 0.0, 1.0});
  }
};

/// Rigid connection in the plane: points coincide without relative rotation. 3 constraint equations
///   g = [r_b − r_a; a₂·b₁].
struct Weld {
  static constexpr char const* name = "planar::Weld";
  static constexpr World world = World::plane;
  using Equations = EquationList<Coincident, Perpendicular<1, 0>>;

  Mat3 triad() const { return identity(); }
};

}  // namespace polybody::planar
