#pragma once
/// \file
/// Contact of boxes, capsules and convex polyhedra with a plane.
/// Theory: Eq. 9.48.

#include <vector>

#include <polybody/forces/shapes/box_core.hpp>

namespace polybody {

namespace detail {
/// Height of marker a above the plane z = 0 of marker b [m].
template <class = void>
double height_above(Frame<double> const& a, Frame<double> const& b) {
  Vec3 const arm = a.r - b.r;
  return arm.dot(axis_of<double>(b.A, 2));
}
/// Contact point of a sphere about `centre` (3) with the plane z = 0 of marker b. The depth is a smooth function of the
/// pose, and its gradient is −n. Therefore a sum of such contacts is continuous and has a potential: a corner that
/// touches first adds a force that begins at zero.
template <StateScalar T, class Visit>
void touch_plane(Vec<T, 3> const& centre, double radius, Frame<T> const& b, int slot, Visit&& visit) {
  Vec<T, 3> const arm = centre - b.r, n = axis_of<T>(b.A, 2);
  T const depth = T(radius) - arm.dot(n);
  if (!(value_of(depth) > 0.0)) return;
  ContactPoint<T> point{shifted<T>(centre, n, T(-radius)), n, depth};
  point.slot = slot;
  visit(point);
}
}  // namespace detail

/// Box about marker a, with its edges along the axes of the marker, on the plane z = 0 of marker b. Each of the eight
/// corners is a contact point with its own normal force. The corners are spheres of radius `rounding`.
struct BoxOnPlane {
  static constexpr MarkerKind needs = MarkerKind::frame;
  static constexpr int most_points = 8;  ///< largest number of contact points
  Vec3 size = Vec3::Zero();              ///< (3) lengths of the edges [m]; must be set
  double rounding = 0.0;                 ///< radius of the edges and corners [m]

  void check(std::string const& name) const {
    detail::require_box(size, rounding, name, ": the size of the box", ": the rounding of the box");
  }
  template <class = void>  // compiled where it is used
  bool may_touch(Frame<double> const& a, Frame<double> const& b) const {
    Vec3 const n = detail::axis_of<double>(b.A, 2), core = detail::core_of(size, rounding);
    double below = rounding;
    for (int i = 0; i < 3; ++i) below += core[i] * std::abs(n.dot(detail::axis_of<double>(a.A, i)));
    return detail::height_above(a, b) < below;
  }
  template <class = void>  // compiled where it is used
  ContactReach reach(Frame<double> const& b) const {
    return ContactReach::half_space(b.r, detail::axis_of<double>(b.A, 2), 0.5 * size.norm());
  }
  template <StateScalar T, class Visit>
  void for_each_point(Frame<T> const& a, Frame<T> const& b, Visit&& visit) const {
    Vec3 const core = detail::core_of(size, rounding);
    for (int corner = 0; corner < most_points; ++corner)
      detail::touch_plane<T>(detail::corner_of<T>(a.r, a.A, core, corner), rounding, b, corner, visit);
  }
};

/// Capsule about marker a, with its axis along the first axis of the marker, on the plane z = 0 of marker b. The
/// spheres at the two ends of the axis are the contact points.
struct CapsuleOnPlane {
  static constexpr MarkerKind needs = MarkerKind::axis;
  static constexpr MarkerKind needs_of_second = MarkerKind::frame;
  static constexpr int most_points = 2;  ///< largest number of contact points
  Required<double> radius;               ///< radius of the capsule [m]
  Required<double> length;               ///< distance of the centres of the two ends [m]

  void check(std::string const& name) const {
    require_not_negative(radius, name, ": the radius of the capsule", "m");
    require_not_negative(length, name, ": the length of the capsule", "m");
  }
  template <class = void>  // compiled where it is used
  bool may_touch(Frame<double> const& a, Frame<double> const& b) const {
    Vec3 const x = detail::axis_of<double>(a.A, 0);
    return detail::height_above(a, b) < radius + 0.5 * length * std::abs(x.dot(detail::axis_of<double>(b.A, 2)));
  }
  template <class = void>  // compiled where it is used
  ContactReach reach(Frame<double> const& b) const {
    return ContactReach::half_space(b.r, detail::axis_of<double>(b.A, 2), radius + 0.5 * length);
  }
  template <StateScalar T, class Visit>
  void for_each_point(Frame<T> const& a, Frame<T> const& b, Visit&& visit) const {
    for (int end = 0; end < most_points; ++end)
      detail::touch_plane<T>(detail::shifted<T>(a.r, detail::axis_of<T>(a.A, 0), T((end - 0.5) * length)), radius, b,
                             end, visit);
  }
};

/// Convex polyhedron, given by its corners, on the plane z = 0 of marker b. Each corner is a contact point. A point
/// inside of the polyhedron has no effect unless it is below the plane. \tparam most largest number of corners
template <int most = 16>
struct PolyhedronOnPlane {
  static constexpr MarkerKind needs = MarkerKind::frame;
  static constexpr int most_points = most;  ///< largest number of contact points
  std::vector<Vec3> corners = {};           ///< (3) positions in the axes of marker a [m]; must be set
  double rounding = 0.0;                    ///< radius of the spheres about the corners [m]

  void check(std::string const& name) const {
    if (corners.empty() || corners.size() > std::size_t(most))
      throw InvalidInput(
          "contact.corners",
          {ErrorObject{name}, ": the number of corners of the polyhedron must lie in [1, ", most, "], but is ",
           ErrorValue{int(corners.size())}, ". Set `corners`, or the template argument of PolyhedronOnPlane."});
    for (Vec3 const& p : corners) require_finite(p, name, ": a corner of the polyhedron", "m");
    require_not_negative(rounding, name, ": the rounding of the polyhedron", "m");
  }
  template <class = void>  // compiled where it is used
  bool may_touch(Frame<double> const& a, Frame<double> const& b) const {
    Vec3 const n = detail::in_axes<double>(a.A, detail::axis_of<double>(b.A, 2));
    double const height = detail::height_above(a, b) - rounding;
    for (Vec3 const& p : corners)
      if (height + n.dot(p) < 0.0) return true;
    return false;
  }
  template <class = void>  // compiled where it is used
  ContactReach reach(Frame<double> const& b) const {
    double far = 0.0;
    for (Vec3 const& p : corners) far = std::max(far, p.norm());
    return ContactReach::half_space(b.r, detail::axis_of<double>(b.A, 2), far + rounding);
  }
  template <StateScalar T, class Visit>
  void for_each_point(Frame<T> const& a, Frame<T> const& b, Visit&& visit) const {
    int slot = 0;
    for (Vec3 const& p : corners) detail::touch_plane<T>(detail::point_of<T>(a.r, a.A, p), rounding, b, slot++, visit);
  }
};

}  // namespace polybody
