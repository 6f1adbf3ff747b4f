#pragma once
#include <algorithm>
#include <cmath>
#include <limits>

#include <polybody/math/errors.hpp>
#include <polybody/run/event.hpp>

namespace polybody {

/// State of one event of a run: sign of its value, values in the last steps, and actions.
struct EventPlace {
  static constexpr int repeats_allowed = 10;    ///< limit of consecutive actions, each within `tolerance` of the last
  static constexpr int actions_allowed = 1000;  ///< limit of actions of one event within one step length
  static constexpr double never = std::numeric_limits<double>::infinity();  ///< initial time of actions [s]

  int side = 0;           ///< sign of the value: −1, 0 (unknown), 1; −2 or 2 if held at zero after this sign
  bool known = false;     ///< true if `value` is set
  double value = 0.0;     ///< value at the end of the last step, unit of the event
  double rate = 0.0;      ///< mean rate of the value over the last step [1/s]
  double span = 0.0;      ///< length of that step [s]; 0 after a start
  double acted = -never;  ///< time of the last action [s]
  double since = -never;  ///< time from which `actions` are counted [s]
  int actions = 0;        ///< number of actions from `since` on
  int repeats = 0;        ///< consecutive actions, each within the tolerance of the preceding one
  bool stays = false;     ///< true if the rate of the value is zero after the last action
  double scale = 0.0;     ///< |rate| of the value at the last event [1/s]
  double off = 0.0;       ///< |value| at the last event, unit of the event

  bool rests() const { return side == 2 || side == -2; }  ///< true if the value is held at zero
  /// Sign of the value `y`: −1, 0 or 1.
  static int sign(double y) { return (y > 0.0) - (y < 0.0); }
  /// True if the value y has left the stored side. False for an unknown side.
  bool passed(double y) const { return side != 0 && sign(y) != (rests() ? side / 2 : side); }
  /// True if the value may have crossed zero twice within a step of length h [s] that ends with the value `now`. The
  /// parabola through the last three values then has its extremum within the step, at less than half of both end
  /// values.
  bool may_turn(double now, double h) const {
    if (side != 1 && side != -1) return false;
    if (!(span > 0.0)) return true;
    double const w0 = side * value, w1 = side * now, mean = (w1 - w0) / h, bend = (mean - side * rate) / (h + span);
    double const r0 = mean - bend * h, r1 = mean + bend * h;
    return r0 < 0.0 && r1 > 0.0 && w0 - 0.25 * r0 * r0 / bend < 0.5 * std::min(w0, w1);
  }
  /// Stores the value `now` at the end of a step.
  void stand(double now) {
    value = now;
    known = true;
    side = sign(now);
  }
  /// Counts an action at t [s] in a run with steps of `length` [s]. If actions accumulate, the value is held at zero
  /// from now on. \throws InvalidInput if actions accumulate and `rests` of the event is false.
  [[gnu::cold]] void count(Event const& event, double length, double t) {
    double const within = event.tolerance + 4.0 * std::numeric_limits<double>::epsilon() * std::abs(t);
    repeats = t - acted <= within ? repeats + 1 : 0;
    acted = t;
    if (t - since > length) {
      since = t;
      actions = 0;
    }
    ++actions;
    bool const repeated = repeats >= repeats_allowed || (repeats > 0 && stays);
    if (!repeated && actions < actions_allowed) return;
    side = side > 0 ? 2 : -2;
    if (event.rests) return;
    std::string const why = repeated ? sentence_of({"within its tolerance of ", event.tolerance, " s after its action"})
                                     : sentence_of({actions, " times within the length of one step"});
    throw InvalidInput("event.accumulates",
                       {"The event \"", ErrorObject{event.name}, "\" occurs again ", why, " at t = ", ErrorTime{t},
                        " s: the impacts accumulate, and the body comes to rest. Set `rests` of the event to hold its "
                        "value at zero from there on, or end the run before."});
  }
};

}  // namespace polybody
