#pragma once
#include <cmath>
#include <functional>

#include <polybody/math/errors.hpp>
#include <polybody/run/event.hpp>

namespace polybody {

/// The motion of a run near a state, for questions of its events.
struct EventMotion {
  double asked;                                    ///< length of steps that the run is asked for [s]
  std::function<State const&(State const&)> seen;  ///< makes the user's state of a stepped one
  /// Moves a state along its speeds and accelerations by so many seconds, forwards or back, without a step.
  std::function<void(State&, double)> drift;

  /// The event's value at a state of the user's. \throws NonFiniteValue.
  static double value(Event const& event, State const& x) {
    double const y = event.value(x);
    if (!std::isfinite(y))
      throw NonFiniteValue("event.not_finite", {"The event \"", ErrorObject{event.name},
                                                "\" is not finite at t = ", ErrorTime{x.t}, " s."});
    return y;
  }
  /// The rate of an event's value at x [1/s], by central differences over a tenth of a step of `asked`.
  [[gnu::cold]] double rate(Event const& event, State const& x) const {
    double const by = 0.05 * asked;
    State y = x;
    drift(y, by);
    double const later = event.value(seen(y));
    y = x;
    drift(y, -by);
    return (later - event.value(seen(y))) / (2.0 * by);
  }
  /// The event's value depends on accelerations or multipliers, whose rates are not known.
  [[gnu::cold]] static bool reads_forces(Event const& event, State const& shown) {
    State others = shown;
    others.a.array() = 1.5 * others.a.array() + 1.0;
    others.lambda.array() = 1.5 * others.lambda.array() + 1.0;
    return event.value(others) != event.value(shown);
  }
};

}  // namespace polybody
