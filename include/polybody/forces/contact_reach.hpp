#pragma once
/// \file
/// Region in which a contact can act on a marker. The test of a region is the same for all contacts and vectorises over
/// many markers.
/// Theory: Eq. 8.14.

#include <concepts>

#include <polybody/kinematics/frame.hpp>

namespace polybody {

/// Quadratic region of possible contact. A contact does not touch a marker at the vector d from `origin` if
///   squared |d|² + along_squared (d·axis)² + along d·axis ≥ limit.
/// A margin for round-off enlarges all regions.
struct ContactReach {
  Vec3 origin = Vec3::Zero();  ///< (3) origin of d, world axes [m]
  Vec3 axis = Vec3::UnitZ();   ///< (3) unit vector, world axes
  double squared = 0.0;        ///< coefficient of |d|² [1]; [1/m] for a half space
  double along_squared = 0.0;  ///< coefficient of (d·axis)² [1]
  double along = 0.0;          ///< coefficient of d·axis [m]; [1] for a half space
  double limit = 0.0;          ///< limit [m²]; [m] for a half space

  /// Sphere of radius `radius` [m] about `origin`.
  static ContactReach sphere(Vec3 const& origin, double radius) {
    return {.origin = origin, .squared = 1.0 - margin, .limit = radius * radius};
  }
  /// Infinite cylinder of radius `radius` [m] about the `axis` through `origin`.
  static ContactReach cylinder(Vec3 const& origin, Vec3 const& axis, double radius) {
    return {.origin = origin, .axis = axis, .squared = 1.0 - margin, .along_squared = -1.0, .limit = radius * radius};
  }
  /// Half space below the height `height` [m] along `axis` from `origin`.
  static ContactReach half_space(Vec3 const& origin, Vec3 const& axis, double height) {
    return {.origin = origin, .axis = axis, .squared = -margin, .along = 1.0, .limit = height + margin};
  }

  /// True if the contact may touch a marker at r (3) [m].
  bool holds(Vec3 const& r) const { return holds(r[0], r[1], r[2]); }
  /// True if the contact may touch a marker at (x, y, z) [m], or if a coordinate is NaN.
  bool holds(double x, double y, double z) const {
    double const dx = x - origin[0], dy = y - origin[1], dz = z - origin[2];
    double const c = dx * axis[0] + dy * axis[1] + dz * axis[2];
    return !(squared * (dx * dx + dy * dy + dz * dz) + c * (along_squared * c + along) >= limit);
  }

 private:
  static constexpr double margin = 1e-9;
};

/// Contact or contact geometry with a reach, as a function of the frame of its second marker. `may_touch` is false
/// beyond the reach.
template <class G>
concept HasReach = requires(G const geometry, Frame<double> const second) {
  { geometry.reach(second) } -> std::same_as<ContactReach>;
};

}  // namespace polybody
