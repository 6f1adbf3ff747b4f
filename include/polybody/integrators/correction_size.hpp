#pragma once
/// \file
/// How large a correction of Newton's method is, beside what is tolerated, where parts of it have other units than the
/// accelerations.

#include <algorithm>
#include <limits>

#include <polybody/solvers/newton.hpp>

namespace polybody::detail {

/// What rounding of q leaves of a correction that moves q by s times as much.
inline double rounding_of(VecX const& q, double s) {
  return 30.0 * std::numeric_limits<double>::epsilon() * (1.0 + largest_size(q)) / s;
}

/// First-order states, the last `count` of the speeds `v` with their rates. Each has a unit of its own.
struct StatesInStep {
  Index count;
  VecX const &v, &rate;
  double s;  ///< a correction of the rates moves the states by s times as much

  /// Joins corrections y of the rates to those of the accelerations: each is measured beside tolerance (1 + |z| + |ż|)
  /// of its own state, and beside what rounding of z leaves.
  CorrectionSize join(CorrectionSize size, double tolerance, double const* y) const {
    double worst = 0.0;
    for (Index i = v.size() - count; i < v.size(); ++i) {
      double const z = std::abs(v[i]), rounding = 30.0 * std::numeric_limits<double>::epsilon() * z / s;
      worst = std::max(worst, std::abs(y[i]) / (tolerance * (1.0 + z + std::abs(rate[i])) + rounding));
    }
    if (count > 0) size.norm = std::hypot(size.norm, worst * size.tolerated);
    return size;
  }
};

}  // namespace polybody::detail
