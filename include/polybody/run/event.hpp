#pragma once
#include <functional>
#include <string>

#include <polybody/system/state.hpp>

namespace polybody {

/// Something that happens when `value` passes through zero (in either direction). The step ends there. An even number
/// of zeros within one step is found if the value turns round once, as at the top of a flight; a value that oscillates
/// within a step needs a smaller step.
struct Event {
  std::string name;                           ///< in reports
  std::function<double(State const&)> value;  ///< whose sign changes at the event
  bool terminal = false;                      ///< ends the run
  double tolerance = 1e-10;                   ///< in time [s]
  /// Changes coordinates and speeds at the event, for example by an impact. The run restarts there. The action must
  /// keep the joints closed; speeds are projected onto them afterwards, over the masses. If the value turns back, the
  /// next crossing from the same side is met, also within the next step. If the value moves on, the next crossing from
  /// the other side is met. An event with an action that starts at zero is met at once unless its value grows.
  std::function<void(State&)> action = {};
  /// Impacts accumulate if they follow each other within `tolerance`: a ball with a restitution below one comes to
  /// rest. Then the run throws InvalidInput. With `rests` the value is held at zero from there on: after each step,
  /// coordinates and speeds are projected onto value = 0, over the masses, until a step ends on the side from which
  /// the event came. Accelerations and multipliers do not include the force that holds the value.
  bool rests = false;
};

}  // namespace polybody
