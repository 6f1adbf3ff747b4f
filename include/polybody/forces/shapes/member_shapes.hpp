#pragma once
/// \file
/// Shapes of the members of a contact set: spheres, capsules, boxes and planes. `pair_geometry(a, b)` returns the
/// contact geometry of two shapes.

#include <polybody/forces/pair_search.hpp>
#include <polybody/forces/shapes/box_contact.hpp>
#include <polybody/forces/shapes/capsule_contact.hpp>
#include <polybody/forces/shapes/shapes_on_plane.hpp>

namespace polybody {

/// Sphere about a marker.
struct Sphere {
  static constexpr MarkerKind needs = MarkerKind::point;
  Required<double> radius;  ///< radius [m]

  void check(std::string const& name) const { require_positive(radius, name, ": the radius of the sphere", "m"); }
  /// Axis-aligned box about the sphere at the frame `at`.
  Extent extent(Frame<double> const& at) const { return Extent::about(at.r, {radius, radius, radius}); }
};

/// Capsule about a marker, with its axis along the first axis of the marker.
struct Capsule {
  static constexpr MarkerKind needs = MarkerKind::axis;
  Required<double> radius;  ///< radius [m]
  Required<double> length;  ///< distance of the centres of the two ends [m]
  Required<double> taper;   ///< loss of depth along the capsule [m]; small compared with the penetration

  void check(std::string const& name) const {
    require_positive(radius, name, ": the radius of the capsule", "m");
    require_not_negative(length, name, ": the length of the capsule", "m");
    require_positive(taper, name, ": the taper of the capsule", "m");
  }
  /// Axis-aligned box about the capsule at the frame `at`.
  Extent extent(Frame<double> const& at) const {
    Vec3 half = Vec3::Zero();
    for (int i = 0; i < 3; ++i) half[i] = radius + 0.5 * length * std::abs(at.A(i, 0));
    return Extent::about(at.r, half);
  }
};

/// Box about a marker, with its edges along the axes of the marker.
struct Box {
  static constexpr MarkerKind needs = MarkerKind::frame;
  Vec3 size = Vec3::Zero();   ///< (3) lengths of the edges [m]; must be set
  Required<double> rounding;  ///< radius of the edges and corners [m]
  Required<double> taper;     ///< loss of depth along an edge [m]; small compared with the penetration

  void check(std::string const& name) const {
    detail::require_box(size, rounding, name, ": the size of the box", ": the rounding of the box");
    require_positive(rounding, name, ": the rounding of the box", "m");
    require_positive(taper, name, ": the taper of the box", "m");
  }
  /// Axis-aligned box about the box at the frame `at`.
  Extent extent(Frame<double> const& at) const {
    Vec3 half = Vec3::Zero();
    for (int i = 0; i < 3; ++i)
      for (int k = 0; k < 3; ++k) half[i] += 0.5 * size[k] * std::abs(at.A(i, k));
    return Extent::about(at.r, half);
  }
};

/// Half space below the plane z = 0 of a marker.
struct Plane {
  static constexpr MarkerKind needs = MarkerKind::frame;
  void check(std::string const&) const {}
};

inline SphereOnSphere pair_geometry(Sphere const& a, Sphere const& b) { return {a.radius, b.radius}; }  ///< geometry
inline SphereOnPlane pair_geometry(Sphere const& a, Plane const&) { return {a.radius}; }                ///< geometry
/// Contact geometry of a sphere and a box.
inline SphereOnBox pair_geometry(Sphere const& a, Box const& b) { return {a.radius, b.size, b.rounding}; }
/// Contact geometry of a capsule and a sphere.
inline CapsuleOnSphere pair_geometry(Capsule const& a, Sphere const& b) { return {a.radius, a.length, b.radius}; }
/// Contact geometry of two capsules, with the taper of a.
inline CapsuleOnCapsule pair_geometry(Capsule const& a, Capsule const& b) {
  return {a.radius, a.length, b.radius, b.length, a.taper};
}
/// Contact geometry of a capsule and a box, with the taper of the capsule.
inline CapsuleOnBox pair_geometry(Capsule const& a, Box const& b) {
  return {a.radius, a.length, b.size, b.rounding, a.taper};
}
/// Contact geometry of a capsule and a plane.
inline CapsuleOnPlane pair_geometry(Capsule const& a, Plane const&) { return {a.radius, a.length}; }
/// Contact geometry of two boxes, with the taper of a.
inline BoxOnBox pair_geometry(Box const& a, Box const& b) { return {a.size, a.rounding, b.size, b.rounding, a.taper}; }
/// Contact geometry of a box and a plane.
inline BoxOnPlane pair_geometry(Box const& a, Plane const&) { return {a.size, a.rounding}; }

}  // namespace polybody
