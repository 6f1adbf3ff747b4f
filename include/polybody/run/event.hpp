#pragma once
#include <functional>
#include <string>

#include <polybody/system/state.hpp>

namespace polybody {

/// Event of a run: `value` passes through zero, in either direction, and the step ends there. Two zeros within one step
/// are found if the value has a single extremum in the step, such as the top of a flight. A value that oscillates
/// within a step requires a smaller step.
struct Event {
  std::string name;                           ///< name in reports
  std::function<double(State const&)> value;  ///< event function, whose sign changes at the event
  bool terminal = false;                      ///< true if the event ends the run
  double tolerance = 1e-10;                   ///< tolerance of the time [s]
  /// Changes coordinates and velocities at the event, for example by an impact. The run restarts from the changed
  /// state. The action must satisfy the position constraints; velocities are projected onto the constraint equations
  /// afterwards, in the mass norm. If the action reverses the rate of the value, the next crossing from the same side
  /// is detected, even within the next step. If the value continues beyond zero, the next crossing from the other side
  /// is detected. At the start of a run, an event with an action and a value of zero occurs immediately, unless the
  /// value increases.
  std::function<void(State&)> action = {};
  /// Treatment of impacts that accumulate: ten repetitions, each within `tolerance` of the preceding impact, or 1000
  /// impacts within one step length. One repetition is enough if the rate of the value is zero after an impact. A ball
  /// with a restitution below one comes to rest in this way. If `rests` is false, the run then throws InvalidInput. If
  /// `rests` is true, the value is held at zero from this time on: coordinates and velocities are projected onto value
  /// = 0 after each step, in the mass norm. The value is released when a step ends with the sign that the value had
  /// before the event. Accelerations and multipliers do not include the force that holds the value.
  bool rests = false;
};

}  // namespace polybody
