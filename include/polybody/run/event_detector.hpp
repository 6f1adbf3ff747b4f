#pragma once
/// \file
/// Detection of the zeros of event values within the steps of a run.

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include <polybody/math/errors.hpp>
#include <polybody/run/run_options.hpp>

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
  /// Rate of the event value at x [unit of the event/s], by central differences over a tenth of the requested step.
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

/// Step of a run, in which events are detected.
struct EventStep {
  /// Function that takes a step of at most the given length [s] and updates the state. Returns the length of the step
  /// [s].
  using Again = std::function<double(State&, double)>;

  State const& before;        ///< state at the start of the step
  double length;              ///< length of the step [s]
  Again const& again;         ///< takes a step from a state
  EventMotion const& motion;  ///< extrapolation of states near the step

  /// State h seconds after the start of the step.
  State after(double h) const {
    State x = before;
    while (x.t < before.t + h) {
      double const left = before.t + h - x.t;
      if (again(x, left) == left) break;
    }
    return x;
  }
  /// Time [s] from the start of the step to a state in which the event value does not have the sign `side`, although it
  /// has this sign at both ends of the step; 0 if none is found. x is the state at the end of the step. A cubic through
  /// the values and rates at the ends of an interval estimates the extremum, in at most five iterations.
  [[gnu::cold]] double turn(Event const& event, int side, State const& x) const {
    if (side != 1 && side != -1) return 0.0;
    auto const value = [&](State const& y) { return side * event.value(motion.seen(y)); };
    auto const rate_of = [&](State const& y) { return side * motion.rate(event, y); };
    double lo = 0.0, hi = length;
    double r0 = rate_of(before), r1 = r0 < 0.0 ? rate_of(x) : 0.0;
    if (!(r0 < 0.0 && r1 > 0.0)) return 0.0;
    double w0 = value(before), w1 = value(x);
    for (int k = 0; k < 5; ++k) {
      // w(s h) = w0 + b s + c s² + d s³
      double const h = hi - lo, b = r0 * h, c = 3.0 * (w1 - w0) - h * (2.0 * r0 + r1),
                   d = 2.0 * (w0 - w1) + h * (r0 + r1);
      double const s = -b / (c + std::sqrt(std::max(0.0, c * c - 3.0 * b * d)));
      if (!(s > 0.0 && s < 1.0)) return 0.0;
      if (w0 + s * (b + s * (c + s * d)) > 0.1 * std::min(w0, w1)) return 0.0;
      double const at = lo + s * h;
      if (!(at > lo && at < hi)) return 0.0;
      State const trial = after(at);
      double const w = value(trial);
      if (!(w > 0.0)) return at;
      double const r = rate_of(trial);
      (r < 0.0 ? lo : hi) = at;
      (r < 0.0 ? w0 : w1) = w;
      (r < 0.0 ? r0 : r1) = r;
    }
    return 0.0;
  }
};

/// Record of one event during a run: sign of its value, values in the last steps, and actions.
struct EventPlace {
  static constexpr int repeats_allowed = 10;    ///< limit of `repeats`
  static constexpr int actions_allowed = 1000;  ///< limit of actions of one event within one step length
  static constexpr double never = std::numeric_limits<double>::infinity();  ///< initial value of action times [s]

  int side = 0;           ///< sign of the value: −1, 0 (unknown) or 1; −2 or 2: now held at zero, −1 or 1 before
  bool known = false;     ///< true if `value` is set
  double value = 0.0;     ///< value at the end of the last step, unit of the event
  double rate = 0.0;      ///< mean rate of the value over the last step [unit of the event/s]
  double span = 0.0;      ///< length of the last step [s]; 0 after a start or an event
  double acted = -never;  ///< time of the last action [s]
  double since = -never;  ///< time from which `actions` are counted [s]
  int actions = 0;        ///< number of actions from `since` on
  int repeats = 0;        ///< consecutive actions, each within the tolerance of the preceding one
  bool stays = false;     ///< true if |rate| of the value after the last action is at most 1e-3 times `scale`
  double scale = 0.0;     ///< |rate| of the value at the last event [unit of the event/s]
  double off = 0.0;       ///< |value| at the last event, unit of the event

  bool rests() const { return side == 2 || side == -2; }  ///< true if the value is held at zero
  /// Sign of the value `y`: −1, 0 or 1.
  static int sign(double y) { return (y > 0.0) - (y < 0.0); }
  /// True if the sign of the value y differs from the stored sign. False if the stored sign is unknown.
  bool passed(double y) const { return side != 0 && sign(y) != (rests() ? side / 2 : side); }
  /// True if the value may have crossed zero twice within a step of length h [s] that ends with the value `now`. The
  /// parabola through the last three values then has its extremum within the step, and this extremum is beyond zero or
  /// less than half as large as the smaller end value. True also if the third value is unknown.
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
  /// from now on. Actions accumulate after `repeats_allowed` repeated actions, each within the tolerance of the
  /// preceding one, or after `actions_allowed` actions within one step length. If `stays` is true, one repeated action
  /// is enough. \throws InvalidInput if actions accumulate and `rests` of the event is false.
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
                                     : sentence_of({"with ", actions, " actions within the length of one step"});
    throw InvalidInput("event.accumulates",
                       {"The event \"", ErrorObject{event.name}, "\" occurs again ", why, " at t = ", ErrorTime{t},
                        " s: the impacts accumulate, and the body comes to rest. Set `rests` of the event to hold its "
                        "value at zero from there on, or end the run before this time."});
  }
};

/// Stores the sign of each event value, and finds the first event within a step. Steps are taken through a function, so
/// that this class is compiled once for all models.
class EventDetector {
 public:
  using Step = EventStep::Again;  ///< function that takes a step
  using Taken = EventStep;        ///< step of a run

  EventDetector() = default;
  /// Detector with these signs, as `sides` returns them.
  explicit EventDetector(Sequence<int> const& sides) {
    for (int const side : sides) places_.push_back({.side = side});
    met_.assign(places_.size(), 0);
  }
  /// Sign of each event value: −1, 0 (unknown) or 1; −2 or 2 if the value is held at zero after a negative or positive
  /// value.
  Sequence<int> sides() const {
    Sequence<int> all;
    for (EventPlace const& place : places_) all.push_back(place.side);
    return all;
  }

  /// Stores the signs of the event values at the initial state x of a run. \throws NonFiniteValue.
  [[gnu::cold]] void start(std::vector<Event> const& events, State const& x, EventMotion const& motion);

  /// Searches a step that ends at x for its first event, by bisection on the step length. Sets x to the state at this
  /// event, and adds the event to the report. Returns true if the run must restart at x: an event occurred, or a value
  /// is held at zero. Otherwise the full state that was computed last is that of x. \throws NonFiniteValue;
  /// InvalidInput for impacts that accumulate.
  bool meet(std::vector<Event> const& events, Taken const& step, State& x, RunReport& report) {
    before_.places = places_;
    before_.events = report.events.size();
    before_.stopped = report.stopped;
    look(events, x, step.motion);
    bool any = false;
    for (std::size_t i = 0; i < places_.size(); ++i)
      any = any || places_[i].passed(now_[i]) || places_[i].may_turn(now_[i], step.length);
    if (any) return search(events, step, x, report);
    go_on(step.length);
    return false;
  }
  /// Restores the signs and the report of the time before the last `meet`.
  [[gnu::cold]] void put_back(RunReport& report) {
    places_ = before_.places;
    report.events.truncate(before_.events);
    report.stopped = before_.stopped;
  }

  bool met(std::size_t i) const { return met_[i] == 1; }   ///< event i occurred in the last examined step
  bool held(std::size_t i) const { return met_[i] == 2; }  ///< value i must be held at zero at the end of the last step
  /// True if an event value is held at zero over several steps.
  bool rests() const {
    for (EventPlace const& place : places_)
      if (place.rests()) return true;
    return false;
  }
  /// Index of the first event that is held at zero, or the number of events.
  std::size_t first_held() const {
    std::size_t i = 0;
    while (i < met_.size() && !held(i)) ++i;
    return i;
  }
  /// True if one of the `events` that occurred changes the state.
  bool acts(std::vector<Event> const& events) const {
    for (std::size_t i = 0; i < events.size(); ++i)
      if (held(i) || (met(i) && events[i].action)) return true;
    return false;
  }
  /// Stores the signs of the event values at x, after the actions of the events and a restart. \throws NonFiniteValue.
  [[gnu::cold]] void settle(std::vector<Event> const& events, State const& x, EventMotion const& motion);
  /// Discards all data except the signs, so that the run continues as if it were resumed from a snapshot.
  [[gnu::cold]] void forget() {
    for (EventPlace& place : places_) place = {.side = place.side};
  }

 private:
  struct Before {
    Sequence<EventPlace> places;
    std::size_t events = 0;
    bool stopped = false;
  };

  [[gnu::cold]] bool search(std::vector<Event> const& events, Taken const& step, State& x, RunReport& report);

  /// Stores the values at the end of a step of length h without events.
  void go_on(double h) {
    met_.assign(places_.size(), 0);
    for (std::size_t i = 0; i < places_.size(); ++i) {
      EventPlace& place = places_[i];
      place.rate = (now_[i] - place.value) / h;
      place.span = place.known ? h : 0.0;
      place.stand(now_[i]);
    }
  }
  /// Evaluates the events at x; the full state is computed once.
  void look(std::vector<Event> const& events, State const& x, EventMotion const& motion) {
    now_.clear();
    State const& full = motion.seen(x);
    for (Event const& event : events) now_.push_back(EventMotion::value(event, full));
  }
  Sequence<EventPlace> places_;  // unchanged by a restart without action, whose round-off then causes no second event
  Before before_;
  Sequence<double> now_;
  Sequence<int> met_;  // 1: event occurred, 2: value is held at zero
};

inline void EventDetector::start(std::vector<Event> const& events, State const& x, EventMotion const& motion) {
  places_.assign(events.size(), {});
  met_.assign(events.size(), 0);
  if (events.empty()) return;
  look(events, x, motion);
  for (std::size_t i = 0; i < events.size(); ++i) {
    places_[i].stand(now_[i]);
    if (!events[i].action || now_[i] > 0.0) continue;
    State y = x;
    motion.drift(y, 0.05 * motion.requested_step);
    double const moves = events[i].value(motion.seen(y)) - now_[i];
    // zero within round-off and not increasing: the body rests on the contact of the event, or moves into it
    if (now_[i] == 0.0 || (moves <= 0.0 && -now_[i] < -1e-6 * moves)) places_[i].side = 1;
  }
}

inline bool EventDetector::search(std::vector<Event> const& events, Taken const& step, State& x, RunReport& report) {
  State first = x;
  Sequence<double> const ends = now_;
  bool found = false;
  for (std::size_t i = 0; i < places_.size(); ++i) {
    if (places_[i].rests()) continue;
    double lo = 0.0, hi = places_[i].passed(ends[i]) ? step.length : step.turn(events[i], places_[i].side, x);
    if (!(hi > 0.0)) continue;
    found = true;
    if (hi < step.length)
      if (State trial = step.after(hi); trial.t < first.t) first = std::move(trial);
    while (hi - lo > events[i].tolerance) {
      double const mid = 0.5 * (lo + hi);
      if (mid <= lo || mid >= hi) break;
      State trial = step.after(mid);
      if (!places_[i].passed(EventMotion::value(events[i], step.motion.seen(trial)))) {
        lo = mid;
        continue;
      }
      hi = mid;
      if (trial.t < first.t) first = std::move(trial);
    }
  }
  if (found) x = std::move(first);
  look(events, x, step.motion);
  bool held_again = false;
  for (std::size_t i = 0; i < places_.size(); ++i)
    held_again = held_again || (places_[i].rests() && places_[i].passed(now_[i]));
  if (!found && !held_again) {
    go_on(step.length);
    return false;
  }
  met_.assign(places_.size(), 0);
  for (std::size_t i = 0; i < places_.size(); ++i) {
    EventPlace& place = places_[i];
    place.span = 0.0;
    if (!place.passed(now_[i])) {
      place.stand(now_[i]);
      continue;
    }
    met_[i] = place.rests() ? 2 : 1;
    if (place.rests()) continue;
    report.stopped = report.stopped || events[i].terminal;
    if (events[i].action) {
      place.scale = std::max(std::abs(step.motion.rate(events[i], x)),
                             place.known ? std::abs(ends[i] - place.value) / step.length : 0.0);
      place.off = std::abs(now_[i]);
      if (!report.stopped) place.count(events[i], std::min(step.motion.requested_step, step.length), x.t);
    }
    if (place.rests()) met_[i] = 2;
    report.events.push_back({place.rests() ? events[i].name + " comes to rest" : events[i].name, x.t});
    if (!events[i].action) place.stand(now_[i]);
  }
  return true;
}

inline void EventDetector::settle(std::vector<Event> const& events, State const& x, EventMotion const& motion) {
  look(events, x, motion);
  for (std::size_t i = 0; i < events.size(); ++i) {
    EventPlace& place = places_[i];
    int const from = place.side;
    if (place.rests()) {
      place.value = now_[i];
      continue;
    }
    place.stand(now_[i]);
    if (!met(i) || !events[i].action) continue;
    if (std::abs(now_[i]) > 2.0 * std::max(place.off, place.scale * events[i].tolerance)) continue;
    if (EventMotion::reads_forces(events[i], motion.seen(x))) {
      place.side = 0;
      continue;
    }
    double const moves = from * motion.rate(events[i], x);
    place.stays = std::abs(moves) <= 1e-3 * place.scale;
    place.side = moves < -1e-3 * place.scale ? -from : from;
  }
}

}  // namespace polybody
