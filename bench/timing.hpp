#pragma once
// Times and flop rates of the benchmarks.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <functional>
#include <polybody/math/types.hpp>
#include <utility>
#include <vector>

namespace timing {

using polybody::Mat;

inline double microseconds(std::function<void()> const& act) {
  auto const start = std::chrono::steady_clock::now();
  act();
  return std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - start).count();
}

/// Smallest of `repeats` interleaved timings of each act [µs]. An act is a pair of functions: a preparation, and the
/// function that is timed. An untimed call precedes each timed call, so that the data are in the cache as within a run.
/// The minimum is used because other processes on the machine only increase times.
inline std::vector<double> fastest(std::vector<std::pair<std::function<void()>, std::function<void()>>> const& acts,
                                   int repeats) {
  std::vector<double> times(acts.size(), 1e30);
  for (int r = 0; r < repeats; ++r)
    for (std::size_t i = 0; i < acts.size(); ++i) {
      acts[i].first();
      acts[i].second();
      acts[i].first();
      times[i] = std::min(times[i], microseconds(acts[i].second));
    }
  return times;
}

/// Flops per µs of c −= aᵀ b with 6×6 matrices of Eigen that remain in the cache.
inline double eigen_rate() {
  std::vector<Mat<double, 6, 6>> a(16, Mat<double, 6, 6>::Random()), c(16, Mat<double, 6, 6>::Zero());
  constexpr int rounds = 200;
  double const time = fastest({{[] {},
                                [&] {
                                  for (int r = 0; r < rounds; ++r)
                                    for (std::size_t i = 0; i < 16; ++i)
                                      c[i].noalias() -= a[(i + 3) % 16].transpose() * a[(i + 7) % 16];
                                  benchmark::DoNotOptimize(c.data());
                                }}},
                              51)[0];
  return 2.0 * 216.0 * 16.0 * rounds / time;
}

}  // namespace timing
