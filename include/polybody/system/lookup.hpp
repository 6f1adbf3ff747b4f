#pragma once
/// \file
/// Where a handle's body, joint or force stands in a layout, and a body with its part of a state: what questions about
/// one part of a model are answered from.

#include <span>

#include <polybody/math/sequence.hpp>
#include <polybody/system/body_kernels.hpp>
#include <polybody/system/markers.hpp>
#include <polybody/system/state.hpp>

namespace polybody {

/// \throws InvalidInput naming `what` for a marker on the ground of another model.
template <class = void>
void require_own(ModelLayout const& layout, Marker<Ground> const& marker, std::string const& what) {
  if (!detail::accepts(layout.serial, layout.ancestors, marker.model)) detail::refuse_marker_of_another_model(what);
}

namespace detail {
/// The place of the T with this index among those of its type. \throws InvalidInput naming `what` where that was not
/// added to the model with the number `serial`.
template <class T, class Place>
Index index_of(Sequence<Place> const& places, std::uint64_t serial, Index index, std::string const& what) {
  for (std::size_t i = std::size_t(std::max<Index>(index, 0)); i < places.size(); ++i)  // no index is smaller
    if (places[i].type == &type_tag<T> && places[i].index == index && places[i].made_in == serial) return Index(i);
  refuse_marker_of_another_model(what);
}
}  // namespace detail

/// Index of a body in `layout.bodies`. \throws InvalidInput for a handle of another model, or one made by default.
template <class B>
Index index_of(ModelLayout const& layout, BodyHandle<B> const& handle) {
  detail::require_filled(handle.model);
  return detail::index_of<B>(layout.bodies, handle.model, handle.index, handle.name);
}
/// Index of a marker's body in `layout.bodies`. \throws InvalidInput naming `what` for a marker of another model.
template <class B>
Index index_of(ModelLayout const& layout, Marker<B> const& marker, std::string const& what) {
  return detail::index_of<B>(layout.bodies, marker.model, marker.body, what);
}
/// Index of a joint in `layout.joints`, `ConstraintBlock::owner` of its rows. \throws InvalidInput as above.
template <class J>
Index index_of_joint(ModelLayout const& layout, ElementHandle<J> const& handle) {
  detail::require_filled(handle.model);
  return detail::index_of<J>(layout.joints, handle.model, handle.index, handle.name);
}
/// Index of a force element in `layout.forces`, `AppliedWrench::source` of its wrenches. \throws InvalidInput as above.
template <class F>
Index index_of_force(ModelLayout const& layout, ElementHandle<F> const& handle) {
  detail::require_filled(handle.model);
  return detail::index_of<F>(layout.forces, handle.model, handle.index, handle.name);
}

/// A body with its own coordinates and speeds in a state; it refers to both.
template <class B>
struct BodyInState {
  B const& body;                 ///< in the model
  std::span<double const> q, v;  ///< its own coordinates and speeds, in the state
};

namespace detail {
template <class B, class Entry>
BodyInState<B> entry_in_state(Entry const& e, State const& x) {
  return {e.body, checked_part(x.q, e.q0, e.body.coordinates()), checked_part(x.v, e.v0, e.body.velocities())};
}
}  // namespace detail

/// \param place of a body of type B
template <class B>
BodyInState<B> body_in_state(BodyLayout const& place, State const& x) {
  return {*static_cast<B const*>(place.body), detail::checked_part(x.q, place.q0, place.coordinates),
          detail::checked_part(x.v, place.v0, place.velocities)};
}
/// \param x a state of the model that made the handle \throws InvalidInput for a handle made by default, or for a state
/// that is too short.
template <class B>
BodyInState<B> body_in_state(BodyHandle<B> const& handle, State const& x) {
  (void)handle.body();
  return detail::entry_in_state<B>((*handle.bodies)[std::size_t(handle.index)], x);
}
/// \throws InvalidInput for a handle of another model, or for a state that is too short.
template <class M, class B>
BodyInState<B> body_in_state(M const& model, State const& x, BodyHandle<B> const& handle) {
  return detail::entry_in_state<B>(model.entry(handle), x);
}
/// The body of a marker. \throws InvalidInput for one of another model, naming `question`.
template <class M, class B>
BodyInState<B> body_in_state(M const& model, State const& x, Marker<B> const& marker, std::string const& question) {
  model.require_own(marker, question);
  return detail::entry_in_state<B>(std::get<detail::BodyPool<B>>(model.body_pools()).entries[std::size_t(marker.body)],
                                   x);
}

/// Name of the body of a marker of this model.
template <class M, class B>
std::string body_name(M const& model, Marker<B> const& marker) {
  return std::get<detail::BodyPool<B>>(model.body_pools()).entries[std::size_t(marker.body)].name;
}

/// What a body publishes of a point, its axes being those of the body. The Jacobian stands in `jacobian`.
template <class B>
MarkerKinematics<double> evaluate_marker(BodyInState<B> const& b, typename B::Point const& point,
                                         Sequence<double>& jacobian) {
  return BodyKernels<B, double>::publish_point(b.body, point, b.q, b.v, jacobian);
}

}  // namespace polybody
