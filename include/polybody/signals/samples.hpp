#pragma once
/// \file
/// Samples of one quantity at increasing times, and the root mean square difference of two histories.
/// Theory: Eq. 11.24.

#include <algorithm>
#include <cmath>
#include <span>
#include <string>

#include <polybody/math/types.hpp>

namespace polybody {

/// Samples of one quantity in the order of time.
struct Samples {
  std::span<double const> times;   ///< times [s]
  std::span<double const> values;  ///< values, one per time
};

namespace detail {

/// Requires at least `least` finite samples, one for each time, and increasing times. \throws InvalidInput otherwise.
template <class = void>
void require_history(std::span<double const> times, std::span<double const> values, std::size_t least,
                     std::string const& who) {
  if (times.size() != values.size())
    throw InvalidInput("samples.size", {ErrorObject{who}, ": there are ", times.size(), " times, but ",
                                        ErrorValue{values.size()}, " values."});
  if (values.size() < least)
    throw InvalidInput("samples.too_few", {ErrorObject{who}, ": at least ", least,
                                           " samples are needed, but there are ", ErrorValue{values.size()}, "."});
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!std::isfinite(values[i]) || !std::isfinite(times[i]))
      throw InvalidInput("samples.not_finite", {ErrorObject{who}, ": sample ", i, " at t = ", ErrorTime{times[i]},
                                                " s is not finite; samples are counted from 0."});
    if (i > 0 && !(times[i] > times[i - 1]))
      throw InvalidInput("samples.not_increasing", {ErrorObject{who}, ": the times must increase, but t = ",
                                                    ErrorTime{times[i]}, " s follows ", times[i - 1], " s."});
  }
}

}  // namespace detail

/// Relative root mean square difference (Σ(a − b)² / Σb²)^½ of the histories a and b. The sums are over the samples of
/// b in a range of time; samples of b outside the times of a are skipped. Vectors are added component by component:
///   RmsDifference d(1.0, 10.0);
///   d.add({ta, ax}, {tb, bx});
///   d.add({ta, ay}, {tb, by});
///   d.value()
/// The history a is interpolated linearly. The times of a may differ from those of b, as in a run with half the step.
class RmsDifference {
 public:
  /// Difference over the samples from `from` to `to` [s].
  RmsDifference(double from, double to) : from_(from), to_(to) {}

  /// Adds the histories a and b of one component. \throws InvalidInput for histories that are empty, with different
  /// numbers of times and values, times that do not increase, or a number that is not finite.
  void add(Samples const& a, Samples const& b) {
    detail::require_history(a.times, a.values, 1, "RmsDifference");
    detail::require_history(b.times, b.values, 1, "RmsDifference");
    double const rounding = 1e-9 * (a.times.back() - a.times.front());
    for (std::size_t i = 0, k = 0; i < b.times.size(); ++i) {
      double const t = b.times[i];
      if (t < from_ || t > to_ || t < a.times.front() - rounding || t > a.times.back() + rounding) continue;
      while (k + 2 < a.times.size() && a.times[k + 1] <= t) ++k;
      std::size_t const next = std::min(k + 1, a.times.size() - 1);
      double const part = next == k ? 0.0 : std::clamp((t - a.times[k]) / (a.times[next] - a.times[k]), 0.0, 1.0);
      double const off = a.values[k] + part * (a.values[next] - a.values[k]) - b.values[i];
      off_ += off * off;
      all_ += b.values[i] * b.values[i];
      ++samples_;
    }
  }
  /// Number of compared samples of b.
  std::size_t samples() const { return samples_; }
  /// Relative difference [1]. \throws InvalidInput if no sample was compared, or if b is zero in all of them.
  double value() const {
    if (samples_ == 0)
      throw InvalidInput("samples.too_few",
                         {ErrorObject{"RmsDifference"}, ": the second history has no sample between ", from_, " s and ",
                          to_, " s within the times of the first."});
    if (all_ == 0.0)
      throw InvalidInput("samples.zero", {ErrorObject{"RmsDifference"}, ": the reference history is zero at all ",
                                          samples_, " samples, so a relative difference does not exist."});
    return std::sqrt(off_ / all_);
  }

 private:
  double from_, to_, off_ = 0.0, all_ = 0.0;
  std::size_t samples_ = 0;
};

}  // namespace polybody
