#pragma once
/// \file
/// Samples of one quantity at increasing times, the input of filters and comparisons of runs.
///
/// Not included in polybody.hpp: few programs need it.

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
      throw InvalidInput("samples.not_finite",
                         {ErrorObject{who}, ": sample ", i, " at t = ", ErrorTime{times[i]}, " s is not finite."});
    if (i > 0 && !(times[i] > times[i - 1]))
      throw InvalidInput("samples.not_increasing", {ErrorObject{who}, ": the times must increase, but t = ",
                                                    ErrorTime{times[i]}, " s follows ", times[i - 1], " s."});
  }
}

}  // namespace detail

}  // namespace polybody
