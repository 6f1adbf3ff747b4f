#pragma once
/// \file
/// Where a marker may be for a contact to act on it: a test of a few products, the same for all contacts, so that many
/// markers are tested side by side.

#include <concepts>

#include <polybody/kinematics/frame.hpp>

namespace polybody {

/// A contact touches no first marker whose place is d from `origin` where
///   squared |d|² + along_squared (d·axis)² + along d·axis ≥ limit.
/// All limits leave room for rounding.
struct ContactReach {
  Vec3 origin = Vec3::Zero();  ///< (3), in world axes [m]
  Vec3 axis = Vec3::UnitZ();   ///< (3), a unit vector in world axes
  double squared = 0.0;        ///< a factor
  double along_squared = 0.0;  ///< a factor
  double along = 0.0;          ///< [m], or a factor where the others are zero
  double limit = 0.0;          ///< [m²], or [m]

  /// Within a sphere of this radius about `origin` [m].
  static ContactReach sphere(Vec3 const& origin, double radius) {
    return {.origin = origin, .squared = 1.0 - room, .limit = radius * radius};
  }
  /// Within a cylinder without ends, of this radius about `axis` through `origin` [m].
  static ContactReach cylinder(Vec3 const& origin, Vec3 const& axis, double radius) {
    return {.origin = origin, .axis = axis, .squared = 1.0 - room, .along_squared = -1.0, .limit = radius * radius};
  }
  /// Lower than this height along `axis` from `origin` [m].
  static ContactReach half_space(Vec3 const& origin, Vec3 const& axis, double height) {
    return {.origin = origin, .axis = axis, .squared = -room, .along = 1.0, .limit = height + room};
  }

  /// Whether a marker at r (3) [m] may be touched.
  bool holds(Vec3 const& r) const { return holds(r[0], r[1], r[2]); }
  /// The same at (x, y, z) [m]; what is no number may be anywhere.
  bool holds(double x, double y, double z) const {
    double const dx = x - origin[0], dy = y - origin[1], dz = z - origin[2];
    double const c = dx * axis[0] + dy * axis[1] + dz * axis[2];
    return !(squared * (dx * dx + dy * dy + dz * dz) + c * (along_squared * c + along) >= limit);
  }

 private:
  static constexpr double room = 1e-9;
};

/// A contact, or its geometry, that tells its reach by the frame of its second marker: `may_touch` is false beyond it.
template <class G>
concept TellsReach = requires(G const geometry, Frame<double> const second) {
  { geometry.reach(second) } -> std::same_as<ContactReach>;
};

}  // namespace polybody
