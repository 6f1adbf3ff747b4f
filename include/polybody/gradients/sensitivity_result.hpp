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
  std::vector<MatX> derivatives;                 ///< (n) outputs × parameters, of `values` at the moving times
  std::vector<VecX>
      time_derivatives;  ///< (n) of `times` with respect to the parameters, in their units; nonzero after an
                         ///< event and at a moving breakpoint; the last one belongs to a terminal event
  double left = 0.0;     ///< largest relative change in the last correction of a step
  RunReport run;         ///< report of the run itself
};

namespace detail {

/// Adds a warning for each parameter without effect. \param affected by parameters: nonzero if it has an effect
template <class = void>
void warn_of_unused(std::vector<Parameter> const& parameters, std::vector<char> const& affected, RunReport& run) {
  for (std::size_t j = 0; j < parameters.size(); ++j)
    if (!affected[j]) run.add_warning("Nothing in the run depends on the parameter \"" + parameters[j].name + "\".");
}

}  // namespace detail
}  // namespace polybody
