#pragma once
/// \file
/// Scalar laws of motors: direct-current motor, and torque by a table over speed. For `OnAngle` and `OnTurns`, and for
/// linear motors for `OnTranslation`.

#include <polybody/forces/scalar_force.hpp>
#include <polybody/math/monotone_table.hpp>
#include <polybody/math/time_functions.hpp>

namespace polybody {

/// Direct-current motor with the terminal voltage U, the current i and the gear ratio n:
///   L i˙ = U − R i − n K ẋ,   Q = n K i.
/// It is applied between the body that holds the stator and the driven body. A force element has no inertia. The exact
/// model of a geared rotor is a rigid body on a `Revolute`, which a `Gear` connects with the driven body; the motor
/// then acts on the rotor's joint with n = 1. Around a hinge with fixed axis the rotor's inertia J adds n² J.
template <TimeFunction Voltage = Constant>
struct DcMotor {
  static_assert(detail::require_time_function<Voltage>());
  static constexpr bool is_load = true;
  static constexpr int states = 1;  ///< current i [A]

  Voltage voltage;              ///< U(t) [V]
  Required<double> resistance;  ///< R [Ω]
  Required<double> inductance;  ///< L [H]
  Required<double> constant;    ///< K [N m/A], equal to the back electromotive force per speed [V s/rad]
  double gear_ratio = 1.0;      ///< n: turns of the rotor per turn of the joint; negative for opposite senses

  void check(std::string const& name, ScalarUnits const&) const {
    check_time_function(voltage, name + ": the voltage");
    ScalarUnits::require_not_negative(resistance, "ohm", name, ": the resistance");
    ScalarUnits::require_positive(inductance, "H", name, ": the inductance");
    ScalarUnits::require_positive(constant, "N m/A", name, ": the motor constant");
    if (!std::isfinite(gear_ratio) || gear_ratio == 0.0)
      throw InvalidInput(
          "motor.gear_ratio",
          {ErrorObject{name}, ": the gear ratio must be finite and not zero, but is ", ErrorValue{gear_ratio}, "."});
  }
  std::vector<double> breakpoints() const { return breakpoints_of(voltage); }  ///< breakpoints of the voltage [s]

  /// Torque Q [N m] at the current z.
  template <StateScalar T>
  T force(T const&, T const&, std::array<T, 1> const& z, double) const {
    return z[0] * (gear_ratio * constant);
  }
  /// Rate of the current z [A/s] at the speed `rate` of the joint.
  template <StateScalar T>
  std::array<T, 1> rates(T const&, T const& rate, std::array<T, 1> const& z, double t) const {
    double const u = Motion(voltage(t)).value;
    return {(u - z[0] * resistance.value - rate * (gear_ratio * constant)) / inductance.value};
  }
};

/// Motor with a torque that depends on the speed: Q = throttle(t) · M(ẋ), with a table of the torque M over the speed.
/// Beyond its ends the table continues linearly.
template <TimeFunction Throttle = Constant>
struct TorqueSpeedCurve {
  static_assert(detail::require_time_function<Throttle>());
  static constexpr bool is_load = true;

  MonotoneTable torque;    ///< M [N m] or [N] over ẋ [rad/s] or [m/s], at full throttle
  Throttle throttle = {};  ///< factor of the torque as a function of time

  void check(std::string const& name, ScalarUnits const&) const {
    check_time_function(throttle, name + ": the throttle");
  }
  std::vector<double> breakpoints() const { return breakpoints_of(throttle); }  ///< breakpoints of the throttle [s]

  /// Torque Q [N m] at the speed `rate`.
  template <StateScalar T>
  T force(T const&, T const& rate, double t) const {
    return torque(rate) * Motion(throttle(t)).value;
  }
};

}  // namespace polybody
