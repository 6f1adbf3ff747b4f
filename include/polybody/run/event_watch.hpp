#pragma once
/// \file
/// Events in a run: on which side of zero each stands, and where within a step one passes through.

#include <polybody/run/run_options.hpp>

namespace polybody {

/// What the events of a run know of it. A step is asked for through functions, so that this is compiled once for all
/// models.
class EventWatch {
 public:
  /// The user's state of a stepped one.
  using Seen = std::function<State const&(State const&)>;
  /// A step from a state, of at most so many seconds; the state moves along. Returns the length taken.
  using Step = std::function<double(State&, double)>;

  EventWatch() = default;
  /// Of events that stand on these sides.
  explicit EventWatch(std::vector<int> sides) : sides_(std::move(sides)) {}
  std::vector<int> const& sides() const { return sides_; }

  /// Notes on which sides the events stand at x. \throws NonFinite.
  void start(std::vector<Event> const& events, State const& x, Seen const& seen) {
    sides_.clear();
    for (Event const& event : events) sides_.push_back(side(event, x, seen));
  }

  /// Ends a step of length `taken` from `before` to x at the first event within it, by bisection on its length; the
  /// report hears which. Returns whether there was one.
  bool meet(std::vector<Event> const& events, State const& before, State& x, double taken, Seen const& seen,
            Step const& step, RunReport& report) {
    auto const after = [&](double h) {
      State trial = before;
      while (trial.t < before.t + h) {
        double const left = before.t + h - trial.t;
        if (step(trial, left) == left) break;
      }
      return trial;
    };
    auto const passed = [&](std::size_t i, State const& at) {
      return sides_[i] != 0 && side(events[i], at, seen) != sides_[i];
    };
    State first = x;
    bool met = false;
    for (std::size_t i = 0; i < sides_.size(); ++i) {
      if (!passed(i, x)) continue;
      met = true;
      double lo = 0.0, hi = taken;
      while (hi - lo > events[i].tolerance) {
        double const mid = 0.5 * (lo + hi);
        if (mid <= lo || mid >= hi) break;
        State trial = after(mid);
        if (!passed(i, trial)) {
          lo = mid;
          continue;
        }
        hi = mid;
        if (trial.t < first.t) first = std::move(trial);
      }
    }
    if (met) x = std::move(first);
    for (std::size_t i = 0; i < sides_.size(); ++i) {
      if (met && passed(i, x)) {
        report.events.push_back({events[i].name, x.t});
        report.stopped = report.stopped || events[i].stops;
      }
      sides_[i] = side(events[i], x, seen);
    }
    return met;
  }

 private:
  /// The sign of the event's value.
  static int side(Event const& event, State const& x, Seen const& seen) {
    double const y = event.value(seen(x));
    if (!std::isfinite(y))
      throw NonFinite("The event \"" + event.name + "\" is not finite at t = " + number(x.t) + " s.");
    return (y > 0.0) - (y < 0.0);
  }

  std::vector<int> sides_;  // at the end of the last step: each is met once, however a restart rounds
};

}  // namespace polybody
