#pragma once
/// \file
/// Options and result of `gradient`.
///
/// Not in polybody.hpp: few programs need derivatives of whole runs.

#include <string>
#include <vector>

#include <polybody/gradients/checkpointing.hpp>
#include <polybody/run/run_options.hpp>

namespace polybody {

/// Storage of the states of a run for the backward sweep.
struct GradientOptions {
  std::size_t snapshots = 0;  ///< largest number of stored states; zero: as many as fit into `memory`
  double memory = 1e9;        ///< memory limit of the snapshots if their number is not given [bytes]
};

/// Result of a run and its derivatives.
struct GradientResult {
  std::vector<std::string> parameters;  ///< names, with units
  double value = 0.0;                   ///< J, in the objective's unit
  VecX derivatives;                     ///< (parameters) dJ/dp [unit of J / unit of p]
  double left = 0.0;                    ///< largest relative change of a step's multipliers μ in the last correction
  CheckpointingReport reversal;         ///< number of steps, repeated steps and snapshots
  double snapshot_size = 0.0;           ///< memory of one snapshot [bytes]
  RunReport run;                        ///< report of the forward run
};

namespace detail {

/// Largest number of stored states. \param size size of one state [bytes]. \throws InvalidInput if not even one state
/// fits into the memory.
template <class = void>
std::size_t snapshots_of(GradientOptions const& options, double size) {
  if (options.snapshots > 0) return options.snapshots;
  if (!(options.memory >= size))
    throw InvalidInput("gradient.memory", {ErrorObject{"gradient"}, ": a snapshot of a state takes ", size,
                                           " bytes, but the allowed memory is ", ErrorValue{options.memory},
                                           " bytes. Increase `memory`."});
  return std::size_t(std::min(options.memory / size, 1e15));
}
/// Memory of a snapshot of x [bytes].
template <class = void>
double size_of_snapshot(State const& x) {
  return 8.0 * double(x.q.size() + x.v.size() + x.a.size() + x.lambda.size() + x.history.size());
}
/// Adds a warning for each parameter without effect on the objective.
template <class = void>
void warn_of_zeros(GradientResult& g) {
  for (std::size_t j = 0; j < g.parameters.size(); ++j)
    if (g.derivatives[Index(j)] == 0.0)
      g.run.add_warning("The objective does not depend on the parameter \"" + g.parameters[j] + "\".");
}

}  // namespace detail
}  // namespace polybody
