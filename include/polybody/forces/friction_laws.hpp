#pragma once
/// \file
/// Dry friction along one coordinate of a joint: regularised, by a bristle after LuGre, and by an elasto-plastic
/// bristle. The laws are `ScalarLaw`s for `OnAngle`, `OnTurns` and `OnTranslation`; the force on b opposes the rate ẋ.

#include <polybody/forces/scalar_force.hpp>

namespace polybody {

/// Friction in steady sliding at the speed v, Coulomb friction with a Stribeck curve [Armstrong-Hélouvry, Dupont &
/// Canudas de Wit 1994]: g(v) = F_c + (F_s − F_c) exp(−(v/v_s)²), and the viscous friction c v.
struct FrictionCurve {
  Required<double> sliding;     ///< F_c [N] or [N m], friction at high speed
  double break_away = 0.0;      ///< F_s ≥ F_c [N] or [N m], friction at the speed zero; 0 for F_s = F_c
  double stribeck_speed = 0.0;  ///< v_s [m/s] or [rad/s]; must be positive if F_s is not zero
  double viscous = 0.0;         ///< c [N s/m] or [N m s/rad]

  void check(std::string const& name, ScalarUnits const& units) const {
    ScalarUnits::require_not_negative(sliding, units.force, name, ": the sliding friction");
    ScalarUnits::require_not_negative(break_away, units.force, name, ": the break-away friction");
    ScalarUnits::require_not_negative(viscous, units.damping, name, ": the viscous friction");
    if (break_away == 0.0) return;
    ScalarUnits::require_positive(stribeck_speed, units.rate, name, ": the Stribeck speed of the friction");
    if (break_away < sliding)
      throw InvalidInput("friction.break_away",
                         {ErrorObject{name}, ": the break-away friction must be at least the sliding friction, ",
                          sliding.value, " ", units.force, ", but is ", ErrorValue{break_away}, " ", units.force, "."});
  }
  /// g(v) [N] or [N m] at the speed with the square `speed2`, without viscous friction.
  template <StateScalar T>
  T limit(T const& speed2) const {
    using std::exp;
    if (break_away == 0.0) return T(sliding.value);
    return exp(T(speed2 * (-1.0 / (stribeck_speed * stribeck_speed)))) * (break_away - sliding) + sliding.value;
  }
};

/// Regularised dry friction Q = −g(v) v/√(v² + v_0²) − c v. It creeps under a constant load, with v of the order of
/// v_0.
struct DryFriction {
  FrictionCurve curve;          ///< friction in steady sliding
  Required<double> slip_speed;  ///< v_0 [m/s] or [rad/s]

  void check(std::string const& name, ScalarUnits const& units) const {
    curve.check(name, units);
    ScalarUnits::require_positive(slip_speed, units.rate, name, ": the slip speed of the friction");
  }
  template <StateScalar T>
  T force(T const&, T const& v, double) const {
    using std::sqrt;
    T const speed2 = v * v;
    return v * (-curve.limit<T>(speed2) / sqrt(T(speed2 + slip_speed * slip_speed)) - curve.viscous);
  }
  /// Zero: friction stores no energy [J].
  template <StateScalar T>
  T potential(T const&, double) const {
    return T(0.0);
  }
};

/// Bristle of a friction law: its stiffness and damping.
struct Bristle {
  Required<double> stiffness;  ///< σ₀ [N/m] or [N m/rad]
  Required<double> damping;    ///< σ₁ [N s/m] or [N m s/rad]

  void check(std::string const& name, ScalarUnits const& units) const {
    ScalarUnits::require_positive(stiffness, units.stiffness, name, ": the bristle stiffness of the friction");
    ScalarUnits::require_not_negative(damping, units.damping, name, ": the bristle damping of the friction");
  }
};

namespace detail {
/// Friction law with the deflection z of one bristle, Q = −(σ₀ z + σ₁ ż + c v) with ż = v − p: p is the rate of the
/// plastic displacement, `Law::plastic`. \tparam Law the derived type
struct BristleLaw {
  static constexpr int states = 1;

  FrictionCurve curve;  ///< friction in steady sliding; must be positive
  Bristle bristle;      ///< stiffness and damping

  void check(std::string const& name, ScalarUnits const& units) const {
    curve.check(name, units);
    ScalarUnits::require_positive(curve.sliding, units.force, name, ": the sliding friction");
    bristle.check(name, units);
  }
};
}  // namespace detail

}  // namespace polybody
