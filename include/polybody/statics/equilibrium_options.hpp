#pragma once
/// \file
/// What a search for an equilibrium is asked, and what it reports.

#include <string>
#include <vector>

#include <polybody/math/types.hpp>

namespace polybody {

/// How an equilibrium is sought.
struct EquilibriumOptions {
  int load_steps = 1;  ///< loads and gravity grow in so many equal parts
  double smallest_part =
      1e-4;  ///< a part of the load that fails is halved down to this; the next one is twice as large again
  double tolerance = 1e-11;  ///< of a correction, relative to 1 + max |q|
  int max_iterations = 50;   ///< in one part

  /// \throws InvalidInput unless counts lie in [1, 10⁶] and the other numbers are positive and finite.
  void check() const {
    require_count(load_steps, "equilibrium: load_steps");
    require_positive(smallest_part, "equilibrium: smallest_part");
    require_positive(tolerance, "equilibrium: the tolerance");
    require_count(max_iterations, "equilibrium: max_iterations");
  }
};

/// What the search for an equilibrium took.
struct EquilibriumReport {
  int parts = 0;       ///< in which the loads were applied
  int iterations = 0;  ///< of Newton's method
  /// Motions about the equilibrium that nothing resists and no load excites: body "payload" turns about (0, 0, 1)
  /// through (0, 0, -2). The search has moved along them as little as it could.
  std::vector<std::string> neutral = {};
  /// Joints and bodies with rows that repeat others, once for each such row: their multipliers are zero.
  std::vector<std::string> redundant = {};
  /// Number of negative eigenvalues of the tangent stiffness, symmetrised, on the motions that the constraint equations
  /// allow: 0 for a stable state; a state with one or more is unstable. −1: not counted, in models with first-order
  /// states, about a steady rotation, or beyond some 10⁵ coordinates of one long mechanism.
  int negative_pivots = 0;
  double limit_point = 0.0;  ///< load factor near which the path from the start turns back or branches; 0: none found
  bool relaxed = false;      ///< Newton's method did not converge; the state comes from a damped motion
  /// Sentences about an unstable state, and about a path of equilibria that is not the one from the start.
  std::vector<std::string> warnings = {};
};

}  // namespace polybody
