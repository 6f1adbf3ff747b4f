#pragma once
/// \file
/// Scalar laws of springs and dampers, for `OnAngle`, `OnTurns`, `OnTranslation` and `OnDistance`.

#include <polybody/forces/scalar_force.hpp>

namespace polybody {

/// Linear spring and damper, Q = −(k (x − x₀) + c ẋ).
struct LinearSpring {
  Required<double> stiffness;  ///< k [N/m] or [N m/rad]
  double damping = 0.0;        ///< c [N s/m] or [N m s/rad]
  double free = 0.0;           ///< x₀ [m] or [rad]: coordinate at which the spring is free of load

  void check(std::string const& name, ScalarUnits const& unit) const {
    ScalarUnits::require_not_negative(stiffness, unit.stiffness, name, ": the spring stiffness");
    ScalarUnits::require_not_negative(damping, unit.damping, name, ": the damping");
    ScalarUnits::require_finite(free, unit.x, name, ": the free coordinate");
  }
  bool is_lossless() const { return damping == 0.0; }  ///< true without damping
  /// Force Q [N] or [N m] at x [m] or [rad] with the rate `rate`.
  template <StateScalar T>
  T force(T const& x, T const& rate, double) const {
    return (free - x) * stiffness.value - rate * damping;
  }
  /// Stored energy ½ k (x − x₀)² [J].
  template <StateScalar T>
  T potential(T const& x, double) const {
    T const e = x - free;
    return e * e * (0.5 * stiffness);
  }
};

/// Torsional spring and damper whose angle includes full turns.
using TorsionalSpringDamper = OnTurns<LinearSpring>;

}  // namespace polybody
