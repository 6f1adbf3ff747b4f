#pragma once
/// \file
/// Lookup of a handle's body, joint or force in a layout, and of a body's part of a state.

#include <span>

#include <polybody/math/sequence.hpp>
#include <polybody/system/body_kernels.hpp>
#include <polybody/system/markers.hpp>
#include <polybody/system/state.hpp>

namespace polybody {

/// Requires a ground marker of the model of `layout`, or of a model from which that model was copied. \throws
/// InvalidInput naming `what` for a marker of another model.
template <class = void>
void require_own(ModelLayout const& layout, Marker<Ground> const& marker, std::string const& what) {
  if (!detail::accepts(layout.serial, layout.ancestors, marker.model)) detail::refuse_marker_of_another_model(what);
}

/// Requires a ground marker of `model`. \throws InvalidInput naming `what` for a marker of another model.
template <class M>
void require_own(M const& model, Marker<Ground> const& marker, std::string const& what) {
  model.require_own(marker, what);
}

namespace detail {
/// Position in `places` of the body, joint or force of type T that has the index `index` within its type. \throws
/// InvalidInput naming `what` if this part was not added to the model with the serial number `serial`.
template <class T, class Place>
Index index_of(Sequence<Place> const& places, std::uint64_t serial, Index index, std::string const& what) {
  for (std::size_t i = std::size_t(std::max<Index>(index, 0)); i < places.size(); ++i)  // index ≤ i for every part
    if (places[i].type == &type_tag<T> && places[i].index == index && places[i].made_in == serial) return Index(i);
  refuse_marker_of_another_model(what);
}
}  // namespace detail

/// Index of a body in `layout.bodies`. \throws InvalidInput for a default-constructed handle or a handle of another
/// model.
template <class B>
Index index_of(ModelLayout const& layout, BodyHandle<B> const& handle) {
  detail::require_filled(handle.model);
  return detail::index_of<B>(layout.bodies, handle.model, handle.index, handle.name);
}
/// Index of the body of a marker in `layout.bodies`. \throws InvalidInput naming `what` for a marker of another model.
template <class B>
Index index_of(ModelLayout const& layout, Marker<B> const& marker, std::string const& what) {
  return detail::index_of<B>(layout.bodies, marker.model, marker.body, what);
}
/// Index of a joint in `layout.joints`, equal to `ConstraintBlock::owner` of its equations. \throws InvalidInput for a
/// default-constructed handle or a handle of another model.
template <class J>
Index index_of_joint(ModelLayout const& layout, ElementHandle<J> const& handle) {
  detail::require_filled(handle.model);
  return detail::index_of<J>(layout.joints, handle.model, handle.index, handle.name);
}
/// Index of a force element in `layout.forces`, equal to `AppliedWrench::source` of its wrenches. \throws InvalidInput
/// for a default-constructed handle or a handle of another model.
template <class F>
Index index_of_force(ModelLayout const& layout, ElementHandle<F> const& handle) {
  detail::require_filled(handle.model);
  return detail::index_of<F>(layout.forces, handle.model, handle.index, handle.name);
}

/// References to a body and to its coordinates and generalised velocities in a state.
template <class B>
struct BodyInState {
  B const& body;                 ///< body in the model
  std::span<double const> q, v;  ///< generalised coordinates and velocities of the body in the state
};

namespace detail {
template <class B, class Entry>
BodyInState<B> entry_in_state(Entry const& e, State const& x) {
  return {e.body, checked_part(x.q, e.q0, e.body.coordinates()), checked_part(x.v, e.v0, e.body.velocities())};
}
}  // namespace detail

/// Body with its part of the state x. \param place layout of a body of type B. \throws InvalidInput if the state is too
/// short.
template <class B>
BodyInState<B> body_in_state(BodyLayout const& place, State const& x) {
  return {*static_cast<B const*>(place.body), detail::checked_part(x.q, place.q0, place.coordinates),
          detail::checked_part(x.v, place.v0, place.velocities)};
}
/// Body of a handle with its part of the state x. \param x state of the handle's model. \throws InvalidInput for a
/// default-constructed handle, or if the state is too short.
template <class B>
BodyInState<B> body_in_state(BodyHandle<B> const& handle, State const& x) {
  (void)handle.body();
  return detail::entry_in_state<B>((*handle.bodies)[std::size_t(handle.index)], x);
}
/// Body of a handle with its part of the state x. \throws InvalidInput for a handle of another model, or if the state
/// is too short.
template <class M, class B>
BodyInState<B> body_in_state(M const& model, State const& x, BodyHandle<B> const& handle) {
  return detail::entry_in_state<B>(model.entry(handle), x);
}
/// Body of a marker with its part of the state x. \throws InvalidInput naming `question` for a marker of another model,
/// or if the state is too short.
template <class M, class B>
BodyInState<B> body_in_state(M const& model, State const& x, Marker<B> const& marker, std::string const& question) {
  model.require_own(marker, question);
  return detail::entry_in_state<B>(std::get<detail::BodyPool<B>>(model.body_pools()).entries[std::size_t(marker.body)],
                                   x);
}

/// Body of a handle with its part of the state x, found in the layout of its model. \throws InvalidInput for a handle
/// of another model, or if the state is too short.
template <class B>
BodyInState<B> body_in_state(ModelLayout const& layout, State const& x, BodyHandle<B> const& handle) {
  return body_in_state<B>(layout.bodies[std::size_t(index_of(layout, handle))], x);
}
/// Body of a marker with its part of the state x, found in the layout of its model. \throws InvalidInput naming
/// `question` for a marker of another model, or if the state is too short.
template <class B>
BodyInState<B> body_in_state(ModelLayout const& layout, State const& x, Marker<B> const& marker,
                             std::string const& question) {
  return body_in_state<B>(layout.bodies[std::size_t(index_of(layout, marker, question))], x);
}

/// Name of the body of a marker, found in the layout of its model. \throws InvalidInput for a marker of another model.
template <class B>
std::string body_name(ModelLayout const& layout, Marker<B> const& marker) {
  return layout.bodies[std::size_t(index_of(layout, marker, "name"))].name;
}
/// Name of the body of a marker of this model.
template <class M, class B>
std::string body_name(M const& model, Marker<B> const& marker) {
  return std::get<detail::BodyPool<B>>(model.body_pools()).entries[std::size_t(marker.body)].name;
}

/// Marker kinematics of a point with the axes of the body. The result refers to `jacobian`, which stores the Jacobian.
template <class B>
MarkerKinematics<double> evaluate_marker(BodyInState<B> const& b, typename B::Point const& point,
                                         Sequence<double>& jacobian) {
  return BodyKernels<B, double>::publish_point(b.body, point, b.q, b.v, jacobian);
}

}  // namespace polybody
