#pragma once
#include <cmath>
#include <functional>

#include <polybody/math/errors.hpp>
#include <polybody/run/event.hpp>

namespace polybody {

/// Extrapolation of a state by its velocities and accelerations, without a step, for the detection of events.
struct EventMotion {
  double requested_step;                           ///< requested length of steps [s]
  std::function<State const&(State const&)> seen;  ///< returns the full state of an integrated state
  /// Moves a state along its velocities and accelerations by a time [s], forwards or backwards, without a step.
  std::function<void(State&, double)> drift;

  /// Event value at a full state. \throws NonFiniteValue.
  static double value(Event const& event, State const& x) {
    double const y = event.value(x);
    if (!std::isfinite(y))
      throw NonFiniteValue("event.not_finite",
                           {"The value of the event \"", ErrorObject{event.name},
                            "\" is not finite at t = ", ErrorTime{x.t}, " s. Check the function of the event."});
    return y;
  }
  /// Rate of the event value at x [1/s], by central differences over a tenth of the requested step.
  [[gnu::cold]] double rate(Event const& event, State const& x) const {
    double const by = 0.05 * requested_step;
    State y = x;
    drift(y, by);
    double const later = event.value(seen(y));
    y = x;
    drift(y, -by);
    return (later - event.value(seen(y))) / (2.0 * by);
  }
  /// True if the event value depends on accelerations or multipliers, whose rates are unknown.
  [[gnu::cold]] static bool reads_forces(Event const& event, State const& full) {
    State others = full;
    others.a.array() = 1.5 * others.a.array() + 1.0;
    others.lambda.array() = 1.5 * others.lambda.array() + 1.0;
    return event.value(others) != event.value(full);
  }
};

}  // namespace polybody
