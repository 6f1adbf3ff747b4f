#pragma once
#include <functional>
#include <string>

#include <polybody/system/state.hpp>

namespace polybody {

/// Event of a run: `value` passes through zero, in either direction, and the step ends there. An even number of zeros
/// within one step is found if the value has one extremum, such as the top of a flight. A value that oscillates within
/// a step requires a smaller step.
struct Event {
  std::string name;                           ///< name in reports
  std::function<double(State const&)> value;  ///< event function, whose sign changes at the event
  bool terminal = false;                      ///< true if the event ends the run
  double tolerance = 1e-10;                   ///< tolerance of the time [s]
  /// Changes coordinates and velocities at the event, for example by an impact. The run restarts there. The action must
  /// satisfy the position constraints; velocities are projected onto the constraint equations afterwards, in the mass
  /// norm. If the value reverses, the next crossing from the same side is detected, also within the next step. If the
  /// value continues, the next crossing from the other side is detected. An event with an action and a value of zero at
  /// the start occurs immediately unless its value increases.
  std::function<void(State&)> action = {};
  /// Impacts accumulate if they follow each other within `tolerance`: a ball with a restitution below one comes to
  /// rest. Without `rests`, the run then throws InvalidInput. With `rests`, the value is held at zero from there on:
  /// after each step, coordinates and velocities are projected onto value = 0 in the mass norm, until a step ends on
  /// the side from which the event came. Accelerations and multipliers do not include the force that holds the value.
  bool rests = false;
};

}  // namespace polybody
