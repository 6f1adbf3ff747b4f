#pragma once
/// \file
/// Result of `sensitivities`: outputs of a run and their derivatives.
///
/// Not in polybody.hpp: few programs need derivatives of whole runs.

#include <polybody/gradients/parameter.hpp>
#include <polybody/run/run_options.hpp>

namespace polybody {

/// Outputs of a run and their derivatives.
struct SensitivityResult {
  std::vector<std::string> parameters, outputs;  ///< names, with units
  std::vector<double> times;                     ///< (n) start, and end of every step [s]
  std::vector<VecX> values;                      ///< (n) outputs
  /// (n) Derivatives (outputs × parameters) of `values` at `times`, which may change with the parameters.
  std::vector<MatX> derivatives;
  /// (n) Derivatives (parameters) of `times` [s / unit of the parameter]: nonzero after an event, and at a breakpoint
  /// that depends on a parameter. If a terminal event ends the run, the last one is that of the event.
  std::vector<VecX> time_derivatives;
  double left = 0.0;  ///< largest relative change in the last correction of a step
  RunReport run;      ///< report of the run itself
};

namespace detail {

/// Adds a warning for each parameter without effect. \param affected for each parameter: nonzero if it has an effect
template <class = void>
void warn_of_unused(std::vector<Parameter> const& parameters, std::vector<char> const& affected, RunReport& run) {
  for (std::size_t j = 0; j < parameters.size(); ++j)
    if (!affected[j]) run.add_warning("Nothing in the run depends on the parameter \"" + parameters[j].name + "\".");
}

}  // namespace detail
}  // namespace polybody
