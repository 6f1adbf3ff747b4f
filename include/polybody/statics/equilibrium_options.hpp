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
};

}  // namespace polybody
