#pragma once
/// \file
/// What an explicit step of variable length tolerates of its error.

#include <algorithm>
#include <cmath>

#include <polybody/math/types.hpp>

namespace polybody::detail {

struct ErrorTolerance {
  double absolute, relative;

  /// What is tolerated of each entry, relative to the largest of the first n, before the step and after.
  double of_all(VecX const& before, VecX const& after, Index n) const {
    double largest = 0.0;
    for (VecX const* const x : {&before, &after})
      for (Index i = 0; i < std::min(n, x->size()); ++i) largest = std::max(largest, std::abs((*x)[i]));
    return absolute + relative * largest;
  }
  /// What is tolerated of one entry, by its own size: for first-order states, each of which has a unit of its own.
  double of_one(double before, double after) const {
    return absolute + relative * std::max(std::abs(before), std::abs(after));
  }

  /// Mean square of the first n errors over what is tolerated of all.
  static double mean_square(VecX const& error, Index n, double tolerated) {
    double sum = 0.0;
    for (Index i = 0; i < n; ++i) sum += error[i] * error[i];
    return n > 0 ? sum / (tolerated * tolerated * double(n)) : 0.0;
  }
  /// Mean square of the errors from `first` on, each over its own tolerance.
  double mean_square_each(VecX const& error, VecX const& before, VecX const& after, Index first) const {
    double sum = 0.0;
    for (Index i = first; i < error.size(); ++i) {
      double const x = error[i] / of_one(before[i], after[i]);
      sum += x * x;
    }
    return error.size() > first ? sum / double(error.size() - first) : 0.0;
  }
};

}  // namespace polybody::detail
