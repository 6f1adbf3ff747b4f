// Registered benchmarks: one for each combination, with the counters of a run.
#pragma once
#include <benchmark/benchmark.h>

#include <polybody/run/simulate.hpp>
#include <string>

namespace registered {

using polybody::Index;

/// Registers `measure(state)` under a name such as "step/robot_arm/Lrvf/Constraint/GeneralisedAlpha/elements:32".
/// An exception of the library becomes the error of this benchmark.
template <class F>
benchmark::internal::Benchmark* add(std::string const& name, F const& measure) {
  return benchmark::RegisterBenchmark(name.c_str(),
                                      [measure](benchmark::State& state) {
                                        try {
                                          measure(state);
                                        } catch (polybody::Error const& e) {
                                          state.SkipWithError(e.what());
                                        }
                                      })
      ->Unit(benchmark::kMicrosecond);
}

/// Sets the counters of one run: numbers of steps, Newton iterations and factorisations, and `unknowns` of a step. The
/// key "iterations" is that of Google Benchmark.
inline void count(benchmark::State& state, polybody::RunReport const& report, Index unknowns) {
  state.counters["steps"] = double(report.steps);
  state.counters["newton_iterations"] = double(report.iterations);
  state.counters["factorisations"] = double(report.factorisations);
  state.counters["unknowns"] = double(unknowns);
}

/// Sets a counter to the nanoseconds of one of `parts` equal parts of an iteration.
inline void count_ns(benchmark::State& state, std::string const& name, double parts) {
  using benchmark::Counter;
  state.counters[name] = Counter(1e-9 * parts, Counter::kIsIterationInvariantRate | Counter::kInvert);
}

/// Times `act(run)` for runs of `simulation()`, which is called outside the timing. Sets the counters of `count`.
template <class Make, class Act>
void time_runs(benchmark::State& state, Index unknowns, Make const& simulation, Act const& act) {
  for (auto _ : state) {
    state.PauseTiming();
    {
      auto run = simulation();
      state.ResumeTiming();
      act(run);
      state.PauseTiming();
      count(state, run.report(), unknowns);
    }
    state.ResumeTiming();
  }
}
/// Times complete runs.
template <class Make>
void time_runs(benchmark::State& state, Index unknowns, Make const& simulation) {
  time_runs(state, unknowns, simulation, [](auto& run) { run.run(); });
}

/// Name of an option as that of a type: "joint-coordinates" becomes "JointCoordinates".
inline std::string type_name(std::string const& option) {
  std::string out;
  for (std::size_t i = 0; i < option.size(); ++i)
    if (option[i] != '-') out += i == 0 || option[i - 1] == '-' ? char(std::toupper(option[i])) : option[i];
  return out;
}

inline int run(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}

}  // namespace registered
