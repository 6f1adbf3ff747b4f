#pragma once
/// \file
/// Scalar laws of stops: limits on one or both sides, bump stops and backlash. A stop pushes and never pulls.
/// Theory: Eqs. 9.18, 9.19.

#include <polybody/forces/normal_force.hpp>
#include <polybody/forces/scalar_force.hpp>

namespace polybody {

namespace detail {

/// Force of the stops at `lower` and `upper` by the normal force law N, in the direction of growing x.
template <StateScalar T, NormalForce N>
T force_of_stops(double lower, double upper, N const& stop, T const& x, T const& rate) {
  if (value_of(x) > upper) return -stop.template force<T>(x - upper, rate);
  if (value_of(x) < lower) return stop.template force<T>(lower - x, -rate);
  return T(0.0);
}

/// \throws InvalidInput unless lower < upper and one of them is finite and reachable by the coordinate.
[[gnu::cold]] inline void check_limits(double lower, double upper, std::string const& name, ScalarUnits const& unit) {
  if (!(lower < upper))
    throw InvalidInput("limit.order", {ErrorObject{name}, ": the lower limit must be less than the upper limit of ",
                                       upper, " ", unit.x, ", but is ", ErrorValue{lower}, " ", unit.x, "."});
  if (!std::isfinite(lower) && !std::isfinite(upper))
    throw InvalidInput("limit.missing", {ErrorObject{name},
                                         ": the lower limit or the upper limit must be finite, but "
                                         "they are ",
                                         ErrorValue{lower}, " and ", upper, " ", unit.x, "."});
  for (double const limit : {lower, upper})
    if (std::isfinite(limit) && !(std::abs(limit) < unit.largest))
      throw InvalidInput("limit.beyond_half_a_turn",
                         {ErrorObject{name}, ": the ", limit == lower ? "lower" : "upper",
                          " limit of an angle without full turns must lie between -pi and pi, but is ",
                          ErrorValue{limit}, " rad. Use OnTurns for limits beyond half a turn."});
}

/// Checks the stiffness and the damping of a stop.
inline void check_stop(SpringDamperContact const& stop, std::string const& name, ScalarUnits const& unit) {
  ScalarUnits::require_positive(stop.stiffness, unit.stiffness, name, ": the stiffness of the stop");
  ScalarUnits::require_not_negative(stop.damping, unit.damping, name, ": the damping of the stop");
  ScalarUnits::require_not_negative(stop.onset, unit.x, name, ": the onset of the damping");
}

}  // namespace detail

/// Stop at a lower limit l, at an upper limit u or at both. Beyond u the force is Q = −max(0, k (x − u) + c ẋ); beyond
/// l it is Q = max(0, k (l − x) − c ẋ). With an `onset`, the damping coefficient increases with the penetration, as in
/// `SpringDamperContact`, and the force is continuous. For a coefficient of restitution e of a body with the mass m,
/// `SpringDamperContact::with_restitution(k, m, e).damping` is the damping; for an angle, m is the moment of inertia.
struct Limit {
  double lower = -detail::endless;  ///< l [m] or [rad]; −∞: no lower limit
  double upper = detail::endless;   ///< u [m] or [rad]; ∞: no upper limit
  Required<double> stiffness;       ///< k [N/m] or [N m/rad]
  double damping = 0.0;             ///< c [N s/m] or [N m s/rad]
  double onset = 0.0;               ///< penetration from which the damping is full [m] or [rad]; 0: at first contact

  void check(std::string const& name, ScalarUnits const& unit) const {
    detail::check_limits(lower, upper, name, unit);
    detail::check_stop(stop(), name, unit);
  }
  bool is_lossless() const { return damping == 0.0; }  ///< true without damping
  /// Force Q [N] or [N m] at x [m] or [rad] with the rate `rate`.
  template <StateScalar T>
  T force(T const& x, T const& rate, double) const {
    return detail::force_of_stops(lower, upper, stop(), x, rate);
  }
  /// Energy stored in the stops at the coordinate x [J].
  template <StateScalar T>
  T potential(T const& x, double) const {
    T const above = detail::positive_part(T(x - upper)), below = detail::positive_part(T(lower - x));
    return (above * above + below * below) * (0.5 * stiffness);
  }

 private:
  SpringDamperContact stop() const { return {stiffness, damping, onset}; }
};

/// Play of a drive or a pin: no force within ½ b of the centre x₀, and a stop like `Limit` on both sides.
struct Backlash {
  Required<double> play;       ///< b [m] or [rad]: total free travel
  double centre = 0.0;         ///< x₀ [m] or [rad]
  Required<double> stiffness;  ///< k [N/m] or [N m/rad]
  double damping = 0.0;        ///< c [N s/m] or [N m s/rad]
  double onset = 0.0;          ///< penetration from which the damping is full [m] or [rad]; 0: at first contact

  void check(std::string const& name, ScalarUnits const& unit) const {
    ScalarUnits::require_positive(play, unit.x, name, ": the play");
    ScalarUnits::require_finite(centre, unit.x, name, ": the centre of the play");
    limit().check(name, unit);
  }
  bool is_lossless() const { return damping == 0.0; }  ///< true without damping
  /// Force Q [N] or [N m] at x [m] or [rad] with the rate `rate`.
  template <StateScalar T>
  T force(T const& x, T const& rate, double t) const {
    return limit().template force<T>(x, rate, t);
  }
  /// Energy stored in the stops at the coordinate x [J].
  template <StateScalar T>
  T potential(T const& x, double t) const {
    return limit().potential(x, t);
  }

 private:
  Limit limit() const { return {centre - 0.5 * play, centre + 0.5 * play, stiffness, damping, onset}; }
};

/// Bump stop at a lower limit, at an upper limit or at both, whose force is K dⁿ (1 + D ḋ) at the penetration d, never
/// negative. In a law on a distance or a translation, K has the unit N/mⁿ; on an angle, N m/radⁿ.
struct BumpStop {
  double lower = -detail::endless;  ///< lower limit [m] or [rad]; −∞: no lower limit
  double upper = detail::endless;   ///< upper limit [m] or [rad]; ∞: no upper limit
  Required<double> stiffness;       ///< K [N/mⁿ] or [N m/radⁿ]
  double exponent = 2.0;            ///< n [1], at least 1
  double damping = 0.0;             ///< D [s/m] or [s/rad]

  void check(std::string const& name, ScalarUnits const& unit) const {
    detail::check_limits(lower, upper, name, unit);
    stop().check(name, std::string_view(unit.x) == "rad");
  }
  bool is_lossless() const { return damping == 0.0; }  ///< true without damping
  /// Force Q [N] or [N m] at x [m] or [rad] with the rate `rate`.
  template <StateScalar T>
  T force(T const& x, T const& rate, double) const {
    return detail::force_of_stops(lower, upper, stop(), x, rate);
  }
  /// Energy stored in the stops at the coordinate x [J].
  double potential(double x, double) const {
    return stop().potential(x > upper ? x - upper : x < lower ? lower - x : 0.0);
  }

 private:
  HuntCrossleyContact stop() const { return {stiffness, exponent, damping}; }
};

using JointLimit = OnAngle<Limit>;        ///< stop on the angle of a joint, within (−π, π)
using TurnsLimit = OnTurns<Limit>;        ///< stop on the angle of a joint with its full turns
using SlideLimit = OnTranslation<Limit>;  ///< stop on the translation of a joint
using EndStop = OnDistance<Limit>;        ///< stop on the distance of two points

}  // namespace polybody
