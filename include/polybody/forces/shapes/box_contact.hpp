#pragma once
/// \file
/// Contact of a box with a sphere, a capsule and another box.
/// Theory: Eqs. 9.49, 9.51, 9.54.

#include <polybody/forces/shapes/box_core.hpp>

namespace polybody {

/// Sphere about marker a and a box about marker b, with its edges along the axes of the marker. The normal is a
/// continuous function of the position outside of the core of the box, the box without its `rounding`. Inside of the
/// core, the nearest face pushes the sphere out, and the normal jumps between faces. The sum of the radius and the
/// rounding must therefore exceed the penetration.
struct SphereOnBox {
  static constexpr MarkerKind needs = MarkerKind::point;
  static constexpr MarkerKind needs_of_second = MarkerKind::frame;
  Required<double> radius;   ///< radius of the sphere [m]
  Vec3 size = Vec3::Zero();  ///< (3) lengths of the edges of the box [m]; must be set
  double rounding = 0.0;     ///< radius of the edges and corners of the box [m]

  void check(std::string const& name) const {
    require_not_negative(radius, name, ": the sphere's radius", "m");
    detail::require_box(size, rounding, name, ": the size of the box", ": the rounding of the box");
    require_positive(radius + rounding, name, ": the sum of the sphere's radius and the rounding of the box", "m");
  }
  template <class = void>  // compiled where it is used
  bool may_touch(Frame<double> const& a, Frame<double> const& b) const {
    return detail::distance_from<double>(detail::core_of(size, rounding), place(a, b)).distance < radius + rounding;
  }
  template <class = void>  // compiled where it is used
  ContactReach reach(Frame<double> const& b) const {
    return ContactReach::sphere(b.r, radius + 0.5 * size.norm());
  }
  /// True if the sphere passes through the box on the straight path from the frames `from` to the frames `to` of a and
  /// b. A depth of at most 5 % of the sum of radius and rounding does not count.
  template <class = void>  // compiled where it is used
  bool passes(Frame<double> const (&from)[2], Frame<double> const (&to)[2]) const {
    return detail::passes_through_box(detail::core_of(size, rounding), place(from[0], from[1]), place(to[0], to[1]),
                                      radius + rounding);
  }
  template <StateScalar T, class Visit>
  void for_each_point(Frame<T> const& a, Frame<T> const& b, Visit&& visit) const {
    detail::touch_box<T>(detail::core_of(size, rounding), place<T>(a, b), radius, rounding,
                         [&](ContactPoint<T> const& p) { visit(detail::in_world<T>(p, b.r, b.A, 1.0)); });
  }

 private:
  /// Position of the sphere's centre in the axes of the box [m].
  template <StateScalar T>
  static Vec<T, 3> place(Frame<T> const& a, Frame<T> const& b) {
    Vec<T, 3> const arm = a.r - b.r;
    return detail::in_axes<T>(b.A, arm);
  }
};

/// Capsule about marker a, with its axis along the first axis of the marker, and a box about marker b, with its edges
/// along the axes of the marker. Two points share the force, as for `CapsuleOnCapsule`.
/// The sum of the capsule's radius and the rounding of the box must exceed the penetration.
struct CapsuleOnBox {
  static constexpr MarkerKind needs = MarkerKind::axis;
  static constexpr MarkerKind needs_of_second = MarkerKind::frame;
  static constexpr int most_points = 2;  ///< largest number of contact points
  Required<double> radius;               ///< radius of the capsule [m]
  Required<double> length;               ///< distance of the centres of the capsule's ends [m]
  Vec3 size = Vec3::Zero();              ///< (3) lengths of the edges of the box [m]; must be set
  double rounding = 0.0;                 ///< radius of the edges and corners of the box [m]
  Required<double> taper;                ///< loss of depth along the capsule [m]; small compared with the penetration

  void check(std::string const& name) const {
    require_not_negative(radius, name, ": the radius of the capsule", "m");
    require_not_negative(length, name, ": the length of the capsule", "m");
    detail::require_box(size, rounding, name, ": the size of the box", ": the rounding of the box");
    require_positive(radius + rounding, name, ": the sum of the capsule's radius and the rounding of the box", "m");
    require_positive(taper, name, ": the taper of the capsule", "m");
  }
  template <class = void>  // compiled where it is used
  bool may_touch(Frame<double> const& a, Frame<double> const& b) const {
    Vec3 const core = detail::core_of(size, rounding), arm = a.r - b.r, place = detail::in_axes<double>(b.A, arm),
               axis = detail::in_axes<double>(b.A, detail::axis_of<double>(a.A, 0));
    for (int i = 0; i < 3; ++i)
      if (std::abs(place[i]) - 0.5 * length * std::abs(axis[i]) >= core[i] + radius + rounding) return false;
    return true;
  }
  template <class = void>  // compiled where it is used
  ContactReach reach(Frame<double> const& b) const {
    return ContactReach::sphere(b.r, radius + 0.5 * length + 0.5 * size.norm());
  }
  template <StateScalar T, class Visit>
  void for_each_point(Frame<T> const& a, Frame<T> const& b, Visit&& visit) const {
    Vec<T, 3> const arm = a.r - b.r;
    detail::touch_box<T>(detail::core_of(size, rounding), detail::in_axes<T>(b.A, arm),
                         detail::in_axes<T>(b.A, detail::axis_of<T>(a.A, 0)),
                         {.half = 0.5 * length, .radius = radius, .rounding = rounding, .taper = taper, .share = 0.5},
                         [&](ContactPoint<T> const& p) { visit(detail::in_world<T>(p, b.r, b.A, 1.0)); });
  }
};

/// Boxes about both markers, with their edges along the axes of the markers. The edges of both boxes are rounded; the
/// sum of the two radii must exceed the penetration.
///
/// Each of the twelve edges of a touches box b like the axis of a capsule, with two points (`detail::touch_box`). Each
/// of the eight corners of b touches box a like a sphere. The potential is the sum over these points,
///   U = ¼ Σ U(d of edges) + Σ U(d of corners),
/// in which every depth d is a continuously differentiable function of the poses. So the force is continuous and
/// conservative when a corner passes over an edge, and when faces or edges become parallel.
/// A corner of a on a larger face has the stiffness k of the normal force law if the faces are aligned (4 points), and
/// up to 3/2 k if it touches alone (6 points). A corner of b has the stiffness k. Two crossing edges have k/2 (2
/// points).
struct BoxOnBox {
  static constexpr MarkerKind needs = MarkerKind::frame;
  static constexpr int most_points = 32;  ///< largest number of contact points
  Vec3 size_a = Vec3::Zero();             ///< (3) lengths of the edges of box a [m]; must be set
  Required<double> rounding_a;            ///< radius of the edges and corners of box a [m]
  Vec3 size_b = Vec3::Zero();             ///< (3) lengths of the edges of box b [m]; must be set
  Required<double> rounding_b;            ///< radius of the edges and corners of box b [m]
  Required<double> taper;                 ///< loss of depth along an edge [m]; small compared with the penetration

  void check(std::string const& name) const {
    detail::require_box(size_a, rounding_a, name, ": the size of the first box", ": the rounding of the first box");
    detail::require_box(size_b, rounding_b, name, ": the size of the second box", ": the rounding of the second box");
    require_positive(rounding_a + rounding_b, name, ": the sum of the roundings of the boxes", "m");
    require_positive(taper, name, ": the taper of the edges", "m");
  }
  template <class = void>  // compiled where it is used
  bool may_touch(Frame<double> const& a, Frame<double> const& b) const {
    return !separates(a, 0.5 * size_a, b, 0.5 * size_b) && !separates(b, 0.5 * size_b, a, 0.5 * size_a);
  }
  template <class = void>  // compiled where it is used
  ContactReach reach(Frame<double> const& b) const {
    return ContactReach::sphere(b.r, 0.5 * (size_a.norm() + size_b.norm()));
  }
  template <StateScalar T, class Visit>
  void for_each_point(Frame<T> const& a, Frame<T> const& b, Visit&& visit) const {
    Vec3 const core_a = detail::core_of(size_a, rounding_a), core_b = detail::core_of(size_b, rounding_b);
    edges<T>(a, core_a, b, core_b,
             {.half = 0.0, .radius = rounding_a, .rounding = rounding_b, .taper = taper, .share = 0.25},
             [&](ContactPoint<T> const& p) { visit(detail::in_world<T>(p, b.r, b.A, 1.0)); });
    Vec<T, 3> const arm = b.r - a.r, middle = detail::in_axes<T>(a.A, arm);
    Mat<T, 3, 3> const axes = detail::axes_in<T>(a.A, b.A);
    for (int corner = 0; corner < 8; ++corner)
      detail::touch_box<T>(core_a, detail::corner_of<T>(middle, axes, core_b, corner), rounding_b, rounding_a,
                           [&](ContactPoint<T> p) {
                             p.slot = 24 + corner;
                             visit(detail::in_world<T>(p, a.r, a.A, -1.0));
                           });
  }

 private:
  /// True if a face of box b separates the boxes; `h_a` and `h_b` are their half sizes (3) [m].
  template <class = void>
  static bool separates(Frame<double> const& a, Vec3 const& h_a, Frame<double> const& b, Vec3 const& h_b) {
    Vec3 const arm = a.r - b.r;
    for (int i = 0; i < 3; ++i) {
      Vec3 const n = detail::axis_of<double>(b.A, i);
      double reach = h_b[i];
      for (int j = 0; j < 3; ++j) reach += h_a[j] * std::abs(n.dot(detail::axis_of<double>(a.A, j)));
      if (std::abs(arm.dot(n)) >= reach) return true;
    }
    return false;
  }
  /// Points of the twelve edges of the core of box a on box b, in axes of b.
  template <StateScalar T, class Visit>
  static void edges(Frame<T> const& a, Vec3 const& h_a, Frame<T> const& b, Vec3 const& h_b, detail::SegmentOnBox shape,
                    Visit&& visit) {
    Vec<T, 3> const arm = a.r - b.r, middle = detail::in_axes<T>(b.A, arm);
    Mat<T, 3, 3> const axes = detail::axes_in<T>(b.A, a.A);
    for (int edge = 0; edge < 12; ++edge) {
      int const i = edge / 4, j = (i + 1) % 3, k = (i + 2) % 3;
      Vec3 from = Vec3::Zero();  // middle of the edge in axes of a
      from[j] = (edge & 1) ? h_a[j] : -h_a[j];
      from[k] = (edge & 2) ? h_a[k] : -h_a[k];
      Vec<T, 3> const at = detail::point_of<T>(middle, axes, from);
      shape.half = h_a[i];
      detail::touch_box<T>(h_b, at, detail::axis_of<T>(axes, i), shape, [&](ContactPoint<T> p) {
        p.slot += 2 * edge;
        visit(p);
      });
    }
  }
};

}  // namespace polybody
