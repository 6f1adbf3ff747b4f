#pragma once
/// \file
/// Visual geometry of a model in a state: shapes fixed to markers, and sections swept along bars.

#include <functional>
#include <optional>
#include <string>

#include <polybody/bodies/shared/sections.hpp>
#include <polybody/io/surface.hpp>
#include <polybody/run/marker_frames.hpp>
#include <polybody/system/make_operations.hpp>

namespace polybody {

/// Visible part of a model in one state: a surface, the velocities and axial stresses of its points, and a frame. The
/// frame of a shape fixed to a marker is the frame of the marker. The frame of a swept bar is the frame at the middle
/// of the bar.
struct VisualPart {
  std::string name;                   ///< name of the part
  Surface surface;                    ///< surface in the state, world axes
  std::vector<double> axial_stress;   ///< axial stress of each point [N/m²]; empty if the body has none
  std::vector<Vec3> velocities = {};  ///< velocity of each point, world axes [m/s]
  Vec3 place = Vec3::Zero();          ///< (3) origin of the frame, world axes [m]
  Mat3 axes = Mat3::Identity();       ///< (3×3) rotation from axes of the frame to world axes
  std::vector<Vec3> carried = {};     ///< points of a fixed shape in axes of the frame [m]; empty for a bar
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
  /// Adds a part whose points are fixed in the axes of a frame, to body number `body` of the layout (−1: the ground).
  template <class = void>
  void carry(Index body, Surface const& shape, std::string name, FrameIn frame_in);
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
void Visual::attach(Marker<B> const& marker, Surface const& shape, std::string name) {
  if constexpr (std::is_same_v<B, Ground>) {
    require_own(layout_, marker, name);
    Frame<double> const f{.r = marker.point.origin, .A = marker.point.axes};
    carry(-1, shape, std::move(name), [f](State const&) { return f; });
  } else {
    Index const body = index_of(layout_, marker, name);
    BodyLayout const place = layout_.bodies[std::size_t(body)];
    carry(body, shape, std::move(name),
          [place, point = marker.point](State const& x) { return frame(body_in_state<B>(place, x), point); });
  }
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
void Visual::carry(Index body, Surface const& shape, std::string name, FrameIn frame_in) {
  parts_.push_back({std::move(name), shape, {}, std::vector<Vec3>(shape.points.size())});
  parts_.back().carried = shape.points;
  if (body >= 0) show(body);
  moves_.push_back([frame_in = std::move(frame_in)](State const& x, VisualPart& part) {
    Frame<double> const f = frame_in(x);
    part.place = f.r;
    part.axes = f.A;
    for (std::size_t i = 0; i < part.carried.size(); ++i) detail::place_point(f, part.carried[i], part, i);
  });
}

}  // namespace polybody
