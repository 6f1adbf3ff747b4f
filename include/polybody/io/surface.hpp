#pragma once
/// \file
/// Closed surfaces of polygons, for the display of bodies.

#include <cmath>
#include <numbers>
#include <vector>

#include <polybody/bodies/shared/bar.hpp>

namespace polybody {

/// Surface of polygons. The corners of polygon i are the entries [ends[i − 1], ends[i]) of `corners`, with 0 instead of
/// ends[−1]. These entries are indices of `points`. The corners of a polygon are listed counter-clockwise as seen from
/// outside.
struct Surface {
  std::vector<Vec3> points;  ///< positions of the points [m]
  std::vector<int> corners;  ///< indices of `points`
  std::vector<int> ends;     ///< for each polygon, the index after its last corner

  /// Adds a polygon; `of_points` are the indices of its corners in `points`.
  void add_polygon(std::vector<int> const& of_points) {
    corners.insert(corners.end(), of_points.begin(), of_points.end());
    ends.push_back(int(corners.size()));
  }
};

/// Volume inside a closed surface [m³]: Σ p₀·(p_i × p_{i+1})/6 over the triangles (p₀, p_i, p_{i+1}) of the polygons.
template <class = void>
double volume(Surface const& surface) {
  double six = 0.0;
  int begin = 0;
  for (int const end : surface.ends) {
    auto const corner = [&](int k) -> Vec3 const& {
      return surface.points[std::size_t(surface.corners[std::size_t(k)])];
    };
    for (int k = begin + 1; k + 1 < end; ++k) six += corner(begin).dot(corner(k).cross(corner(k + 1)));
    begin = end;
  }
  return six / 6.0;
}

/// Outline of a bar's section as a polygon (y, z) [m], counter-clockwise as seen from +x. A circle becomes a polygon of
/// the same area with this number of `sides`.
/// \throws InvalidInput for a bar without a section, or fewer than three sides of a circle.
template <class = void>
std::vector<Vec2> outline(Bar const& bar, int sides = 24) {
  if (auto const* r = std::get_if<Rectangle>(&bar.section)) {
    double const y = 0.5 * r->height, z = 0.5 * r->width;
    return {Vec2(y, z), Vec2(-y, z), Vec2(-y, -z), Vec2(y, -z)};
  }
  if (sides < 3)
    throw InvalidInput("outline.sides", {ErrorObject{"outline"}, ": a circle needs at least three sides, but has ",
                                         ErrorValue{sides}, "."});
  auto const* c = std::get_if<Circle>(&bar.section);
  if (!c)
    throw InvalidInput(
        "bar.no_section",
        {ErrorObject{"outline"},
         ": the bar has no section. Define the bar by `section`, a Rectangle or a Circle, and `material`, not by "
         "`constants`."});
  double const step = 2.0 * std::numbers::pi / sides, radius = c->radius * std::sqrt(step / std::sin(step));
  std::vector<Vec2> points;
  for (int i = 0; i < sides; ++i) points.emplace_back(radius * std::cos(i * step), radius * std::sin(i * step));
  return points;
}

/// Polygons of a surface through `rings` rings of points; the first and the last ring are its end faces. Each ring has
/// `points_of_ring` points, counter-clockwise about the direction of the sweep. Point i of ring k has the index i +
/// k·`points_of_ring`. All points are at the origin; the caller moves them.
template <class = void>
Surface swept(int rings, int points_of_ring) {
  Surface s;
  s.points.assign(std::size_t(rings * points_of_ring), Vec3::Zero());
  std::vector<int> first, last;
  for (int i = 0; i < points_of_ring; ++i) {
    first.push_back(points_of_ring - 1 - i);
    last.push_back((rings - 1) * points_of_ring + i);
  }
  s.add_polygon(first);
  s.add_polygon(last);
  for (int k = 0; k + 1 < rings; ++k)
    for (int i = 0; i < points_of_ring; ++i) {
      int const next = (i + 1) % points_of_ring, here = k * points_of_ring, there = here + points_of_ring;
      s.add_polygon({here + i, here + next, there + next, there + i});
    }
  return s;
}

/// Box of this `size` (3) along the axes [m], with its centre at the origin.
/// \throws InvalidInput unless the sizes are positive.
template <class = void>
Surface box(Vec3 const& size) {
  for (int i = 0; i < 3; ++i) require_positive(size[i], "box: the size");
  Surface s = swept(2, 4);
  Vec2 const at[] = {{0.5, 0.5}, {-0.5, 0.5}, {-0.5, -0.5}, {0.5, -0.5}};
  for (int k = 0; k < 2; ++k)
    for (int i = 0; i < 4; ++i)
      s.points[std::size_t(4 * k + i)] = {(k - 0.5) * size[0], at[i][0] * size[1], at[i][1] * size[2]};
  return s;
}

/// Cylinder of `radius` and `length` [m] along `axis`, with its centre at the origin, approximated by a prism of the
/// same volume with this number of `sides`.
/// \throws InvalidInput unless the sizes are positive, `axis` is a unit vector and there are at least three sides.
template <class T = double>  // compiled where it is used
Surface cylinder(double radius, double length, Vec3 const& axis = Vec3::UnitX(), int sides = 24) {
  require_positive(radius, "cylinder: the radius");
  require_positive(length, "cylinder: the length");
  require_unit(axis, "cylinder: the axis");
  std::vector<Vec2> const ring = outline(Bar{.length = length, .section = Circle{.radius = radius}}, sides);
  int smallest = 0;
  for (int i = 1; i < 3; ++i)
    if (std::abs(axis[i]) < std::abs(axis[smallest])) smallest = i;
  Vec<T, 3> const x = axis, y = x.cross(Vec<T, 3>::Unit(smallest)).normalized(), z = x.cross(y);
  Surface s = swept(2, sides);
  for (int k = 0; k < 2; ++k)
    for (int i = 0; i < sides; ++i)
      s.points[std::size_t(sides * k + i)] =
          x * ((k - 0.5) * length) + y * ring[std::size_t(i)][0] + z * ring[std::size_t(i)][1];
  return s;
}

}  // namespace polybody
