#pragma once
/// \file
/// Contact of a capsule with a sphere and with another capsule.
/// Theory: Eqs. 9.49, 9.51.

#include <polybody/forces/shapes/box_core.hpp>

namespace polybody {

/// Capsule about marker a, with its axis along the first axis of the marker, and a sphere about marker b. If the centre
/// of the sphere is on the axis, the normal is undefined; the sum of the radii must exceed the penetration.
struct CapsuleOnSphere {
  static constexpr MarkerKind needs = MarkerKind::axis;
  static constexpr MarkerKind needs_of_second = MarkerKind::point;
  Required<double> radius;  ///< radius of the capsule [m]
  Required<double> length;  ///< distance of the centres of the capsule's ends [m]
  Required<double> sphere;  ///< radius of the sphere [m]

  void check(std::string const& name) const {
    require_not_negative(radius, name, ": the radius of the capsule", "m");
    require_not_negative(length, name, ": the length of the capsule", "m");
    require_not_negative(sphere, name, ": the radius of the sphere", "m");
    require_positive(radius + sphere, name, ": the sum of the radii of capsule and sphere", "m");
  }
  template <class = void>  // compiled where it is used
  bool may_touch(Frame<double> const& a, Frame<double> const& b) const {
    double const reach = radius + sphere;
    return distance<double>(a, b).distance < reach;
  }
  template <class = void>  // compiled where it is used
  ContactReach reach(Frame<double> const& b) const {
    return ContactReach::sphere(b.r, radius + sphere + 0.5 * length);
  }
  /// True if the sphere passes through the capsule on the straight path from the frames `from` to the frames `to` of a
  /// and b. A depth of at most 5 % of the sum of the radii does not count.
  template <class = void>  // compiled where it is used
  bool passes(Frame<double> const (&from)[2], Frame<double> const (&to)[2]) const {
    Mat3 const axes = detail::axes_about<double>(detail::axis_of<double>(from[0].A, 0));
    Vec3 const x = detail::axis_of<double>(to[0].A, 0), y = axes.col(1),
               z = x.cross(y);             // axes that turn with the axis
    if (!(z.dot(z) > 0.01)) return false;  // turned by a quarter of a turn
    Mat3 turned;
    turned << x, z.cross(x).normalized(), z.normalized();
    return detail::passes_through_box(core(), detail::in_axes<double>(axes, Vec3(from[1].r - from[0].r)),
                                      detail::in_axes<double>(turned, Vec3(to[1].r - to[0].r)), radius + sphere);
  }
  template <StateScalar T, class Visit>
  void for_each_point(Frame<T> const& a, Frame<T> const& b, Visit&& visit) const {
    detail::BoxDistance<T> const from = distance<T>(a, b);
    T const depth = T(radius + sphere) - from.distance;
    if (!(value_of(depth) > 0.0 && value_of(from.distance) > 0.0)) return;
    Vec<T, 3> const n(-from.normal[0], -from.normal[1], -from.normal[2]);
    visit(ContactPoint<T>{detail::shifted<T>(b.r, n, T(sphere.value) - depth * 0.5), n, depth});
  }

 private:
  Vec3 core() const { return {0.5 * length, 0.0, 0.0}; }
  /// Distance of the sphere's centre from the axis of the capsule; the normal is in world axes.
  template <StateScalar T>
  detail::BoxDistance<T> distance(Frame<T> const& a, Frame<T> const& b) const {
    using std::sqrt;
    Vec<T, 3> const arm = b.r - a.r, x = detail::axis_of<T>(a.A, 0);
    T s = arm.dot(x);
    if (std::abs(value_of(s)) > 0.5 * length) s = T(value_of(s) < 0.0 ? -0.5 * length : 0.5 * length);
    Vec<T, 3> const out = detail::shifted<T>(arm, x, -s);
    T const d = sqrt(out.dot(out));
    if (value_of(d) == 0.0) return {d, out};
    return {d, {out[0] / d, out[1] / d, out[2] / d}};
  }
};

/// Capsules about both markers, with their axes along the first axes of the markers. Two contact points share the
/// force, one near each end of capsule a. The radius of capsule a decreases from this end to the other end by `taper`,
/// as a parabola. If the axes are parallel, the points are at the ends of the common length. If the axes cross, both
/// points are at the crossing. Between these positions the points move continuously (`detail::touch_box`).
/// The sum of the radii must exceed the penetration.
struct CapsuleOnCapsule {
  static constexpr MarkerKind needs = MarkerKind::axis;
  static constexpr int most_points = 2;  ///< largest number of contact points
  Required<double> radius_a;             ///< radius of the capsule about marker a [m]
  Required<double> length_a;             ///< distance of the centres of its ends [m]
  Required<double> radius_b;             ///< radius of the capsule about marker b [m]
  Required<double> length_b;             ///< distance of the centres of its ends [m]
  Required<double> taper;                ///< loss of depth along capsule a [m]; small compared with the penetration

  void check(std::string const& name) const {
    require_not_negative(radius_a, name, ": the radius of the first capsule", "m");
    require_not_negative(length_a, name, ": the length of the first capsule", "m");
    require_not_negative(radius_b, name, ": the radius of the second capsule", "m");
    require_not_negative(length_b, name, ": the length of the second capsule", "m");
    require_positive(radius_a + radius_b, name, ": the sum of the radii of the capsules", "m");
    require_positive(taper, name, ": the taper of the capsules", "m");
  }
  template <class = void>  // compiled where it is used
  bool may_touch(Frame<double> const& a, Frame<double> const& b) const {
    Vec3 const line = a.r - b.r, x = detail::axis_of<double>(b.A, 0);
    double const across = 0.5 * length_a + radius_a + radius_b, along = line.dot(x), reach = across + 0.5 * length_b;
    return line.dot(line) - along * along < across * across && line.dot(line) < reach * reach;
  }
  template <class = void>  // compiled where it is used
  ContactReach reach(Frame<double> const& b) const {
    return ContactReach::sphere(b.r, radius_a + radius_b + 0.5 * (length_a + length_b));
  }
  template <StateScalar T, class Visit>
  void for_each_point(Frame<T> const& a, Frame<T> const& b, Visit&& visit) const {
    Mat<T, 3, 3> const axes = detail::axes_about<T>(detail::axis_of<T>(b.A, 0));
    Vec<T, 3> const arm = a.r - b.r;
    detail::touch_box<T>(
        {0.5 * length_b, 0.0, 0.0}, detail::in_axes<T>(axes, arm), detail::in_axes<T>(axes, detail::axis_of<T>(a.A, 0)),
        {.half = 0.5 * length_a, .radius = radius_a, .rounding = radius_b, .taper = taper, .share = 0.5},
        [&](ContactPoint<T> const& p) { visit(detail::in_world<T>(p, b.r, axes, 1.0)); });
  }
};

}  // namespace polybody
