#pragma once
/// \file
/// The relative root mean square difference of two histories. Not in polybody.hpp: few programs need it.

#include <algorithm>

#include <polybody/signals/samples.hpp>

namespace polybody {

/// (∫(a − b)² / ∫b²)^½ over the samples of b from one time to another; of vectors, component by component:
///   RmsDifference d(1.0, 10.0);
///   d.add({ta, ax}, {tb, bx});
///   d.add({ta, ay}, {tb, by});
///   d.value()
/// a is linear between its samples, so its times may differ from those of b, as in a run with half the step.
class RmsDifference {
 public:
  /// Samples from `from` to `to` [s] count.
  RmsDifference(double from, double to) : from_(from), to_(to) {}

  /// \throws InvalidInput for samples without as many times as values or with none, times that do not rise, or a number
  /// that is not finite.
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
  /// How many samples of b were compared.
  std::size_t samples() const { return samples_; }
  /// \throws InvalidInput when no sample was compared, or b is zero in all of them.
  double value() const {
    if (samples_ == 0)
      throw InvalidInput{"RmsDifference: there is no sample of both histories from ", from_, " to ", to_, " s."};
    if (all_ == 0.0) throw InvalidInput("RmsDifference: the history that differences are measured by is zero.");
    return std::sqrt(off_ / all_);
  }

 private:
  double from_, to_, off_ = 0.0, all_ = 0.0;
  std::size_t samples_ = 0;
};

}  // namespace polybody
