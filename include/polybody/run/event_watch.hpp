#pragma once
/// \file
/// Events in a run: on which side of zero each stands, and where within a step one passes through.

#include <polybody/math/sequence.hpp>
#include <polybody/run/run_options.hpp>

namespace polybody {

/// On which side of zero the events of a run stand. A step is taken through a function, so that this is compiled once
/// for all models.
class EventWatch {
 public:
  /// The user's state of a stepped one.
  using Seen = std::function<State const&(State const&)>;
  /// Takes a step from a state, of at most so many seconds; the state moves along. Returns the length taken.
  using Step = std::function<double(State&, double)>;
  /// A step that a run has taken.
  struct Taken {
    State const& before;  ///< where it began
    double length;        ///< [s]
    Seen const& seen;     ///< makes the user's state
    Step const& again;    ///< takes another one from a state
  };

  EventWatch() = default;
  /// Events that stand on these sides.
  explicit EventWatch(Sequence<int> sides) : sides_(std::move(sides)) {}
  /// On which side of zero each event stands: −1, 0 or 1.
  Sequence<int> const& sides() const { return sides_; }

  /// Notes on which sides the events stand at x. \throws NonFinite.
  void start(std::vector<Event> const& events, State const& x, Seen const& seen) { look(events, x, seen, sides_); }

  /// Ends a step to x at the first event within it, by bisection on its length; the report names it. Returns
  /// whether there was one; without one, the last state that was shown is that of x.
  [[gnu::cold]] bool meet(std::vector<Event> const& events, Taken const& step, State& x, RunReport& report) {
    look(events, x, step.seen, now_);
    State first = x;
    bool met = false;
    met_.assign(sides_.size(), 0);
    for (std::size_t i = 0; i < sides_.size(); ++i) {
      if (!passed(i, now_[i])) continue;
      met = true;
      double lo = 0.0, hi = step.length;
      while (hi - lo > events[i].tolerance) {
        double const mid = 0.5 * (lo + hi);
        if (mid <= lo || mid >= hi) break;
        State trial = after(step, mid);
        if (!passed(i, side(events[i], step.seen(trial)))) {
          lo = mid;
          continue;
        }
        hi = mid;
        if (trial.t < first.t) first = std::move(trial);
      }
    }
    if (met) {
      x = std::move(first);
      look(events, x, step.seen, now_);
    }
    for (std::size_t i = 0; i < sides_.size(); ++i) {
      if (!passed(i, now_[i])) continue;
      met_[i] = 1;
      report.events.push_back({events[i].name, x.t});
      report.stopped = report.stopped || events[i].stops;
    }
    sides_.swap(now_);
    return met;
  }

  /// Whether event i was met in the step that was looked at last.
  bool met(std::size_t i) const { return i < met_.size() && met_[i] != 0; }
  /// Whether one of the `events` that was met changes the state.
  bool acts(std::vector<Event> const& events) const {
    for (std::size_t i = 0; i < events.size(); ++i)
      if (met(i) && events[i].then) return true;
    return false;
  }
  /// Those of the `events` that were met change x, a user's state, one after the other; then all stand where they are
  /// in it, those that changed it at zero. \throws InvalidInput where one leaves coordinates or speeds that are not
  /// finite.
  [[gnu::cold]] void act(std::vector<Event> const& events, State& x) {
    double const t = x.t;
    for (std::size_t i = 0; i < events.size(); ++i) {
      if (!met(i) || !events[i].then) continue;
      events[i].then(x);
      x.t = t;
      require_finite(x.q, "The coordinates after the event \"" + events[i].name + "\"");
      require_finite(x.v, "The speeds after the event \"" + events[i].name + "\"");
    }
    for (std::size_t i = 0; i < events.size(); ++i) sides_[i] = met(i) && events[i].then ? 0 : side(events[i], x);
  }

 private:
  /// The state h seconds after the beginning of a step.
  static State after(Taken const& step, double h) {
    State x = step.before;
    while (x.t < step.before.t + h) {
      double const left = step.before.t + h - x.t;
      if (step.again(x, left) == left) break;
    }
    return x;
  }
  /// An event that stood at zero at the end of the last step passes none.
  bool passed(std::size_t i, int now) const { return sides_[i] != 0 && now != sides_[i]; }
  /// On which sides the events stand at x, of which the user's state is made once.
  static void look(std::vector<Event> const& events, State const& x, Seen const& seen, Sequence<int>& sides) {
    sides.clear();
    if (events.empty()) return;
    State const& shown = seen(x);
    for (Event const& event : events) sides.push_back(side(event, shown));
  }
  /// The sign of the event's value at a state of the user's.
  static int side(Event const& event, State const& x) {
    double const y = event.value(x);
    if (!std::isfinite(y)) throw NonFinite{"The event \"", event.name, "\" is not finite at t = ", x.t, " s."};
    return (y > 0.0) - (y < 0.0);
  }

  Sequence<int> sides_;  // at the end of the last step: each is met once, however a restart rounds
  Sequence<int> now_, met_;
};

}  // namespace polybody
