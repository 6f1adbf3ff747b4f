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
};

}  // namespace polybody
