#pragma once
/// \file
/// Which states of a run are looked at.

#include <cmath>

#include <polybody/math/compiler.hpp>

namespace polybody {

/// The first state on or after each multiple of an interval from the start on; every state where the interval is zero.
class RunSampling {
 public:
  /// \param start [s] \param interval [s]
  RunSampling(double start, double interval) : start_(start), interval_(interval) {}

  /// Whether the state at t [s] is one of them; asked of each state once, in their order.
  bool takes(double t) {
    double const past = t - start_ + 1e-9 * interval_;
    if (past < (passed_ + 1.0) * interval_) return false;
    if (interval_ > 0.0) passed_ = std::floor(past / interval_);
    return true;
  }

 private:
  double start_, interval_, passed_ = 0.0;  // multiples of the interval that are past
};

}  // namespace polybody
