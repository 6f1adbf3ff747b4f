#pragma once
#include <algorithm>

#include <polybody/run/event_motion.hpp>

namespace polybody {

/// Step of a run, in which events are detected.
struct EventStep {
  /// Function that takes a step of at most the given length [s] and updates the state. Returns the length of the step
  /// [s].
  using Again = std::function<double(State&, double)>;

  State const& before;        ///< state at the start of the step
  double length;              ///< length of the step [s]
  Again const& again;         ///< takes a step from a state
  EventMotion const& motion;  ///< motion of the run near its states

  /// State h seconds after the start of the step.
  State after(double h) const {
    State x = before;
    while (x.t < before.t + h) {
      double const left = before.t + h - x.t;
      if (again(x, left) == left) break;
    }
    return x;
  }
  /// Length [s] within the step after which the event value has the opposite sign, although it has the sign `side` at
  /// both ends of the step; 0 if none is found. x is the state at the end of the step. The extremum of the value is
  /// estimated from its values and rates at the ends of an interval by a cubic, in at most five iterations.
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

}  // namespace polybody
