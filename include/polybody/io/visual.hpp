#pragma once
/// \file
/// Visual geometry of a model in a state: shapes fixed to markers, and sections swept along bars. Closed surfaces of
/// polygons, for the display of bodies.

#include <cmath>
#include <functional>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include <polybody/bodies/shared/bar.hpp>
#include <polybody/bodies/shared/sections.hpp>
#include <polybody/joints/constraint_functions.hpp>
#include <polybody/run/marker_frames.hpp>
#include <polybody/system/make_operations.hpp>

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
  Mat3 const triad = constraint_functions::triad_about(axis, "cylinder: the axis");
  std::vector<Vec2> const ring = outline(Bar{.length = length, .section = Circle{.radius = radius}}, sides);
  Surface s = swept(2, sides);
  for (int k = 0; k < 2; ++k)
    for (int i = 0; i < sides; ++i)
      s.points[std::size_t(sides * k + i)] =
          triad * Vec3(ring[std::size_t(i)][0], ring[std::size_t(i)][1], (k - 0.5) * length);
  return s;
}

/// Capsule of `radius` [m] about a segment of `length` [m] along `axis`, with its centre at the origin, like the
/// capsules of contacts. Its section has this number of `sides`, and each end consists of `sides`/4 rings.
/// \throws InvalidInput unless the sizes are positive, `axis` is a unit vector and there are at least four sides.
template <class T = double>  // compiled where it is used
Surface capsule(double radius, double length, Vec3 const& axis = Vec3::UnitX(), int sides = 24) {
  if (sides < 4)
    throw InvalidInput("capsule.sides", {ErrorObject{"capsule"}, ": a capsule needs at least four sides, but has ",
                                         ErrorValue{sides}, "."});
  require_positive(radius, "capsule: the radius");
  require_positive(length, "capsule: the length");
  Surface const unit = cylinder<T>(1.0, 1.0, axis, sides);  // one ring of points at each end
  int const rings = sides / 4;
  Surface s = swept(2 * rings, sides);
  for (int k = 0; k < 2 * rings; ++k) {
    double const side = k < rings ? -1.0 : 1.0;
    // angle of the ring about the centre of its end, from the axis to π/2 at the segment
    double const angle = (k < rings ? k + 0.5 : 2 * rings - k - 0.5) / (rings - 0.5) * 0.5 * std::numbers::pi;
    double const along = side * (0.5 * length + radius * std::cos(angle)), out = radius * std::sin(angle);
    for (int i = 0; i < sides; ++i) {
      Vec3 const& point = unit.points[std::size_t(i)];  // at −½ along the axis
      s.points[std::size_t(sides * k + i)] = (point + 0.5 * axis) * out + along * axis;
    }
  }
  return s;
}

/// Visible part of a model in one state: a surface, the velocities and axial stresses of its points, and a frame. The
/// frame of a shape fixed to a marker is the frame of the marker. The frame of a swept bar is the frame at the middle
/// of the bar. The frame of a line is at its middle, with z along the line.
struct VisualPart {
  std::string name;                   ///< name of the part
  Surface surface;                    ///< surface in the state, world axes
  std::vector<double> axial_stress;   ///< axial stress of each point [N/m²]; empty if the body has none
  std::vector<Vec3> velocities = {};  ///< velocity of each point, world axes [m/s]
  Vec3 place = Vec3::Zero();          ///< (3) origin of the frame, world axes [m]
  Mat3 axes = Mat3::Identity();       ///< (3×3) rotation from axes of the frame to world axes
  std::vector<Vec3> carried = {};     ///< points of a fixed shape in axes of the frame [m]; empty for a bar or a line
  std::optional<World> world = {};    ///< world of the body, plane or space; empty for a part of the ground
};

namespace detail {
/// Sets position and velocity of point i of a part. The point is fixed in frame f at `point`, in axes of f.
template <class = void>
void place_point(Frame<double> const& f, Vec3 const& point, VisualPart& part, std::size_t i) {
  Vec3 const arm = f.A * point;
  part.surface.points[i] = f.r + arm;
  part.velocities[i] = f.v + f.w.cross(arm);
}
}  // namespace detail

/// Visual geometry of a model, defined once and evaluated in any state:
///   Visual visual(model);
///   visual.attach(chassis.at({0, 0, 0}), box({4, 2, 1}));   fixed to the marker's frame
///   visual.sweep(beam, bar, 20);                            the bar's section along the deformed body
///   visual.line(boom.at(8.0), load.centre(), 0.02);         a rope
///   for (VisualPart const& part : visual.at(x)) ...
/// The model must outlive this object, and must not change meanwhile.
class Visual {
 public:
  /// Geometry of a complete model, without shapes.
  template <class M>
  explicit Visual(M const& model)
      : layout_(layout_of(model)), reference_(model.reference_state()), has_shape_(layout_.bodies.size()) {}
  template <class M>
    requires(!std::same_as<M, Visual>)
  explicit Visual(M const&& model) = delete;  ///< deleted: a temporary model does not outlive the geometry

  /// Adds a shape that is fixed to a marker, under `name`. The axes of the shape are the axes of the marker.
  /// \throws InvalidInput for a marker of another model.
  template <class B>
  void attach(Marker<B> const& marker, Surface const& shape, std::string name = "shape");

  /// Adds a straight line between two markers, such as a rope or a spring, as a tube of this `radius` [m] under `name`.
  /// \throws InvalidInput for a marker of another model, or a radius that is not positive.
  template <class A, class B>
  void line(Marker<A> const& a, Marker<B> const& b, double radius, std::string name = "line") {
    draw_line(place_of(a, name), place_of(b, name), radius, name);
  }

  /// Adds the surface of the bar from which the body was made, divided into `pieces` along its length. Round sections
  /// become polygons with this number of `sides`. If the body provides points outside of its axis, the points of a
  /// section follow the displacement field of the body. Otherwise, as for cables and planar bodies, the section is
  /// rigid and fixed to the frame on the axis.
  /// \throws InvalidInput for fewer than one piece, fewer than three sides of a round section, a handle of another
  /// model, or a bar without a section.
  template <class B>
  void sweep(BodyHandle<B> const& body, Bar const& bar, int pieces, int sides = 24);

  /// Names of the bodies without a shape, in the order of the body types of the model.
  template <class = void>
  std::vector<std::string> bodies_without_shape() const {
    std::vector<std::string> names;
    for (std::size_t i = 0; i < has_shape_.size(); ++i)
      if (!has_shape_[i]) names.push_back(layout_.bodies[i].name);
    return names;
  }

  /// Reference state: the bodies are undeformed and placed as built.
  State const& reference() const { return reference_; }

  /// Returns all parts in state x. The reference is valid until the next call.
  /// \throws InvalidInput if the state is too short for the model, or if the model has changed.
  std::vector<VisualPart> const& at(State const& x) {
    layout_.watch.require_unchanged();
    for (std::size_t i = 0; i < parts_.size(); ++i) moves_[i](x, parts_[i]);
    return parts_;
  }

 private:
  /// Frame of a marker in a state, and the number of its body in the layout (−1: the ground).
  struct Place {
    Index body;
    FrameIn frame_in;
  };
  template <class B>
  Place place_of(Marker<B> const& marker, std::string const& name) const;
  /// Adds a part whose points are fixed in the axes of the frame `at`.
  template <class = void>
  void carry(Place at, Surface const& shape, std::string name);
  template <class = void>
  void draw_line(Place a, Place b, double radius, std::string const& name);
  /// Marks the last part as a part of body number `body`.
  template <class = void>
  void show(Index body) {
    parts_.back().world = layout_.bodies[std::size_t(body)].planar ? World::plane : World::space;
    has_shape_[std::size_t(body)] = true;
  }

  ModelLayout layout_;
  State reference_;
  std::vector<bool> has_shape_;  // for each body: true if it has a shape
  std::vector<VisualPart> parts_;
  std::vector<std::function<void(State const&, VisualPart&)>> moves_;
};

// Defined outside of the class: a program that links `polybody::compiled` then does not compile these functions
// again.
template <class B>
Visual::Place Visual::place_of(Marker<B> const& marker, std::string const& name) const {
  if constexpr (std::is_same_v<B, Ground>) {
    require_own(layout_, marker, name);
    Frame<double> const f{.r = marker.point.origin, .A = marker.point.axes};
    return {-1, [f](State const&) { return f; }};
  } else {
    Index const body = index_of(layout_, marker, name);
    BodyLayout const place = layout_.bodies[std::size_t(body)];
    return {body, [place, point = marker.point](State const& x) { return frame(body_in_state<B>(place, x), point); }};
  }
}

template <class B>
void Visual::attach(Marker<B> const& marker, Surface const& shape, std::string name) {
  carry(place_of(marker, name), shape, std::move(name));
}

template <class B>
void Visual::sweep(BodyHandle<B> const& body, Bar const& bar, int pieces, int sides) {
  Index const number = index_of(layout_, body);
  BodyLayout const place = layout_.bodies[std::size_t(number)];
  if (pieces < 1)
    throw InvalidInput("visual.pieces", {"\"", ErrorObject{body.name}, "\": a sweep needs at least one piece, but has ",
                                         ErrorValue{pieces}, "."});
  std::vector<Vec2> const ring = outline(bar, sides);
  int const n = int(ring.size());
  bool const stressed = HasSections<B> && bar.material;
  std::size_t const points = std::size_t((pieces + 1) * n);
  parts_.push_back(
      {body.name, swept(pieces + 1, n), std::vector<double>(stressed ? points : 0), std::vector<Vec3>(points)});
  show(number);
  moves_.push_back([place, body, bar, pieces, ring](State const& x, VisualPart& part) {
    BodyInState<B> const b = body_in_state<B>(place, x);
    Frame<double> const middle = frame(b, body.at(0.5 * bar.length).point);
    part.place = middle.r;
    part.axes = middle.A;
    std::size_t i = 0;
    for (int k = 0; k <= pieces; ++k) {
      double const s = bar.length * double(k) / double(pieces);
      Marker<B> const axis = body.at(s);
      Frame<double> const f = frame(b, axis.point);
      Vec6 forces = Vec6::Zero();
      if constexpr (HasSections<B>)
        if (!part.axial_stress.empty()) forces = b.body.section_forces(axis.point, b.q);
      for (Vec2 const& p : ring) {
        if (!part.axial_stress.empty()) part.axial_stress[i] = fibre_stress(bar, forces, p[0], p[1]);
        if constexpr (B::world == World::space && requires { body.at(s, p[0], p[1]); })
          detail::place_point(frame(b, body.at(s, p[0], p[1]).point), Vec3::Zero(), part, i++);
        else
          detail::place_point(f, Vec3(0, p[0], p[1]), part, i++);
      }
    }
  });
}

template <class>
void Visual::carry(Place at, Surface const& shape, std::string name) {
  parts_.push_back({std::move(name), shape, {}, std::vector<Vec3>(shape.points.size())});
  parts_.back().carried = shape.points;
  if (at.body >= 0) show(at.body);
  moves_.push_back([frame_in = std::move(at.frame_in)](State const& x, VisualPart& part) {
    Frame<double> const f = frame_in(x);
    part.place = f.r;
    part.axes = f.A;
    for (std::size_t i = 0; i < part.carried.size(); ++i) detail::place_point(f, part.carried[i], part, i);
  });
}

template <class>
void Visual::draw_line(Place a, Place b, double radius, std::string const& name) {
  require_positive(radius, "line \"" + name + "\": the radius", "m");
  Surface const tube = cylinder(radius, 1.0, Vec3::UnitZ(), 12);
  parts_.push_back({name, tube, {}, std::vector<Vec3>(tube.points.size())});
  for (Index const body : {a.body, b.body})
    if (body >= 0 && parts_.back().world != World::space)
      parts_.back().world = layout_.bodies[std::size_t(body)].planar ? World::plane : World::space;
  moves_.push_back([a = std::move(a.frame_in), b = std::move(b.frame_in), tube](State const& x, VisualPart& part) {
    Frame<double> const f = a(x), g = b(x);
    Vec3 const arm = g.r - f.r;
    double const length = arm.norm();
    part.place = f.r + 0.5 * arm;
    if (length > 0.0) part.axes = constraint_functions::triad_about(Vec3(arm / length), part.name);
    for (std::size_t i = 0; i < tube.points.size(); ++i) {
      Vec3 const& p = tube.points[i];
      part.surface.points[i] = part.place + part.axes * Vec3(p[0], p[1], length * p[2]);
      part.velocities[i] = p[2] < 0.0 ? f.v : g.v;
    }
  });
}

}  // namespace polybody
