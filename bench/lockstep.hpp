// Cost of stepping variants of a model in the lanes of one SIMD vector: the iterations of the slowest variant, and a
// factorisation if any variant needs one. The ratio of this cost to the cost of single runs is a bound of the gain.
#pragma once
#include <benchmark/benchmark.h>

#include <algorithm>
#include <polybody/math/simd_vector.hpp>
#include <string>
#include <vector>

namespace lockstep {

/// Counts of each step of a run.
struct Counts {
  std::vector<int> iterations, factorisations;
};

template <class Run>
Counts counts_of(Run& run) {
  Counts out;
  long iterations = 0, factorisations = 0;
  while (!run.done()) {
    run.advance();
    auto const& report = run.report();
    out.iterations.push_back(int(report.iterations - iterations));
    out.factorisations.push_back(int(report.factorisations - factorisations));
    iterations = report.iterations;
    factorisations = report.factorisations;
  }
  return out;
}

/// Sets counters of the cost of `runs` in 4 and in 8 lanes compared with single runs, per step: iterations and
/// factorisations of single runs and in lockstep, ratio of the work, and the largest possible gain.
/// \param iteration, factorisation time of one iteration and of one factorisation
inline void count(benchmark::State& state, std::vector<Counts> const& runs, double iteration, double factorisation) {
  std::size_t steps = runs.front().iterations.size();
  for (Counts const& run : runs) steps = std::min(steps, run.iterations.size());
  for (std::size_t const lanes : {4u, 8u}) {
    double mean_iterations = 0.0, mean_factorisations = 0.0, most_iterations = 0.0, any_factorisation = 0.0;
    for (std::size_t s = 0; s < steps; ++s) {
      int most = 0, any = 0;
      for (std::size_t k = 0; k < lanes; ++k) {
        mean_iterations += double(runs[k].iterations[s]) / double(lanes);
        mean_factorisations += double(runs[k].factorisations[s]) / double(lanes);
        most = std::max(most, runs[k].iterations[s]);
        any = std::max(any, runs[k].factorisations[s]);
      }
      most_iterations += most;
      any_factorisation += any;
    }
    double const n = double(steps), alone = mean_iterations * iteration + mean_factorisations * factorisation,
                 together = most_iterations * iteration + any_factorisation * factorisation;
    auto const set = [&](char const* what, double value) {
      state.counters[what + (" in " + std::to_string(lanes))] = value;
    };
    set("iterations", mean_iterations / n);
    set("factorisations", mean_factorisations / n);
    set("lockstep iterations", most_iterations / n);
    set("lockstep factorisations", any_factorisation / n);
    set("work", together / alone);
    set("gain", double(std::min<std::size_t>(lanes, polybody::simd_size)) * alone / together);
  }
}

}  // namespace lockstep
