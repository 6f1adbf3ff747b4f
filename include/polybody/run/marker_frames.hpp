#pragma once
/// \file
/// Evaluation of a single body in a state: frames of its points, coordinates, velocities and sections of beams. The
/// first argument of the functions is the model, or its `ModelLayout`.

#include <cmath>
#include <functional>

#include <polybody/bodies/shared/sections.hpp>
#include <polybody/math/sequence.hpp>
#include <polybody/system/lookup.hpp>

namespace polybody {

/// Frame of a material point of a body.
template <class B>
Frame<double> frame(BodyInState<B> const& body, typename B::Point const& point) {
  Sequence<double> jacobian;
  return evaluate_marker(body, point, jacobian).frame;
}
namespace detail {
/// Requires that the quaternion of a body has the norm one within 0.01. Smaller deviations occur in differentiated
/// runs, which evaluate functions of the user at such states. \throws InvalidInput otherwise. \param name returns the
/// name of the body
template <class B, class Name>
void require_unit_axes(B const& body, Frame<double> const& f, Name const& name) {
  double squared = 0.0;
  for (Index i = 0; i < 3; ++i) squared += f.A(i, 0) * f.A(i, 0);
  if (std::abs(squared - 1.0) <= 0.04 || body.coordinates() == body.velocities()) return;
  throw InvalidInput("state.quaternion",
                     {"frame: the quaternion of body \"", ErrorObject{name()}, "\" has the norm ",
                      ErrorValue{std::pow(squared, 0.25)}, ", so its axes have the length ", std::sqrt(squared),
                      ". The norm must be one within 0.01. Normalise the quaternion in the state."});
}
}  // namespace detail

/// Frame of a material point in state x. \throws InvalidInput for a marker of another model, and for a body that
/// rotates by a quaternion whose norm is not one.
template <class M, class B>
Frame<double> frame(M const& model, State const& x, Marker<B> const& marker) {
  BodyInState<B> const b = body_in_state(model, x, marker, "frame");
  Frame<double> const f = frame(b, marker.point);
  if constexpr (B::observes == MarkerKind::frame)
    detail::require_unit_axes(b.body, f, [&] { return body_name(model, marker); });
  return f;
}
/// Frame of a marker on the ground.
template <class M>
Frame<double> frame(M const& model, State const&, Marker<Ground> const& marker) {
  require_own(model, marker, "frame");
  return {.r = marker.point.origin, .A = marker.point.axes};
}

/// Function that returns the frame of a material point in a state. The types of body and model are erased.
using FrameIn = std::function<Frame<double>(State const&)>;

/// Returns a function for the frame of a material point. The function stores the body, and accepts states of the model
/// that made the handle `body`.
/// \param marker marker on this body
template <class B>
FrameIn frame_in(BodyHandle<B> const& body, Marker<B> const& marker) {
  return [body, point = marker.point](State const& x) { return frame(body_in_state(body, x), point); };
}

/// Position of a material point (3), world axes [m].
template <class M, class B>
Vec3 position(M const& model, State const& x, Marker<B> const& marker) {
  return frame(model, x, marker).r;
}

namespace detail {
/// Calls question(body, point, q) for the section at a marker.
template <class M, class B, class F>
auto ask_section(M const& model, State const& x, Marker<B> const& marker, F&& question) {
  static_assert(HasSections<B>,
                "This function needs the marker of a flexible beam; a rigid body and the ground do not deform.");
  BodyInState<B> const b = body_in_state(model, x, marker, "section");
  return question(b.body, marker.point, b.q);
}
}  // namespace detail

/// Strains (ε, γ_y, γ_z, κ_x, κ_y, κ_z) of the marker's section [1], [1/m]. \throws InvalidInput for a marker of
/// another model.
template <class M, class B>
Vec6 section_strains(M const& model, State const& x, Marker<B> const& marker) {
  return detail::ask_section(model, x, marker,
                             [](B const& b, auto const& p, auto q) { return b.section_strains(p, q); });
}
/// Section forces (N, Q_y, Q_z, M_x, M_y, M_z) of the marker's section [N], [N m].
template <class M, class B>
Vec6 section_forces(M const& model, State const& x, Marker<B> const& marker) {
  return detail::ask_section(model, x, marker,
                             [](B const& b, auto const& p, auto q) { return b.section_forces(p, q); });
}

/// Coordinates of one body in state x, for the body's member functions (strains, centre line).
template <class M, class B>
std::span<double const> coordinates_of(M const& model, State const& x, BodyHandle<B> const& handle) {
  return body_in_state(model, x, handle).q;
}
/// Generalised velocities of one body in state x.
template <class M, class B>
std::span<double const> velocities_of(M const& model, State const& x, BodyHandle<B> const& handle) {
  return body_in_state(model, x, handle).v;
}

/// Curvature of the axis relative to the reference state, √(κ_y² + κ_z²) [1/m].
template <class M, class B>
double curvature(M const& model, State const& x, Marker<B> const& marker) {
  Vec6 const e = section_strains(model, x, marker);
  return std::hypot(e[4], e[5]);
}
/// Axial strain [1] of the fibre through the marker's point.
template <class M, class B>
double axial_strain(M const& model, State const& x, Marker<B> const& marker) {
  Vec2 const off = off_axis(marker.point);
  return fibre_strain(section_strains(model, x, marker), off[0], off[1]);
}
/// Axial stress [N/m²] of the fibre through the marker's point; `bar` describes the body. \throws InvalidInput for a
/// bar without section and material.
template <class M, class B>
double axial_stress(M const& model, State const& x, Marker<B> const& marker, Bar const& bar) {
  Vec2 const off = off_axis(marker.point);
  return fibre_stress(bar, section_forces(model, x, marker), off[0], off[1]);
}

}  // namespace polybody
