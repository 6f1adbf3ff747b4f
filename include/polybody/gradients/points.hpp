#pragma once
/// \file
/// Frames and positions of points of bodies in states of any scalar type, for objective functions that are
/// differentiated with a tape. The calls are the same as for a State (run/marker_frames.hpp).
///
/// Not in polybody.hpp: few programs need derivatives of whole runs.

#include <polybody/run/marker_frames.hpp>

namespace polybody {

/// Frame of a material point in state x. \throws InvalidInput for a marker of another model.
template <class M, class T, class B>
  requires(!std::same_as<T, double>)
Frame<T> frame(M const& model, StateOf<T> const& x, Marker<B> const& marker) {
  model.require_own(marker, "frame");
  auto const& entry = std::get<detail::BodyPool<B>>(model.body_pools()).entries[std::size_t(marker.body)];
  MarkerKinematics<T> out;
  out.columns = point_columns(entry.body, marker.point);
  std::vector<T> jacobian(std::size_t(6 * out.columns));
  out.jacobian = jacobian.data();
  entry.body.template evaluate_marker<T>(
      marker.point, identity(), std::span<T const>(x.q.data() + entry.q0, std::size_t(entry.body.coordinates())),
      std::span<T const>(x.v.data() + entry.v0, std::size_t(entry.body.velocities())), out);
  return out.frame;
}
/// Position of a material point in state x [m]. \throws InvalidInput for a marker of another model.
template <class M, class T, class B>
  requires(!std::same_as<T, double>)
Vec<T, 3> position(M const& model, StateOf<T> const& x, Marker<B> const& marker) {
  return frame(model, x, marker).r;
}

}  // namespace polybody
