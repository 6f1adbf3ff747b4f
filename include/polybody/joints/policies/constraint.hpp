#pragma once
#include <polybody/joints/policies/policy.hpp>

namespace polybody {

/// Ideal joint: a Lagrange multiplier enforces each constraint equation exactly. The generalised force of the joint is
/// −Gᵀλ [thesis Eq. 3.2–3.3].
struct Constraint {
  static constexpr char const* name = "Constraint";
  static constexpr bool adds_constraints = true;  ///< constraint equations with multipliers
};

}  // namespace polybody
