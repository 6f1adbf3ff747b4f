#pragma once
/// \file
/// Friction of contacts as a function of slip velocity and normal force.
/// Theory: Eqs. 8.10, 8.11.

#include <cmath>
#include <concepts>
#include <string>

#include <polybody/math/types.hpp>

namespace polybody {

/// Regularised Coulomb friction −μ N v/√(v² + v_s²) at the slip velocity v. Bodies do not stick: under a tangential
/// force F < μ N they creep with v = v_s F/√(μ²N² − F²).
struct Friction {
  double coefficient = 0.0;  ///< coefficient of friction μ [1]
  double slip_speed = 0.0;   ///< v_s [m/s]; must be positive if μ is positive

  void check(std::string const& name) const {
    require_not_negative(coefficient, name, ": the coefficient of friction");
    if (coefficient > 0.0) require_positive(slip_speed, name, ": the slip speed of the friction", "m/s");
  }
  /// Ratio of friction force and slip velocity [N s/m]. \param speed2 squared slip velocity v² [m²/s²] \param n normal
  /// force N [N]
  template <class T>
  T resistance(T const& speed2, T const& n) const {
    using std::sqrt;
    return n * coefficient / sqrt(T(speed2 + slip_speed * slip_speed));
  }
  /// The ratio `resistance` for doubles, multiplied by `cd`; `speed2` [m²/s²] is the squared slip velocity, n [N] the
  /// normal force.
  double slope(double speed2, double n, double cd) const { return cd * coefficient * n / regularised_speed(speed2); }
  /// √(v² + v_s²) [m/s]; `speed2` [m²/s²] is the squared slip velocity v².
  double regularised_speed(double speed2) const { return std::sqrt(speed2 + slip_speed * slip_speed); }
};

/// Friction law of a contact without states: the ratio of friction force and slip velocity at a contact point.
/// Optional: `regularised_speed(speed2)`, if the friction is −μ N v/s with s² = v² + v_s² and a constant v_s. Steps
/// with a `ContactSet` then use the exact tangent of the friction.
template <class F>
concept SlipFriction = requires(F const law, double x) {
  { law.coefficient } -> std::convertible_to<double>;
  { law.template resistance<double>(x, x) } -> std::same_as<double>;
  { law.slope(x, x, x) } -> std::same_as<double>;
};

struct BristleFriction;

/// Friction law of a contact: a `SlipFriction`, or `BristleFriction`.
template <class F>
concept ContactFriction = std::same_as<F, BristleFriction> || SlipFriction<F>;

}  // namespace polybody
