#pragma once
/// \file
/// Dry friction along one coordinate of a joint: regularised, by a bristle after LuGre, and by an elasto-plastic
/// bristle. The laws are `ScalarLaw`s for `OnAngle`, `OnTurns` and `OnTranslation`; the force on b opposes the rate ẋ.
/// Theory: Eqs. 9.28, 9.29, 9.32, 9.35, 9.36.

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
  /// Force [N] or [N m] at the rate v.
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

/// Dry friction with the deflection z of a bristle, Q = −(σ₀ z + σ₁ ż + c v), ż = v (1 − α |z| sgn(v z)/z_ss) with z_ss
/// = g(v)/σ₀. LuGre friction has α = 1 [Canudas de Wit, Olsson, Åström & Lischinsky 1995]; below the break-away it
/// creeps under an oscillating load. With an `elastic_share` κ > 0 it is elasto-plastic friction [Dupont, Hayward,
/// Armstrong & Altpeter 2002], which neither creeps nor drifts: α = 0 if |z| ≤ z_ba = κ F_c/σ₀ or if z v < 0, α = 1 if
/// |z| ≥ z_ss, and α = ½ + ½ sin(π (|z| − ½ (z_ss + z_ba))/(z_ss − z_ba)) between.
struct LuGreFriction {
  static constexpr int states = 1;  ///< z [m] or [rad]

  FrictionCurve curve;         ///< friction in steady sliding; F_c must be positive
  Required<double> stiffness;  ///< σ₀ [N/m] or [N m/rad]
  Required<double> damping;    ///< σ₁ [N s/m] or [N m s/rad]
  double elastic_share = 0.0;  ///< κ in [0, 1), part of the sliding friction below which the bristle is elastic

  void check(std::string const& name, ScalarUnits const& units) const {
    curve.check(name, units);
    ScalarUnits::require_positive(curve.sliding, units.force, name, ": the sliding friction");
    ScalarUnits::require_positive(stiffness, units.stiffness, name, ": the bristle stiffness of the friction");
    ScalarUnits::require_not_negative(damping, units.damping, name, ": the bristle damping of the friction");
    if (!(elastic_share >= 0.0 && elastic_share < 1.0))
      throw InvalidInput("friction.elastic_share",
                         {ErrorObject{name}, ": the elastic share of the friction must lie in [0, 1), but is ",
                          ErrorValue{elastic_share}, "."});
  }
  /// Force [N] or [N m] at the rate v and the deflection z.
  template <StateScalar T>
  T force(T const&, T const& v, std::array<T, 1> const& z, double) const {
    return -(z[0] * stiffness.value + rate<T>(v, z[0]) * damping.value + v * curve.viscous);
  }
  /// Rate of the deflection z at the rate v.
  template <StateScalar T>
  std::array<T, 1> rates(T const&, T const& v, std::array<T, 1> const& z, double) const {
    return {rate<T>(v, z[0])};
  }
  /// Energy of the bristle, ½ σ₀ z² [J].
  double potential(double, std::array<double, 1> const& z, double) const { return 0.5 * stiffness * z[0] * z[0]; }
  /// Power of the plastic displacement, σ₀ z (v − ż) [W].
  double dissipation(double, double v, std::array<double, 1> const& z, double) const {
    return stiffness * z[0] * (v - rate<double>(v, z[0]));
  }

 private:
  template <StateScalar T>
  T rate(T const& v, T const& z) const {
    T const steady = curve.limit<T>(T(v * v)) / stiffness.value, size = value_of(z) < 0.0 ? T(-z) : z;
    bool const relaxes = value_of(z) * value_of(v) < 0.0;
    if (elastic_share == 0.0) return relaxes ? T(v + v * size / steady) : T(v - v * size / steady);
    double const elastic = elastic_share * curve.sliding / stiffness;
    if (relaxes || value_of(size) <= elastic) return v;
    T const plastic = v * size / steady;
    if (value_of(size) >= value_of(steady)) return v - plastic;
    using std::sin;
    T const phase = (size - (steady + elastic) * 0.5) / (steady - elastic);
    return v - plastic * (sin(T(phase * std::numbers::pi)) * 0.5 + 0.5);
  }
};

}  // namespace polybody
