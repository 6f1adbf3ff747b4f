#pragma once
// Results of runs: means and ranges, differences, cycles of stress.
#include <polybody/signals/rainflow.hpp>
#include <polybody/signals/samples.hpp>

#include "stress_runs.hpp"

namespace chapter4 {

// Start of the plateau of the speed, or half of the end time of a shorter run [s].
inline double plateau(std::vector<double> const& times) { return times.back() > 8.6 ? 8.5 : 0.5 * times.back(); }

// Relative root mean square difference of the filtered strain or bending of two runs after the time `from` [s].
using Told = std::vector<double> const& (StressRuns::*)(std::size_t) const;
inline double off(Options const& o, StressRuns const& as, std::size_t i, StressRuns const& bs, std::size_t k,
                  double from, Told of = &StressRuns::raw, Told of_b = nullptr) {
  if (!of_b) of_b = of;
  std::vector<double> const a = as.filtered(i, (as.*of)(i), o.cut_off), b = bs.filtered(k, (bs.*of_b)(k), o.cut_off);
  RmsDifference d(from, o.end_time);
  d.add({as.filtered_times(i), a}, {bs.filtered_times(k), b});
  return d.value();
}

// Relative root mean square difference of unfiltered histories of two runs of a comparison, over a time interval [s].
inline double off_unfiltered(StressRuns const& runs, std::size_t i, std::size_t k, Told of, double from, double to) {
  RmsDifference d(from, to);
  d.add({runs.times(i), (runs.*of)(i)}, {runs.times(k), (runs.*of)(k)});
  return d.value();
}

inline double rms(std::vector<double> const& times, std::vector<double> const& x, double from) {
  double sum = 0.0, count = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i)
    if (times[i] >= from) sum += x[i] * x[i], ++count;
  return count > 0.0 ? std::sqrt(sum / count) : 0.0;
}

// Ranges and damage of the cycles of the unfiltered axial stress.
struct Ranges {
  double count = 0.0, largest = 0.0, equivalent = 0.0;  // number of cycles; largest and equivalent range [Pa]
};
inline constexpr double wohler_exponent = 3.0;  // exponent of weld details
inline Ranges ranges_of(std::vector<StressCycle> const& cycles) {
  Ranges r;
  double sum = 0.0;
  for (StressCycle const& c : cycles) {
    r.count += c.count;
    r.largest = std::max(r.largest, c.range);
    sum += c.count * std::pow(c.range, wohler_exponent);
  }
  if (r.count > 0.0) r.equivalent = std::pow(sum / r.count, 1.0 / wohler_exponent);
  return r;
}
inline std::vector<StressCycle> cycles_of(std::vector<double> stress) {
  for (double& s : stress) s *= m113::youngs_modulus;
  return rainflow(stress);
}

}  // namespace chapter4
