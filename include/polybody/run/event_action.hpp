#pragma once
/// \file
/// Actions of events, and event values that are held at zero.
/// Theory: Eqs. 8.15, 8.16.

#include <array>

#include <polybody/integrators/forward_dynamics.hpp>
#include <polybody/run/event_detector.hpp>

namespace polybody {

/// Returns a function that moves a state of `system` by a time h [s] along its velocities and accelerations. `system`
/// must outlive the function.
inline std::function<void(State&, double)> drift_of(System& system) {
  return [&system](State& x, double h) {
    VecX const increment = h * x.v + (0.5 * h * h) * x.a;
    VecX const q = x.q;
    system.plus(q, increment, x.q);
    x.v += h * x.a;
    x.t += h;
  };
}

namespace detail {

/// Largest |Φ| at x, and the index of its equation.
template <class = void>
std::pair<double, Index> opening(System& full, State const& x) {
  full.evaluate(x.q, x.v, x.t);
  VecX phi = VecX::Zero(full.rows());
  full.violation(phi);
  Index worst = 0;
  for (Index i = 1; i < phi.size(); ++i)
    if (std::abs(phi[i]) > std::abs(phi[worst])) worst = i;
  return {phi.size() == 0 ? 0.0 : std::abs(phi[worst]), worst};
}

/// Checks the state `after` the action of an event. \throws InvalidInput if the sizes of `after` differ from those of
/// `before`, if a value is not finite, or if the largest constraint violation exceeds `tolerance` and twice the largest
/// violation in `before`.
template <class = void>
[[gnu::cold]] void require_closed(System& full, Event const& event, State const& before, State const& after,
                                  double tolerance) {
  auto const same = [&](VecX State::* part) { return (after.*part).size() == (before.*part).size(); };
  if (!same(&State::q) || !same(&State::v) || !same(&State::a) || !same(&State::lambda))
    throw InvalidInput("event.action",
                       {"The action of the event \"", ErrorObject{event.name}, "\" at t = ", ErrorTime{before.t},
                        " s changes the sizes of the state. Change the entries of q and v only."});
  require_finite(after.q, "The coordinates after the event \"" + event.name + "\"");
  require_finite(after.v, "The velocities after the event \"" + event.name + "\"");
  if (full.rows() == 0 || after.q == before.q) return;
  auto const [open, row] = opening(full, after);
  if (open <= tolerance || open <= 2.0 * opening(full, before).first) return;
  throw InvalidInput(
      "event.action",
      {"The action of the event \"", ErrorObject{event.name}, "\" at t = ", ErrorTime{before.t}, " s violates ",
       full.name_of(full.velocities() + row), " by ", ErrorValue{open}, " (m or rad), but the limit is ", tolerance,
       " (`assembly_tolerance`). Change velocities only, or call assemble(model, x) in the action."});
}

/// Changes coordinates and velocities of x so that the event value and its rate due to velocities are zero. The change
/// is minimal in the mass norm and satisfies the constraint equations. \throws InvalidInput if the value does not
/// depend on coordinates that can move.
template <LinearSolver Solver>
[[gnu::cold]] void hold(Event const& event, System& full, ForwardDynamics<Solver>& forward, State& x) {
  Index const n = full.velocities();
  VecX along = VecX::Zero(n), move = along, mu;
  for (int k = 0; k < 3; ++k) {
    State y = x;
    VecX increment = VecX::Zero(n);
    double const by = 1e-6;
    for (Index i = 0; i < n; ++i) {
      increment[i] = by;
      full.plus(x.q, increment, y.q);
      double const later = event.value(y);
      increment[i] = -by;
      full.plus(x.q, increment, y.q);
      along[i] = (later - event.value(y)) / (2.0 * by);
      increment[i] = 0.0;
    }
    forward.hold(full, x.q, x.v, x.t);
    forward.response(full, along, move, mu);
    double const mobility = along.dot(move);
    if (!(mobility > 1e-12 * along.norm() * move.norm()))
      throw InvalidInput("event.rests",
                         {"The event \"", ErrorObject{event.name}, "\" cannot be held at zero at t = ", ErrorTime{x.t},
                          " s, because its value does not change with coordinates that can move. Omit `rests`."});
    double const value = event.value(x);
    if (k > 0 && value == 0.0) break;
    State next = x;
    full.plus(x.q, VecX(-value / mobility * move), next.q);
    next.v -= along.dot(x.v) / mobility * move;
    (void)forward.project_positions_once(full, next.q, next.v, next.t);
    x = std::move(next);
  }
  require_finite(x.q, "The coordinates at rest in the event \"" + event.name + "\"");
  require_finite(x.v, "The velocities at rest in the event \"" + event.name + "\"");
}

}  // namespace detail

/// Holds event values at zero (`Event::rests`) in a state x of the `full` model. Then applies the actions of the events
/// that occurred in the last step, one after the other. \param tolerance limit of the constraint violation after an
/// action
/// \throws InvalidInput if a value cannot be held at zero, or if an action changes the sizes of x, violates a joint, or
/// makes a coordinate or velocity not finite.
template <LinearSolver Solver = DefaultSolver>
[[gnu::cold]] void act(EventDetector const& watch, std::vector<Event> const& events, State& x, System& full,
                       double tolerance) {
  if (watch.first_held() < events.size()) {
    ForwardDynamics<Solver> forward(full);
    for (int sweep = 0; sweep < 3; ++sweep)  // values that are held at the same time affect each other
      for (std::size_t i = 0; i < events.size(); ++i)
        if (watch.held(i)) detail::hold(events[i], full, forward, x);
  }
  for (std::size_t i = 0; i < events.size(); ++i) {
    if (!watch.met(i) || !events[i].action) continue;
    State const before = x;
    events[i].action(x);
    x.t = before.t;
    detail::require_closed(full, events[i], before, x, tolerance);
  }
}

/// Applies the actions of the `events` that occurred in the last step to the full state x. Returns the integrated
/// state.
/// \param systems integrated system; full system, or null if no joints are eliminated. With a full system, velocities
/// are projected onto its constraint equations before the elimination. \param tolerance limit of the constraint
/// violation after an action [m], [rad]
template <LinearSolver Solver>
[[gnu::cold]] State after_action(EventDetector const& watch, std::vector<Event> const& events, State x,
                                 std::array<System*, 2> systems, double tolerance) {
  auto const [stepped, full] = systems;
  act<Solver>(watch, events, x, full ? *full : *stepped, tolerance);
  if (!full) return x;
  ForwardDynamics<Solver> forward(*full);
  forward.project_velocities(*full, x.q, x.v, x.t);
  return reduce(*stepped, x);
}

}  // namespace polybody
