#pragma once
/// \file
/// Derivatives by central differences, extrapolated to a step of zero.

#include <algorithm>
#include <cmath>
#include <limits>

#include <polybody/math/compiler.hpp>

namespace polybody::laws {

/// Derivative f′(0) of a function of one number; f returns a double or an Eigen vector. Central differences with the
/// steps h, h/2, …, h/16 are extrapolated to zero, and the value with the least estimated error is returned [Ridders
/// 1982]. The smallest step h/16 must be small compared with the length over which f changes.
template <class F>
auto slope_at_zero(F&& f, double h = 1e-3) {
  using Value = decltype(f(h));
  auto const size = [](Value const& x) {
    if constexpr (requires { x.norm(); })
      return double(x.norm());
    else
      return std::abs(double(x));
  };
  constexpr int steps = 5;
  Value row[steps], last[steps];  // extrapolations of order 0, 1, … with the current step, and without it
  Value best = Value((f(h) - f(-h)) / (2.0 * h));
  double least = std::numeric_limits<double>::infinity();
  last[0] = best;
  for (int i = 1; i < steps; ++i) {
    h /= 2.0;
    row[0] = Value((f(h) - f(-h)) / (2.0 * h));
    for (int j = 1; j <= i; ++j) {
      row[j] = Value(row[j - 1] + (row[j - 1] - last[j - 1]) / (std::ldexp(1.0, 2 * j) - 1.0));
      double const error = std::max(size(Value(row[j] - row[j - 1])), size(Value(row[j] - last[j - 1])));
      if (error < least) {
        least = error;
        best = row[j];
      }
    }
    std::copy(row, row + i + 1, last);
  }
  return best;
}

}  // namespace polybody::laws
