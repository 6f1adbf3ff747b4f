#pragma once
/// \file
/// Map between the times of runs with breakpoints that depend on a parameter.
/// Theory: Eq. 8.27.

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include <polybody/gradients/parameter.hpp>

namespace polybody::detail {

/// Corresponding times of a run and of the four runs with perturbed parameter values. The start corresponds to the
/// start, and each breakpoint to the same breakpoint. Between two successive of these times, the map is linear. At
/// corresponding times, all runs evaluate a function of time on the same side of its breakpoint, for any shift of the
/// breakpoint. The differences are therefore smooth. The effect of the shift of time is subtracted afterwards.
class TimeMap {
 public:
  /// Start or breakpoint of the run, and the corresponding times of the four perturbed runs.
  struct Moving {
    double here;                                          ///< time of the run [s]
    std::array<double, FourPoints::places.size()> there;  ///< times of the perturbed runs [s]
  };

  TimeMap() = default;
  /// \param remainder_step times that differ by at most this value coincide [s]; \param who beginning of messages.
  /// \throws InvalidInput if times change their order in a perturbed run, or if coincident times separate.
  [[gnu::cold]] TimeMap(std::vector<Moving> times, Parameter const& p, double remainder_step, char const* who)
      : times_(std::move(times)), distance_(p.distance()) {
    std::sort(times_.begin(), times_.end(), [](Moving const& a, Moving const& b) { return a.here < b.here; });
    for (std::size_t i = 1; i < times_.size(); ++i)
      for (std::size_t k = 0; k < times_[i].there.size(); ++k) {
        Moving const &a = times_[i - 1], &b = times_[i];
        double const interval = b.here - a.here, perturbed_interval = b.there[k] - a.there[k];
        if (interval <= remainder_step &&
            std::abs(perturbed_interval - interval) > 1e-9 * remainder_step + 1e-14 * std::abs(b.here))
          throw InvalidInput(
              "derivative.coincident_times",
              {ErrorObject{who}, ": two breakpoints, or the start of the run and a breakpoint, coincide at t = ",
               ErrorTime{b.here}, " s, but a change of \"", p.name,
               "\" separates them; the run is not differentiable there. Let both times change equally "
               "with the parameter, or move one of them by at least one step."});
        if (interval > remainder_step && !(perturbed_interval > 0.0))
          throw InvalidInput("derivative.coincident_times",
                             {ErrorObject{who},
                              ": two breakpoints, or the start of the run and a breakpoint, at t = ", ErrorTime{a.here},
                              " s and ", b.here, " s, change their order within the difference step of \"", p.name,
                              "\". Set a smaller `scale` of this parameter."});
      }
    for (Moving const& m : times_)
      for (double const t : m.there) moves_ = moves_ || t != m.here;
  }

  bool moves() const { return moves_; }  ///< true if a time depends on the parameter

  /// Time of run k that corresponds to t.
  double operator()(std::size_t k, double t) const {
    if (!moves_) return t;
    auto const after =
        std::upper_bound(times_.begin(), times_.end(), t, [](double at, Moving const& m) { return at < m.here; });
    bool const first = after == times_.begin(), last = after == times_.end();
    Moving const &a = first ? *after : *std::prev(after), &b = last ? a : *after;
    if (!first && t == a.here) return a.there[k];
    double const at_a = a.there[k] - a.here, at_b = b.there[k] - b.here, interval = b.here - a.here;
    double there = t + at_a + (interval > 0.0 ? (at_b - at_a) * ((t - a.here) / interval) : 0.0);
    if (!first) there = std::max(there, a.there[k]);
    if (!last) there = std::min(there, std::nextafter(b.there[k], -std::numeric_limits<double>::infinity()));
    return there;
  }
  /// Derivative of the corresponding time with respect to the parameter [s / unit of the parameter].
  double slope(double t) const {
    double sum = 0.0;
    if (moves_)
      for (std::size_t k = 0; k < FourPoints::places.size(); ++k)
        sum += FourPoints::weights[k] / distance_ * ((*this)(k, t) - t);
    return sum;
  }

 private:
  std::vector<Moving> times_;
  double distance_ = 1.0;
  bool moves_ = false;
};

}  // namespace polybody::detail
