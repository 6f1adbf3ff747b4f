#pragma once
/// \file
/// What the derivatives of a run are told in.
///
/// Not in polybody.hpp: few programs ask for derivatives of whole runs.

#include <polybody/gradients/parameter.hpp>
#include <polybody/run/run_options.hpp>

namespace polybody {

/// Outputs of a run and their derivatives.
struct SensitivityResult {
  std::vector<std::string> parameters, outputs;  ///< names, with units
  std::vector<double> times;                     ///< (n) the start and every step's end [s]
  std::vector<VecX> values;                      ///< (n) of the outputs
  std::vector<MatX> derivatives;                 ///< (n) outputs × parameters: of `values`, at times that move
  std::vector<VecX>
      time_derivatives;  ///< (n) of `times` by the parameters, with their units: not zero from an event on, or
                         ///< a corner that moves; the last one is that of an event which stops the run
  double left = 0.0;     ///< the largest relative change by a last correction of a step
  RunReport run;         ///< of the steps themselves
};

namespace detail {

/// Warns of parameters that nothing depends on. \param touched by parameters: something did
template <class = void>
void warn_of_untouched(std::vector<Parameter> const& parameters, std::vector<char> const& touched, RunReport& run) {
  for (std::size_t j = 0; j < parameters.size(); ++j)
    if (!touched[j]) run.add_warning("Nothing in the run depends on the parameter \"" + parameters[j].name + "\".");
}

}  // namespace detail
}  // namespace polybody
