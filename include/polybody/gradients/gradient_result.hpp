#pragma once
/// \file
/// What `gradient` is asked and answers.
///
/// Not in polybody.hpp: few programs ask for derivatives of whole runs.

#include <string>
#include <vector>

#include <polybody/gradients/checkpointing.hpp>
#include <polybody/run/run_options.hpp>

namespace polybody {

/// How the states of a run are kept for the way back.
struct GradientOptions {
  std::size_t snapshots = 0;  ///< states that are kept at a time at most; zero: as many as fit into `memory`
  double memory = 1e9;        ///< for snapshots where their count is not given [bytes]
};

/// A result of a run and its derivatives.
struct GradientResult {
  std::vector<std::string> parameters;  ///< names, with units
  double value = 0.0;                   ///< J, in the objective's unit
  VecX derivatives;                     ///< (parameters) dJ/dp, J's unit over the parameter's
  double left = 0.0;                    ///< the largest relative change by a last correction of a step's multipliers
  CheckpointingReport reversal;         ///< steps, those taken again, snapshots
  double snapshot_size = 0.0;           ///< memory of one snapshot [bytes]
  RunReport run;                        ///< of the steps as they were taken first
};

namespace detail {

/// States that are kept at a time. \param size of one [bytes]. \throws InvalidInput where none fits into the memory.
template <class = void>
std::size_t snapshots_of(GradientOptions const& options, double size) {
  if (options.snapshots > 0) return options.snapshots;
  if (!(options.memory >= size))
    throw InvalidInput("gradient.memory",
                       {ErrorObject{"gradient"}, ": a snapshot of a state takes ", size,
                        " bytes, but the allowed memory is ", ErrorValue{options.memory}, " bytes. Increase it."});
  return std::size_t(std::min(options.memory / size, 1e15));
}
/// Memory of a snapshot of x [bytes].
template <class = void>
double size_of_snapshot(State const& x) {
  return 8.0 * double(x.q.size() + x.v.size() + x.a.size() + x.lambda.size() + x.history.size());
}
/// Warns of a parameter that the objective does not depend on.
template <class = void>
void warn_of_zeros(GradientResult& g) {
  for (std::size_t j = 0; j < g.parameters.size(); ++j)
    if (g.derivatives[Index(j)] == 0.0)
      g.run.add_warning("Nothing of the objective depends on the parameter \"" + g.parameters[j] + "\".");
}

}  // namespace detail
}  // namespace polybody
