#pragma once
/// \file
/// Frames and wrenches of markers, through which bodies exchange data with joints and forces, and placements of bodies.
/// Theory: Eqs. 1.3, 1.5.

#include <polybody/math/quaternion.hpp>

namespace polybody {

/// Position, orientation and velocity of a marker, all in world axes.
template <StateScalar T = double>
struct Frame {
  Vec<T, 3> r = Vec<T, 3>::Zero();  ///< (3) origin [m]
  Mat<T, 3, 3> A = identity<T>();   ///< (3×3) columns are the marker's axes in world axes
  Vec<T, 3> v = Vec<T, 3>::Zero();  ///< (3) velocity of the origin [m/s]
  Vec<T, 3> w = Vec<T, 3>::Zero();  ///< (3) angular velocity [rad/s]
};

/// Frame `x` without derivatives.
template <StateScalar T>
Frame<double> values_of(Frame<T> const& x) {
  return {values_of(x.r), values_of(x.A), values_of(x.v), values_of(x.w)};
}

/// Force and moment about the origin of a marker, in world axes.
template <StateScalar T = double>
struct Wrench {
  Vec<T, 3> f = Vec<T, 3>::Zero();  ///< (3) force [N]
  Vec<T, 3> m = Vec<T, 3>::Zero();  ///< (3) moment about the origin of the frame [N m]
};

/// Wrench with its point of action.
struct PlacedWrench {
  Vec3 at = Vec3::Zero();  ///< (3) point of action [m]
  Wrench<double> w;        ///< force, and moment about `at`
};

/// Kinematics that a marker provides: a point, a point and its first axis, or a full frame.
enum class MarkerKind { point, axis, frame };

/// Dimension of a body: plane or space. A joint connects bodies of equal dimension; the ground has both dimensions.
enum class World { plane, space, both };

/// True if bodies of the dimensions a and b can be connected: both plane, both space, or one of them the ground.
constexpr bool same_world(World a, World b) { return a == b || a == World::both || b == World::both; }

/// Initial position and orientation of a body in the world.
struct Placement {
  Vec3 origin = Vec3::Zero();  ///< (3) position of the origin [m]
  Mat3 axes = identity();      ///< (3×3) columns are the body's axes in world axes

  /// Placement in the plane: origin (x, y) [m] and `angle` from world x to body x [rad].
  template <class = void>  // compiled where it is used
  static Placement planar(double x, double y, double angle = 0.0) {
    return {Vec3(x, y, 0.0), exp_so3<double>(Vec3(0.0, 0.0, angle))};
  }
  /// Placement at `origin` (3), world axes [m], rotated by the rotation vector `rotation` (3) [rad].
  template <class = void>  // compiled where it is used
  static Placement at(Vec3 const& origin, Vec3 const& rotation = Vec3::Zero()) {
    return {origin, exp_so3<double>(rotation)};
  }

  /// Checks the placement.
  /// \throws InvalidInput naming `what` unless the coordinates of the origin have magnitudes up to `largest_number`,
  /// and the axes are right-handed and orthonormal to 1e-9.
  template <class = void>  // compiled where it is used
  void check(std::string const& what) const {
    require_finite(origin, what, ": the placement's origin");
    for (int i = 0; i < 3; ++i)
      if (std::abs(origin[i]) > largest_number)
        throw InvalidInput("value.magnitude",
                           {ErrorObject{what}, ": the placement's origin has a coordinate of ", ErrorValue{origin[i]},
                            " m, beyond ", largest_number, " m, the largest allowed magnitude."});
    require_finite(axes, what, ": the placement's axes");
    double off = 0.0, determinant = 0.0;  // off: |AᵀA − 1|²
    for (int i = 0; i < 3; ++i) {
      int const j = (i + 1) % 3, k = (i + 2) % 3;
      determinant += axes(i, 0) * (axes(j, 1) * axes(k, 2) - axes(k, 1) * axes(j, 2));
      for (int n = 0; n < 3; ++n) {
        double const dot = axes(0, i) * axes(0, n) + axes(1, i) * axes(1, n) + axes(2, i) * axes(2, n);
        off += (i == n ? dot - 1.0 : dot) * (i == n ? dot - 1.0 : dot);
      }
    }
    if (std::sqrt(off) > 1e-9 || determinant < 0.0)
      throw InvalidInput(
          "placement.axes",
          {ErrorObject{what}, ": the placement's axes must be orthonormal and right-handed, but |A'A - 1| is ",
           ErrorValue{std::sqrt(off)}, " (limit: 1e-9) and the determinant is ", determinant,
           " (required: 1). Normalise the columns and make them orthogonal; if the determinant is negative, reverse "
           "one."});
  }

  /// Angle about world z of a planar placement [rad].
  /// \throws InvalidInput if the origin is not in the plane z = 0, or if the axes are rotated about another axis than
  /// z.
  template <class = void>  // compiled where it is used
  double planar_angle(std::string const& what) const {
    check(what);
    if (std::abs(origin.z()) > 1e-12 || std::abs(axes(2, 2) - 1.0) > 1e-12)
      throw InvalidInput("placement.out_of_plane",
                         {ErrorObject{what},
                          ": a planar body must lie in the plane z = 0 and may rotate about z only, but its origin "
                          "has z = ",
                          ErrorValue{origin.z()}, " m, and its third axis has z = ", axes(2, 2), "."});
    return std::atan2(axes(1, 0), axes(0, 0));
  }
};

}  // namespace polybody
