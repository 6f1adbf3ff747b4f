#pragma once
/// \file
/// What events do to a state that is stepped.

#include <array>

#include <polybody/integrators/forward_dynamics.hpp>
#include <polybody/run/event_watch.hpp>

namespace polybody {

/// The stepped state after those of the `events` that were met last have changed the user's state x. \param systems the
/// stepped one, and the whole one where that eliminates joints: then speeds are brought onto these before they are left
/// out
template <LinearSolver Solver>
[[gnu::cold]] State after_action(EventWatch& watch, std::vector<Event> const& events, State x,
                                 std::array<System*, 2> systems) {
  watch.act(events, x);
  auto const [stepped, whole] = systems;
  if (!whole) return x;
  ForwardDynamics<Solver> forward(*whole);
  forward.project_velocities(*whole, x.q, x.v, x.t);
  return reduce(*stepped, x);
}

}  // namespace polybody
