#pragma once
/// \file
/// Where steps end: on the grid, at corners of drives and loads, at the end of the run.

#include <algorithm>
#include <cmath>
#include <limits>

#include <polybody/math/sequence.hpp>

namespace polybody {

/// Steps of one length in a row: they end at t₀ + k h, so that rounding does not add up.
struct StepRow {
  double start = 0.0, length = 0.0;  ///< t₀ and h [s]
  double count = 0.0;                ///< k, a count of the steps

  double end() const { return start + count * length; }  ///< time at which the last step ended [s]
  /// The end of a step from t that took `taken` seconds. One of another length, or from elsewhere, begins a row.
  double after(double t, double taken) {
    if (t != end() || taken != length) *this = {t, taken, 0.0};
    count += 1.0;
    return end();
  }
};

/// The corners of a run and what is left of it.
class StepPlan {
 public:
  /// The next step: where it may at most go, its length, whether it goes there, and whether a corner is there.
  struct Next {
    double target, h;   ///< time at which it may at most end [s]; its length [s]
    bool lands, jumps;  ///< it ends at `target`; a corner is there
  };

  StepPlan() = default;
  /// A run from `start` to `end_time` with steps of about `step` [s]; corners outside of it are left out.
  [[gnu::cold]] StepPlan(double start, double end_time, double step, Sequence<double> breakpoints)
      : until_(end_time), step_(step), breakpoints_(std::move(breakpoints)) {
    erase_if(breakpoints_, [&](double t) { return !(t > start) || !(t <= end_time); });
    sort_once(breakpoints_);
  }

  /// Passes the corners up to t, and those that differ from it by rounding only (0.3 and 0.1 + 0.2 are one). Returns t,
  /// or the time of the last corner passed or of the end where it is that within rounding.
  double pass(double t) {
    double const remainder_step = 1e-9 * step_ + rounding(t);
    while (next_ < breakpoints_.size() && breakpoints_[next_] <= t + remainder_step)
      t = std::max(t, breakpoints_[next_++]);
    return until_ - t <= remainder_step ? until_ : t;
  }

  std::size_t passed() const { return next_; }          ///< how many corners were passed
  void go_back(std::size_t passed) { next_ = passed; }  ///< to where that many corners were passed

  /// The step from t that would best be h long.
  Next next(double t, double h) const {
    bool const corner = next_ < breakpoints_.size();
    double const target = corner ? breakpoints_[next_] : until_, left = target - t;
    // A step may be 1 % longer than asked for, so that no tiny one is left: rows divided by its square would be
    // rounding errors.
    bool const lands = 1.01 * h >= left;
    if (lands && corner) return {target, until_just_before(target, t), true, true};
    // A last step that only rounding sets apart is as long as the others: a run that goes on later had it, too.
    return {target, lands && std::abs(left - h) > rounding(t) ? left : h, lands, false};
  }

 private:
  static double rounding(double t) { return 4.0 * std::numeric_limits<double>::epsilon() * std::abs(t); }
  /// The length of a step that ends just before a corner, where a law still has its old value.
  static double until_just_before(double corner, double t) {
    double h = std::nextafter(corner, t) - t;
    while (t + h >= corner) h = std::nextafter(h, 0.0);
    return h;
  }

  double until_ = 0.0, step_ = 0.0;
  Sequence<double> breakpoints_;
  std::size_t next_ = 0;
};

}  // namespace polybody
