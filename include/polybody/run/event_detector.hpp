#pragma once
/// \file
/// Detection of the zeros of event values within the steps of a run.

#include <algorithm>
#include <cmath>

#include <polybody/run/event_place.hpp>
#include <polybody/run/event_step.hpp>
#include <polybody/run/run_options.hpp>

namespace polybody {

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
  /// Restores the signs and the report that the last `meet` found.
  [[gnu::cold]] void put_back(RunReport& report) {
    places_ = before_.places;
    report.events.truncate(before_.events);
    report.stopped = before_.stopped;
  }

  bool met(std::size_t i) const { return met_[i] == 1; }   ///< event i occurred in the last examined step
  bool held(std::size_t i) const { return met_[i] == 2; }  ///< event i must be held at zero at the end of that step
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
  Sequence<EventPlace> places_;  // data from before a restart, whose round-off must not cause a second event
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
