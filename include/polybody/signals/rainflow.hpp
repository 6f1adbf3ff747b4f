#pragma once
/// \file
/// Fatigue of a history of stress: cycles by rainflow counting [ASTM E1049-85, §5.4.4], and the damage that they do.
/// Not in polybody.hpp: few programs need it.

#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include <polybody/math/types.hpp>

namespace polybody {

/// The peaks and valleys of a history, with its first and last sample; the first of equal samples in a row. \throws
/// InvalidInput for a NaN.
template <class = void>
std::vector<double> turning_points(std::span<double const> history) {
  std::vector<double> points;
  for (std::size_t i = 0; i < history.size(); ++i) {
    double const x = history[i];
    if (!std::isfinite(x)) throw InvalidInput{"turning_points: sample ", i, " is not finite."};
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

/// A closed cycle, or half of one.
struct StressCycle {
  double range;  ///< from valley to peak, twice the amplitude [N/m²]
  double mean;   ///< [N/m²]
  double count;  ///< a count: 1 or ½
};

/// The cycles of a history, in the order in which they close: with X the last range and Y the one before it, as soon as
/// X ≥ Y
///   Y counts as a cycle and its two points leave the history, or, where it begins the history,
///   Y counts as half a cycle and its first point leaves the history;
/// every range that is left at the end is half a cycle [ASTM E1049-85, §5.4.4].
/// \throws InvalidInput for a NaN.
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

/// Cycles by range: entry k counts those of ranges in [k·width, (k + 1)·width). \throws InvalidInput unless the width
/// is positive.
template <class = void>
std::vector<double> binned(std::span<StressCycle const> cycles, double width) {
  require_positive(width, "binned: the width");
  std::vector<double> counts;
  for (StressCycle const& c : cycles) {
    std::size_t const k = std::size_t(c.range / width);
    if (k >= counts.size()) counts.resize(k + 1, 0.0);
    counts[k] += c.count;
  }
  return counts;
}

/// How many cycles of a range S break the detail, N = N₀ (S₀/S)^m, a line in double logarithms [Basquin 1910]. For
/// details of welds it is usual to give S₀ at N₀ = 2e6, with m = 3.
struct Basquin {
  Required<double> range;     ///< S₀, from valley to peak [N/m²]
  Required<double> cycles;    ///< N₀
  Required<double> exponent;  ///< m, a ratio
  double limit = 0.0;         ///< ranges up to this do no damage [N/m²]

  /// N of the range `of_range`, infinite up to the limit.
  double life(double of_range) const {
    return of_range > limit ? cycles * std::pow(range / of_range, exponent) : std::numeric_limits<double>::infinity();
  }
  /// \throws InvalidInput unless all are positive, the limit at least zero.
  void check() const {
    require_positive(range, "Basquin: the range");
    require_positive(cycles, "Basquin: the number of cycles");
    require_positive(exponent, "Basquin: the exponent");
    require_not_negative(limit, "Basquin: the limit");
  }
};

/// The damage D = Σ n_i/N_i that a history does to a detail, which endures 1/D such histories [Palmgren 1924; Miner
/// 1945]. Mean stresses of cycles are neglected. \throws InvalidInput as `Basquin::check`.
template <class = void>
double damage(std::span<StressCycle const> cycles, Basquin const& curve) {
  curve.check();
  double sum = 0.0;
  for (StressCycle const& c : cycles) sum += c.count / curve.life(c.range);
  return sum;
}

}  // namespace polybody
