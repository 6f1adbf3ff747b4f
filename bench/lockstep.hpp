// Cost of stepping variants of a model in the lanes of one SIMD vector: the iterations of the slowest variant, and a
// factorisation if any variant needs one. The ratio of this cost to the cost of single runs is a bound of the gain.
#pragma once
#include <algorithm>
#include <cstdio>
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

/// Prints the cost of `runs` in lanes compared with single runs.
/// \param iteration, factorisation time of one iteration and of one factorisation [µs]
inline void print(std::string const& what, std::vector<Counts> const& runs, double iteration, double factorisation) {
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
    std::printf("| %s | %zu | %.2f, %.2f | %.2f, %.2f | %.2f | %.1f |\n", what.c_str(), lanes, mean_iterations / n,
                mean_factorisations / n, most_iterations / n, any_factorisation / n, together / alone,
                double(std::min<std::size_t>(lanes, polybody::simd_size)) * alone / together);
  }
}

inline void print_head() {
  std::printf(
      "\n| variants that differ by | lanes | iterations, factorisations a step | in lockstep | work | gain at most, "
      "packs of %d |\n|---|---|---|---|---|---|\n",
      polybody::simd_size);
}

}  // namespace lockstep
