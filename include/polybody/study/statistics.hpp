#pragma once
/// \file
/// Statistics of an output over the points of a sampled study.

#include <numeric>

#include <polybody/study/outcome.hpp>

namespace polybody {

/// Statistics of one output over the points with a value of this output.
struct Statistics {
  std::size_t count = 0;         ///< number n of points
  double mean = 0.0;             ///< mean, in the unit of the output
  double deviation = 0.0;        ///< standard deviation √(Σ(x − mean)²/(n − 1)), in the same unit
  std::vector<double> sorted{};  ///< (n) values in ascending order, in the same unit

  /// Quantile for the probability p in [0, 1], interpolated linearly: p = 0 gives the minimum, p = 0.5 the median.
  /// \throws InvalidInput for another p.
  double quantile(double p) const {
    if (!(p >= 0.0 && p <= 1.0))
      throw InvalidInput("statistics.quantile",
                         {"study: the probability of a quantile must lie in [0, 1], but is ", ErrorValue{p}, "."});
    double const place = p * double(count - 1);
    std::size_t const k = std::min(std::size_t(place), count - 1), next = std::min(k + 1, count - 1);
    return sorted[k] + (place - double(k)) * (sorted[next] - sorted[k]);
  }
};

/// Statistics of a `column` of the results `found`.
/// \throws InvalidInput for a column that does not exist or has less than two values.
template <class = void>  // compiled where it is used
Statistics statistics(StudyResults const& found, std::string_view column) {
  Statistics s{.sorted = found.column(column)};
  s.count = s.sorted.size();
  if (s.count < 2)
    throw InvalidInput("statistics.too_few",
                       {"study: statistics of \"", ErrorObject{column},
                        "\" need at least two points without failure, but there are ", ErrorValue{s.count}, "."});
  for (double const x : s.sorted) s.mean += x / double(s.count);
  double squares = 0.0;
  for (double const x : s.sorted) squares += (x - s.mean) * (x - s.mean);
  s.deviation = std::sqrt(squares / double(s.count - 1));
  std::ranges::sort(s.sorted);
  return s;
}

namespace detail {

/// Ranks 1 … n of the values x. Equal values have the mean of their ranks.
template <class = void>
std::vector<double> ranks_of(std::vector<double> const& x) {
  std::vector<std::size_t> order(x.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) { return x[a] < x[b]; });
  std::vector<double> ranks(x.size());
  for (std::size_t i = 0, j = 0; i < order.size(); i = j) {
    while (j < order.size() && x[order[j]] == x[order[i]]) ++j;
    for (std::size_t k = i; k < j; ++k) ranks[order[k]] = 0.5 * double(i + 1 + j);
  }
  return ranks;
}

}  // namespace detail

/// Spearman's rank correlation of the columns `one` and `other`, in [−1, 1]. The result measures the monotonic
/// dependence of the two columns, independent of the form of the curve. It is 0 if a column is constant.
/// \throws InvalidInput like `statistics`.
template <class = void>
double rank_correlation(StudyResults const& found, std::string_view one, std::string_view other) {
  std::vector<double> const a = detail::ranks_of(found.column(one)), b = detail::ranks_of(found.column(other));
  if (a.size() < 2)
    throw InvalidInput(
        "statistics.too_few",
        {"study: a correlation needs at least two points without failure, but has ", ErrorValue{a.size()}, "."});
  double const mean = 0.5 * double(a.size() + 1);
  double ab = 0.0, aa = 0.0, bb = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) {
    ab += (a[k] - mean) * (b[k] - mean);
    aa += (a[k] - mean) * (a[k] - mean);
    bb += (b[k] - mean) * (b[k] - mean);
  }
  return aa * bb > 0.0 ? ab / std::sqrt(aa * bb) : 0.0;
}

}  // namespace polybody
