#pragma once
/// \file
/// Exceptions for times at which a run is not differentiable. Messages begin with `who`, the name of the calling
/// function.
///
/// Not in polybody.hpp: few programs need derivatives of whole runs.

#include <string>

#include <polybody/run/event_detector.hpp>

namespace polybody::detail {

/// \throws InvalidInput always: an event coincides with a breakpoint or the end of the run at t [s].
template <class = void>
[[noreturn, gnu::cold]] void refuse_event_at_breakpoint(double t, char const* who) {
  throw InvalidInput(
      "derivative.coincident_times",
      {ErrorObject{who}, ": an event coincides with a breakpoint or with the end of the run at t = ", ErrorTime{t},
       " s; the run is not differentiable there. Move one of the two times by at least one step."});
}
/// \throws InvalidInput always: the run ends at t [s] at a breakpoint that moves with the parameter `name`.
template <class = void>
[[noreturn, gnu::cold]] void refuse_breakpoint_at_end(double t, std::string const& name, char const* who) {
  throw InvalidInput(
      "derivative.coincident_times",
      {ErrorObject{who}, ": a breakpoint at the end of the run, t = ", ErrorTime{t}, " s, moves with \"", name,
       "\", but the end does not; the run is not differentiable there. End the run at least one step before or after "
       "the breakpoint."});
}
/// \throws InvalidInput always: the value of the event `name` touches zero at t [s] and does not pass through it.
template <class = void>
[[noreturn, gnu::cold]] void refuse_touch(std::string const& name, double t, char const* who) {
  throw InvalidInput("derivative.event",
                     {ErrorObject{who}, ": the event \"", name, "\" only touches zero at t = ", ErrorTime{t},
                      " s, so that its time has no derivative. Use an event value that passes through zero with a "
                      "nonzero rate."});
}

/// \throws InvalidInput if the value of one of the `events` remains at zero from t [s] on.
template <class = void>
[[gnu::cold]] void require_moving(std::vector<Event> const& events, EventDetector const& watch, double t,
                                  char const* who) {
  std::size_t const i = watch.first_held();
  if (i < events.size())
    throw InvalidInput(
        "derivative.event",
        {ErrorObject{who}, ": the value of the event \"", events[i].name, "\" remains zero from t = ", ErrorTime{t},
         " s on, after accumulating impacts. The run is not differentiable there. End the run before "
         "this time."});
}

}  // namespace polybody::detail
