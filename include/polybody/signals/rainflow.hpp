#pragma once
/// \file
/// Fatigue damage of a stress history: cycles by rainflow counting [ASTM E1049-85, §5.4.4] and their damage.
/// Theory: Eqs. 11.25, 11.26.

#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include <polybody/math/types.hpp>

namespace polybody {

/// Turning points of a history: peaks, valleys, and the first and the last sample. Of consecutive equal samples the
/// first is used. \throws InvalidInput for a sample that is not finite.
template <class = void>
std::vector<double> turning_points(std::span<double const> history) {
  std::vector<double> points;
  for (std::size_t i = 0; i < history.size(); ++i) {
    double const x = history[i];
    if (!std::isfinite(x))
      throw InvalidInput("samples.not_finite", {ErrorObject{"turning_points"}, ": sample ", i,
                                                " is not finite; samples are counted from 0."});
    if (!points.empty() && x == points.back()) continue;
    std::size_t const n = points.size();
    bool const goes_on = n > 1 && (x > points[n - 1]) == (points[n - 1] > points[n - 2]);
    if (goes_on)
      points.back() = x;
    else
      points.push_back(x);
  }
  return points;
}

/// Closed stress cycle, or half of a cycle.
struct StressCycle {
  double range;  ///< range from valley to peak, twice the amplitude [N/m²]
  double mean;   ///< mean stress [N/m²]
  double count;  ///< number of cycles: 1 or ½ [1]
};

/// Rainflow counting: cycles of a history, in the order in which they close. X is the last range and Y the one before
/// it. As soon as X ≥ Y,
///
/// - Y counts as a cycle, and its two points are removed from the history, unless Y begins the history;
/// - if Y begins the history, Y counts as half a cycle, and its first point is removed from the history.
///
/// Every range that remains at the end counts as half a cycle [ASTM E1049-85, §5.4.4].
/// \throws InvalidInput for a sample that is not finite.
template <class = void>
std::vector<StressCycle> rainflow(std::span<double const> history) {
  std::vector<StressCycle> cycles;
  std::vector<double> open;  // points that are not yet counted
  auto const count = [&](double from, double to, double how_often) {
    cycles.push_back({std::abs(to - from), 0.5 * (from + to), how_often});
  };
  for (double const point : turning_points(history)) {
    open.push_back(point);
    for (std::size_t n = open.size(); n > 2; n = open.size()) {
      double const a = open[n - 3], b = open[n - 2];
      if (std::abs(point - b) < std::abs(b - a)) break;
      count(a, b, n == 3 ? 0.5 : 1.0);
      if (n == 3) {
        open.erase(open.begin());
      } else {
        open.resize(n - 3);
        open.push_back(point);
      }
    }
  }
  for (std::size_t i = 1; i < open.size(); ++i) count(open[i - 1], open[i], 0.5);
  return cycles;
}

/// Histogram of the ranges of cycles: entry k counts the cycles with ranges in [k·width, (k + 1)·width).
/// \throws InvalidInput unless the width is positive, and if a range has 10⁷ widths or more.
template <class = void>
std::vector<double> binned(std::span<StressCycle const> cycles, double width) {
  require_positive(width, "binned: the width");
  constexpr double most = 1e7;
  std::vector<double> counts;
  for (StressCycle const& c : cycles) {
    if (!(c.range < most * width))
      throw InvalidInput("rainflow.width",
                         {ErrorObject{"binned"}, ": the width must exceed 1e-7 of each range, but is ",
                          ErrorValue{width}, " N/m² and a range is ", c.range, " N/m². Choose a larger width."});
    std::size_t const k = std::size_t(c.range / width);
    if (k >= counts.size()) counts.resize(k + 1, 0.0);
    counts[k] += c.count;
  }
  return counts;
}

/// S–N curve: number N of cycles of a range S until failure of a structural detail, N = N₀ (S₀/S)^m, a straight line on
/// logarithmic axes [Basquin 1910]. For welded details, S₀ is usually given at N₀ = 2e6, with m = 3.
struct Basquin {
  Required<double> range;     ///< S₀, from valley to peak [N/m²]
  Required<double> cycles;    ///< N₀ [1]
  Required<double> exponent;  ///< m [1]
  double limit = 0.0;         ///< ranges up to this limit cause no damage [N/m²]

  /// Number N of cycles of the range `of_range` [N/m²] until failure; infinite for ranges up to `limit`.
  double life(double of_range) const {
    return of_range > limit ? cycles * std::pow(range / of_range, exponent) : std::numeric_limits<double>::infinity();
  }
  /// \throws InvalidInput unless all values are positive; the limit may be zero.
  void check() const {
    require_positive(range, "Basquin: the range");
    require_positive(cycles, "Basquin: the number of cycles");
    require_positive(exponent, "Basquin: the exponent");
    require_not_negative(limit, "Basquin: the limit");
  }
};

/// Cumulative damage D = Σ n_i/N_i of a history. The detail endures 1/D such histories [Palmgren 1924; Miner 1945].
/// Mean stresses of cycles are neglected. \throws InvalidInput like `Basquin::check`.
template <class = void>
double damage(std::span<StressCycle const> cycles, Basquin const& curve) {
  curve.check();
  double sum = 0.0;
  for (StressCycle const& c : cycles) sum += c.count / curve.life(c.range);
  return sum;
}

}  // namespace polybody
