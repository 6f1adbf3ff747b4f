#pragma once
/// \file
/// Line search along a correction of Newton's method.
/// Theory: Eq. 6.46.

#include <algorithm>
#include <cmath>

#include <polybody/math/compiler.hpp>

namespace polybody::detail {

/// Shortens a correction that overshoots. `slope(s)` evaluates the problem at the part s of the correction, and returns
/// the product of correction and right-hand side there, or NaN. The product decreases from `at_start` > 0. The search
/// ends if its magnitude is at most a tenth of `at_start`, or after twelve evaluations. It brackets the root by regula
/// falsi, with the modification of the Illinois algorithm [Dowell & Jarratt 1971]. \param at_end slope(1), already
/// evaluated; it is the first value. Returns the number of evaluations
template <class Slope>
int search_line(double at_start, double at_end, Slope&& slope) {
  double low = 0.0, high = 1.0, of_low = at_start, of_high = at_end, now = at_end;
  int count = 0, side = 0;
  while (!(std::abs(now) <= 0.1 * at_start) && count < 12) {
    if (!std::isfinite(of_high)) of_high = -at_start;
    double const width = high - low, share = of_low / (of_low - of_high);
    double const s = low + width * std::clamp(share, 0.05, 0.95);
    now = slope(s);
    ++count;
    if (now > 0.0) {
      low = s;
      of_low = now;
      if (side == 1) of_high *= 0.5;
      side = 1;
    } else {
      high = s;
      of_high = now;
      if (side == -1) of_low *= 0.5;
      side = -1;
    }
  }
  return count;
}

}  // namespace polybody::detail
