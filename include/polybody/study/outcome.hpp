#pragma once
/// \file
/// Results of a study at its points, and statistics of an output over the points of a sampled study.

#include <numeric>
#include <optional>

#include <polybody/study/points.hpp>

namespace polybody {

/// Output of a study: a number computed at each point.
struct StudyOutput {
  std::string head;       ///< name with unit: "error [m]"
  bool measured = false;  ///< true: the number differs between runs, such as a time

  /// Conversion of a head to an output.
  StudyOutput(char const* name) : head(name) {}  // NOLINT(google-explicit-constructor)
  /// Conversion of a head to an output.
  StudyOutput(std::string name) : head(std::move(name)) {}  // NOLINT(google-explicit-constructor)
  /// Output with the head `name`; `is_measured` marks a number that differs between runs.
  StudyOutput(std::string name, bool is_measured) : head(std::move(name)), measured(is_measured) {}
};

/// Output with this `head` whose number differs between runs, such as a time. Records and figures include this output.
/// `write_table` omits it, so that the table is bitwise identical for each run.
inline StudyOutput measured(std::string head) { return {std::move(head), true}; }

/// List of outputs with these `heads`, as in `outputs("error [m]", measured("cpu [s]"))`.
template <class... Heads>
std::vector<StudyOutput> outputs(Heads&&... heads) {
  return {StudyOutput(std::forward<Heads>(heads))...};
}

/// Result of a point: a number for each output, or the reason of a failure.
struct Outcome {
  std::vector<double> values{};  ///< values of the outputs, each in the unit of its head; empty after a failure
  std::string failure{};         ///< reason of a failure, one line; empty: no failure

  bool failed() const { return !failure.empty(); }  ///< true if the point failed
};

/// Results of a study; complete, or partial if points are unfinished.
struct StudyResults {
  Points points;                                   ///< points of the study
  std::vector<StudyOutput> outputs;                ///< outputs of the study
  std::vector<std::optional<Outcome>> outcomes{};  ///< outcomes in the order of the points; none if unfinished
  std::size_t resumed = 0;                         ///< number of points with an outcome of an earlier run
  bool torn = false;                               ///< true if an earlier run was killed while it wrote a line

  /// Number of points that have an outcome, including failures.
  std::size_t finished() const {
    return std::size_t(std::ranges::count_if(outcomes, [](auto const& o) { return o.has_value(); }));
  }
  /// Number of points whose outcome is a failure.
  std::size_t failed() const {
    return std::size_t(std::ranges::count_if(outcomes, [](auto const& o) { return o && o->failed(); }));
  }
  /// Returns true if every point has an outcome.
  bool complete() const { return finished() == points.size(); }

  /// Values of the parameter or output `name` at the points that are finished and not failed, in the order of the
  /// points. `name` is the name or the head of a parameter, or the head of an output.
  /// \throws InvalidInput if there is no such column.
  std::vector<double> column(std::string_view name) const {
    std::vector<double> values;
    auto const take = [&](auto const& value) {
      for (std::size_t i = 0; i < outcomes.size(); ++i)
        if (outcomes[i] && !outcomes[i]->failed()) values.push_back(value(i));
      return values;
    };
    for (std::size_t j = 0; j < points.columns().size(); ++j)
      if (points.columns()[j].name == name || points.columns()[j].head() == name)
        return take([&](std::size_t i) { return points.at(i, j); });
    for (std::size_t j = 0; j < outputs.size(); ++j)
      if (outputs[j].head == name) return take([&](std::size_t i) { return outcomes[i]->values[j]; });
    std::string all;
    for (Column const& column : points.columns()) all += '"' + column.head() + "\", ";
    for (StudyOutput const& output : outputs) all += '"' + output.head + "\", ";
    throw InvalidInput("study.no_column", {"study: no column \"", ErrorObject{name}, "\"; the columns are ",
                                           all.substr(0, all.size() - 2), "."});
  }
};

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
