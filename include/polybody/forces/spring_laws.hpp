#pragma once
/// \file
/// Scalar laws of springs, dampers, ropes and winches, for `OnAngle`, `OnTurns`, `OnTranslation` and `OnDistance`.
/// Theory: Eqs. 9.10, 9.11, 9.13, 9.15, 9.16.

#include <polybody/forces/scalar_force.hpp>
#include <polybody/math/monotone_table.hpp>
#include <polybody/math/time_functions.hpp>

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

/// Spring and damper with two slopes each. The stiffness depends on the sign of x − x₀, and the damping on the sign of
/// ẋ: Q = −(k (x − x₀) + c ẋ). A suspension has such a damper.
struct TwoSlopeSpring {
  Required<double> stiffness_above;  ///< k for x > x₀ [N/m] or [N m/rad]
  Required<double> stiffness_below;  ///< k for x < x₀ [N/m] or [N m/rad]
  double damping_rising = 0.0;       ///< c for ẋ > 0 [N s/m] or [N m s/rad]
  double damping_falling = 0.0;      ///< c for ẋ < 0 [N s/m] or [N m s/rad]
  double free = 0.0;                 ///< x₀ [m] or [rad]: coordinate at which the spring is free of load

  void check(std::string const& name, ScalarUnits const& unit) const {
    ScalarUnits::require_not_negative(stiffness_above, unit.stiffness, name, ": the stiffness above");
    ScalarUnits::require_not_negative(stiffness_below, unit.stiffness, name, ": the stiffness below");
    ScalarUnits::require_not_negative(damping_rising, unit.damping, name, ": the damping rising");
    ScalarUnits::require_not_negative(damping_falling, unit.damping, name, ": the damping falling");
    ScalarUnits::require_finite(free, unit.x, name, ": the free coordinate");
  }
  bool is_lossless() const { return damping_rising == 0.0 && damping_falling == 0.0; }  ///< true without damping
  /// Force Q [N] or [N m] at x [m] or [rad] with the rate `rate`.
  template <StateScalar T>
  T force(T const& x, T const& rate, double) const {
    double const k = value_of(x) > free ? stiffness_above : stiffness_below;
    return (free - x) * k - rate * (value_of(rate) > 0.0 ? damping_rising : damping_falling);
  }
  /// Stored energy ½ k (x − x₀)² [J].
  template <StateScalar T>
  T potential(T const& x, double) const {
    T const above = detail::positive_part(T(x - free)), below = detail::positive_part(T(free - x));
    return above * above * (0.5 * stiffness_above) + below * below * (0.5 * stiffness_below);
  }
};

/// Spring by a table of the resisting force over the coordinate, with a linear damper: Q = −(f(x) + c ẋ).
struct TableSpring {
  MonotoneTable table;   ///< f [N] or [N m] over x [m] or [rad]
  double damping = 0.0;  ///< c [N s/m] or [N m s/rad]

  void check(std::string const& name, ScalarUnits const& unit) const {
    ScalarUnits::require_not_negative(damping, unit.damping, name, ": the damping");
  }
  bool is_lossless() const { return damping == 0.0; }  ///< true without damping
  /// Force Q [N] or [N m] at x [m] or [rad] with the rate `rate`.
  template <StateScalar T>
  T force(T const& x, T const& rate, double) const {
    return -(table(x) + rate * damping);
  }
  double potential(double x, double) const { return table.integral(x); }  ///< energy ∫₀ˣ f dx at x [J]
};

/// Damper by a table of the resisting force over the rate: Q = −f(ẋ). The table must pass through zero.
struct TableDamper {
  MonotoneTable table;  ///< f [N] or [N m] over ẋ [m/s] or [rad/s]

  /// \throws InvalidInput unless f(0) = 0: a damper without motion exerts no force.
  void check(std::string const& name, ScalarUnits const& unit) const {
    double const at_rest = table(0.0);
    if (!(std::abs(at_rest) <= 1e-12 * (1.0 + std::abs(table.slope(0.0)))))
      throw InvalidInput("table_damper.force_at_rest",
                         {ErrorObject{name}, ": the table of a damper must be zero at the rate zero, but is ",
                          ErrorValue{at_rest}, " ", unit.force, "."});
  }
  /// Force Q [N] or [N m] at the rate `rate`.
  template <StateScalar T>
  T force(T const&, T const& rate, double) const {
    return -table(rate);
  }
  double potential(double, double) const { return 0.0; }  ///< zero: a damper stores no energy
};

/// Spring by a function of the user, Q = −f(x, ẋ), for example a generic lambda. If F has a member `potential(x)`, the
/// law has this energy [J]. The energy audit otherwise counts the work of the law as that of a load.
template <class F>
struct FunctionSpring {
  F function;  ///< resisting force f(x, ẋ) [N] or [N m]

  void check(std::string const& name, ScalarUnits const&) const {
    if constexpr (requires { function.check(name); }) function.check(name);
  }
  /// Force Q [N] or [N m] at x [m] or [rad] with the rate `rate`.
  template <StateScalar T>
  T force(T const& x, T const& rate, double) const {
    return -T(function(x, rate));
  }
  double potential(double x, double) const
    requires requires(F const& f, double at) {
      { f.potential(at) } -> std::convertible_to<double>;
    }
  {
    return function.potential(x);  ///< energy of the function [J]
  }
};
/// Type of `FunctionSpring{function}`.
template <class F>
FunctionSpring(F) -> FunctionSpring<F>;

/// Rope that only pulls: tension N = max(0, k (x − L) + c ẋ) for x > L, zero otherwise; Q = −N.
struct Rope {
  Required<double> stiffness;  ///< k [N/m]: EA/L of a rope with the axial stiffness EA
  double damping = 0.0;        ///< c [N s/m]
  Required<double> length;     ///< L [m]: free length

  void check(std::string const& name, ScalarUnits const& unit) const {
    ScalarUnits::require_positive(stiffness, unit.stiffness, name, ": the stiffness of the rope");
    ScalarUnits::require_not_negative(damping, unit.damping, name, ": the damping of the rope");
    ScalarUnits::require_positive(length, unit.x, name, ": the free length of the rope");
  }
  bool is_lossless() const { return damping == 0.0; }  ///< true without damping
  /// Force Q [N] at the distance x [m] with the rate `rate`.
  template <StateScalar T>
  T force(T const& x, T const& rate, double) const {
    if (!(value_of(x) > length)) return T(0.0);
    return -detail::positive_part(T((x - length.value) * stiffness.value + rate * damping));
  }
  /// Stored energy ½ k (x − L)² of the taut rope [J].
  template <StateScalar T>
  T potential(T const& x, double) const {
    T const e = detail::positive_part(T(x - length.value));
    return e * e * (0.5 * stiffness);
  }
};

/// Cable on a winch, which only pulls. Its free length L(t) = L₀ − s(t) decreases by the reeled length s, a function of
/// time. The tension is N = max(0, EA (x − L)/L + c (ẋ − L̇)) for x > L, zero otherwise; Q = −N. The drum supplies or
/// absorbs the power of the reeled cable. The mass of the cable is neglected.
template <TimeFunction Law>
struct Winch {
  Required<double> axial_stiffness;  ///< EA [N]
  double damping = 0.0;              ///< c [N s/m]
  Required<double> length;           ///< L₀ [m]: free length for s = 0
  Law reeled;                        ///< s [m]; positive: cable on the drum

  void check(std::string const& name, ScalarUnits const& unit) const {
    ScalarUnits::require_positive(axial_stiffness, "N", name, ": the axial stiffness");
    ScalarUnits::require_not_negative(damping, unit.damping, name, ": the damping of the cable");
    ScalarUnits::require_positive(length, unit.x, name, ": the length of the cable");
    check_time_function(reeled, name + ": the reeled length");
  }
  std::vector<double> breakpoints() const { return breakpoints_of(reeled); }  ///< breakpoints of the reeled length [s]
  /// Free length L [m] as value, and its derivatives. \throws InvalidInput unless the free length is positive.
  Motion free_length(double t) const {
    Motion const s = reeled(t);
    if (!(length - s.value > 0.0))
      throw InvalidInput("winch.length",
                         {ErrorObject{"Winch"}, ": the value of the reeled length must be less than the length of ",
                          length.value, " m, but is ", ErrorValue{s.value}, " m at t = ", ErrorTime{t}, " s."});
    return {length - s.value, -s.rate, -s.acceleration};
  }
  /// Force Q [N] at the distance x [m] with the rate `rate` and the time t [s].
  template <StateScalar T>
  T force(T const& x, T const& rate, double t) const {
    Motion const free = free_length(t);
    if (!(value_of(x) > free.value)) return T(0.0);
    return -detail::positive_part(T((x - free.value) * (axial_stiffness / free.value) + (rate - free.rate) * damping));
  }
};

}  // namespace polybody
