#pragma once
/// \file
/// Selection of the states of a run at a fixed interval of time.

#include <cmath>

#include <polybody/math/compiler.hpp>

namespace polybody {

/// Selects the first state at or after each positive multiple of an interval, counted from the start. The initial state
/// is not selected. If the interval is zero, every state is selected.
class RunSampling {
 public:
  /// \param start initial time [s] \param interval sampling interval [s]
  RunSampling(double start, double interval) : start_(start), interval_(interval) {}

  /// True if the state at t [s] is selected. Call this function once for each state, in order.
  bool takes(double t) {
    double const past = t - start_ + 1e-9 * interval_;
    if (past < (passed_ + 1.0) * interval_) return false;
    if (interval_ > 0.0) passed_ = std::floor(past / interval_);
    return true;
  }

 private:
  double start_, interval_, passed_ = 0.0;  // index of the last multiple of the interval that has passed
};

}  // namespace polybody
