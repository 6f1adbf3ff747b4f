#pragma once
// Flexible rod in free flight through space (case D4).
#include <algorithm>
#include <cmath>
#include <vector>

#include <polybody/bodies/shared/bar.hpp>
#include <polybody/math/time_functions.hpp>

namespace polybody::flying_rod {

/// Triangular function of time: from 0 to 1 at `peak`, back to 0 at twice `peak`.
struct Triangle {
  double peak = 2.5;  ///< [s]
  Motion operator()(double t) const { return {std::max(0.0, 1.0 - std::abs(t / peak - 1.0)), 0.0, 0.0}; }
  std::vector<double> breakpoints() const { return {0.0, peak, 2.0 * peak}; }
};

/// Rod from (6, 0, 0) to (0, 8, 0). The section's inertia about its own x is the sum of the two others, 20.
inline Bar rod(double rotary_share = 1.0) {
  return {.length = 10.0,
          .constants = BarConstants{.EA = 1e4,
                                    .EI = 500,
                                    .mass_per_length = 1.0,
                                    .GA = 1e4,
                                    .GJ = 500,
                                    .rotary_inertia = 10.0 * rotary_share},
          .placement = Placement::planar(6.0, 0.0, std::atan2(8.0, -6.0))};
}

}  // namespace polybody::flying_rod
