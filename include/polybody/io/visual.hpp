#pragma once
/// \file
/// What a model looks like in a state: shapes carried by markers, and bars swept along their sections, under every
/// formulation.

#include <functional>
#include <string>

#include <polybody/bodies/shared/sections.hpp>
#include <polybody/io/surface.hpp>
#include <polybody/run/points.hpp>
#include <polybody/system/model_entries.hpp>

namespace polybody {

/// One thing to be seen: its surface in world axes, and in each of its points the axial stress [N/m²] where its body
/// knows it, else none, and the velocity [m/s]. A frame goes with it: the one that carries its shape, or the one at the
/// middle of a bar.
struct VisualPart {
  std::string name;                   ///< of the body
  Surface surface;                    ///< as it stands in the state
  std::vector<double> axial_stress;   ///< of each point, where it is known [N/m²]
  std::vector<Vec3> velocities = {};  ///< of each point, world axes [m/s]
  Vec3 place = Vec3::Zero();          ///< (3) origin of the frame, world axes [m]
  Mat3 axes = Mat3::Identity();       ///< (3×3) from axes of the frame to world axes
  std::vector<Vec3> carried = {};  ///< where a frame carries the part: its points in axes of the frame [m]; else none
};

namespace detail {
/// Point i of a part stands at `point` in the axes of a frame, and moves with it.
template <class = void>
void place_point(Frame<double> const& f, Vec3 const& point, VisualPart& part, std::size_t i) {
  Vec3 const arm = f.A * point;
  part.surface.points[i] = f.r + arm;
  part.velocities[i] = f.v + f.w.cross(arm);
}
}  // namespace detail

/// The visual geometry of a model, put together once and then asked for any state:
///   Visual visual(model);
///   visual.attach(chassis.at({0, 0, 0}), box({4, 2, 1}));   carried by the marker's frame
///   visual.sweep(beam, bar, 20);                            the bar's section along the body, deformed as the body is
///   for (VisualPart const& part : visual.at(x)) ...
/// The model must outlive it and must not change after.
class Visual {
 public:
  /// No shapes yet. The model must be complete.
  template <class M>
  explicit Visual(M const& model) : layout_(layout_of(model)), reference_(model.reference_state()) {}
  template <class M>
    requires(!std::same_as<M, Visual>)
  explicit Visual(M const&& model) = delete;  ///< a temporary model, which would not outlive it

  /// The shape's axes are the marker's. \throws InvalidInput for a marker of another model.
  template <class B>
  void attach(Marker<B> const& marker, Surface const& shape, std::string name = "shape");

  /// The bar that the body was made from, in so many pieces along its length, round sections with so many `sides`.
  /// Points of a section lie where the body's own points do; sections of cables and of the plane are carried by the
  /// frame on the axis.
  /// \throws InvalidInput for fewer than one piece, a handle of another model or a bar without a section.
  template <class B>
  void sweep(BodyHandle<B> const& body, Bar const& bar, int pieces, int sides = 24);

  /// The state in which the model is undeformed as placed.
  State const& reference() const { return reference_; }

  /// All parts in state x; valid until asked again. \throws InvalidInput for a state of another model, or where the
  /// model has changed.
  std::vector<VisualPart> const& at(State const& x) {
    layout_.watch.require_unchanged();
    for (std::size_t i = 0; i < parts_.size(); ++i) moves_[i](x, parts_[i]);
    return parts_;
  }

 private:
  /// One more part, whose points stand in the axes of a frame.
  template <class = void>
  void carry(Surface const& shape, std::string name, FrameIn frame_in);

  ModelLayout layout_;
  State reference_;
  std::vector<VisualPart> parts_;
  std::vector<std::function<void(State const&, VisualPart&)>> moves_;
};

// Outside the class, so that a program that links `polybody::compiled` does not compile them again.
template <class B>
void Visual::attach(Marker<B> const& marker, Surface const& shape, std::string name) {
  if constexpr (std::is_same_v<B, Ground>) {
    require_own(layout_, marker, name);
    Frame<double> const f{.r = marker.point.origin, .A = marker.point.axes};
    carry(shape, std::move(name), [f](State const&) { return f; });
  } else {
    BodyPlace const place = layout_.bodies[std::size_t(index_of(layout_, marker, name))];
    carry(shape, std::move(name),
          [place, point = marker.point](State const& x) { return frame(body_in_state<B>(place, x), point); });
  }
}

template <class B>
void Visual::sweep(BodyHandle<B> const& body, Bar const& bar, int pieces, int sides) {
  BodyPlace const place = layout_.bodies[std::size_t(index_of(layout_, body))];
  if (pieces < 1) throw InvalidInput{"\"", body.name, "\": a sweep needs at least one piece."};
  std::vector<Vec2> const ring = outline(bar, sides);
  int const n = int(ring.size());
  bool const stressed = HasSections<B> && bar.material;
  std::size_t const points = std::size_t((pieces + 1) * n);
  parts_.push_back(
      {body.name, swept(pieces + 1, n), std::vector<double>(stressed ? points : 0), std::vector<Vec3>(points)});
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
void Visual::carry(Surface const& shape, std::string name, FrameIn frame_in) {
  parts_.push_back({std::move(name), shape, {}, std::vector<Vec3>(shape.points.size())});
  parts_.back().carried = shape.points;
  moves_.push_back([frame_in = std::move(frame_in)](State const& x, VisualPart& part) {
    Frame<double> const f = frame_in(x);
    part.place = f.r;
    part.axes = f.A;
    for (std::size_t i = 0; i < part.carried.size(); ++i) detail::place_point(f, part.carried[i], part, i);
  });
}

}  // namespace polybody
