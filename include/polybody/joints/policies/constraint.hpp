#pragma once
#include <polybody/joints/policies/policy.hpp>

namespace polybody {

/// Ideal joint: the rows hold exactly, with a Lagrange multiplier each; the joint's generalised force is
/// −Gᵀλ [thesis Eq. 3.2–3.3].
struct Constraint {
  static constexpr char const* name = "Constraint";
  static constexpr bool adds_constraints = true;  ///< rows with multipliers
};

}  // namespace polybody
