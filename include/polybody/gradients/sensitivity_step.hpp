#pragma once
/// \file
/// Inputs for propagating forward sensitivities over one time step.
///
/// Not in polybody.hpp: few programs need derivatives of whole runs.

#include <polybody/gradients/run_sensitivity.hpp>

namespace polybody::detail {

/// Direction of differentiation of a step: number j of the parameter, derivative `tangent` of the run, derivative dh of
/// the step length.
struct TangentColumn {
  std::size_t j;
  RunSensitivity* tangent;
  double dh;
};

/// Completed step of a run.
struct SensitivityStep {
  State& before;       ///< state at the start of the step
  State const& after;  ///< state at the end of the step
  double h;            ///< length of the step [s]
  bool searched;       ///< true if an event search computed other steps after this one
};

}  // namespace polybody::detail
