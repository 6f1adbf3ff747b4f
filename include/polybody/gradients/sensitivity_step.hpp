#pragma once
/// \file
/// Inputs for propagating forward sensitivities over one time step.
///
/// Not in polybody.hpp: few programs need derivatives of whole runs.

#include <polybody/gradients/run_sensitivity.hpp>

namespace polybody::detail {

/// Direction of differentiation of a step: number j of the parameter, derivative of the run, derivative of the step
/// length.
struct TangentColumn {
  std::size_t j;
  RunSensitivity* tangent;
  double dh;
};

/// Completed step of a run.
struct SensitivityStep {
  State& before;       ///< state at its start
  State const& after;  ///< state at its end
  double h;            ///< its length [s]
  bool searched;       ///< an event search computed other steps after it
};

}  // namespace polybody::detail
