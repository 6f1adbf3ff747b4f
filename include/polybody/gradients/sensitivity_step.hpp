#pragma once
/// \file
/// A step that tangents of a run go along.
///
/// Not in polybody.hpp: few programs ask for derivatives of whole runs.

#include <polybody/gradients/run_sensitivity.hpp>

namespace polybody::detail {

/// A direction along which a step is differentiated: a parameter, what it does, and the slope of the step's length.
struct TangentColumn {
  std::size_t j;
  RunSensitivity* tangent;
  double dh;
};

/// A step that a run has taken.
struct SensitivityStep {
  State& before;       ///< at its start
  State const& after;  ///< at its end
  double h;            ///< its length [s]
  bool searched;       ///< others were tried after it
};

}  // namespace polybody::detail
