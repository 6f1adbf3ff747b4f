#pragma once
#include <functional>
#include <string>

#include <polybody/system/state.hpp>

namespace polybody {

/// Something that happens when `value` passes through zero (in either direction). The step ends there.
struct Event {
  std::string name;                           ///< in reports
  std::function<double(State const&)> value;  ///< whose sign changes at the event
  bool stops = false;                         ///< ends the run
  double tolerance = 1e-10;                   ///< in time [s]
  /// Changes coordinates and speeds where the event is met, as an impact does; the run begins anew from there. It keeps
  /// the joints closed; the speeds are projected onto them afterwards, over the masses. The event is looked for again
  /// after the next step: a ball whose speed is turned round as it comes down is not met once more as it goes up.
  std::function<void(State&)> then = {};
};

}  // namespace polybody
