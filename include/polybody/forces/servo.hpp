#pragma once
/// \file
/// Scalar laws of servos: P, PD and PID control with bounds of force, speed and rate. For `OnAngle`, `OnTurns`,
/// `OnTranslation` and `OnDistance`.

#include <limits>

#include <polybody/forces/scalar_force.hpp>
#include <polybody/math/time_functions.hpp>

namespace polybody {

namespace detail {

/// x limited to [−bound, bound]. The derivative is zero outside.
template <StateScalar T>
T limited(T const& x, double bound) {
  if (value_of(x) > bound) return T(bound);
  if (value_of(x) < -bound) return T(-bound);
  return x;
}
/// \throws InvalidInput unless the bound is positive; it may be infinite.
inline void require_bound(double bound, char const* unit, std::string const& name, char const* part) {
  if (!(bound > 0.0))
    throw InvalidInput("servo.bound", {ErrorObject{name}, part, " must be positive, but is ", ErrorValue{bound}, " ",
                                       unit, ". Use infinity for no bound."});
}
/// Checks the members that all servos have.
template <class S>
void check_servo(S const& servo, std::string const& name, ScalarUnits const& unit) {
  check_time_function(servo.target, name + ": the target");
  ScalarUnits::require_not_negative(servo.proportional_gain, unit.stiffness, name, ": the proportional gain");
  ScalarUnits::require_not_negative(servo.derivative_gain, unit.damping, name, ": the derivative gain");
  require_bound(servo.most_force, unit.force, name, ": the largest force");
  require_bound(servo.most_speed, unit.rate, name, ": the largest speed");
  if (std::isfinite(servo.most_speed) && servo.derivative_gain == 0.0)
    throw InvalidInput("servo.speed_bound",
                       {ErrorObject{name}, ": the derivative gain must be positive if the largest speed is finite, ",
                        "but is ", ErrorValue{0.0}, " ", unit.damping, ". It controls the speed."});
}
/// Force of a PD controller without bound of force [N] or [N m]: k_d (v − ẋ) with the commanded speed
/// v = ṙ + (k_p/k_d)(r − x), limited to [−most_speed, most_speed]; k_p (r − x) if k_d = 0.
template <class S, StateScalar T>
T servo_command(S const& servo, T const& x, T const& rate, Motion const& r) {
  T const error = r.value - x;
  if (servo.derivative_gain == 0.0) return error * servo.proportional_gain.value;
  double const speed_gain = servo.proportional_gain / servo.derivative_gain;
  T const speed = limited<T>(error * speed_gain + r.rate, servo.most_speed);
  return (speed - rate) * servo.derivative_gain.value;
}

}  // namespace detail

/// Servo with P or PD control: with the target r and the coordinate x, the force is
///   Q = k_p (r − x) + k_d (ṙ − ẋ),
/// limited to [−most_force, most_force]. The commanded speed ṙ + (k_p/k_d)(r − x) is limited to [−most_speed,
/// most_speed]. With k_p = 0 it is a speed servo, whose target provides the rate ṙ.
template <TimeFunction Target = Constant>
struct Servo {
  static_assert(detail::require_time_function<Target>());
  static constexpr bool is_load = true;

  Target target;                                                ///< r(t) [m] or [rad] with its rate
  Required<double> proportional_gain;                           ///< k_p [N/m] or [N m/rad]
  Required<double> derivative_gain;                             ///< k_d [N s/m] or [N m s/rad]; zero: P control
  double most_force = std::numeric_limits<double>::infinity();  ///< bound of |Q| [N] or [N m]
  double most_speed = std::numeric_limits<double>::infinity();  ///< bound of the commanded speed [m/s] or [rad/s]

  void check(std::string const& name, ScalarUnits const& unit) const { detail::check_servo(*this, name, unit); }
  std::vector<double> breakpoints() const { return breakpoints_of(target); }  ///< breakpoints of the target [s]

  /// Force Q [N] or [N m] at x [m] or [rad] with the rate `rate`.
  template <StateScalar T>
  T force(T const& x, T const& rate, double t) const {
    return detail::limited<T>(detail::servo_command<Servo, T>(*this, x, rate, target(t)), most_force);
  }
};

/// Servo with PID control, anti-windup by back-calculation [Åström & Hägglund 2006, §3.5]. With the integral part I and
/// the force Q₀ = k_p (r − x) + k_d (ṙ − ẋ) + I without bounds, the force Q is Q₀ with the bounds of `Servo`, and
///   İ = k_i (r − x) + (Q − Q₀)/T.
template <TimeFunction Target = Constant>
struct PidServo {
  static_assert(detail::require_time_function<Target>());
  static constexpr bool is_load = true;
  static constexpr int states = 1;  ///< integral part I [N] or [N m]

  Target target;                       ///< r(t) [m] or [rad] with its rate
  Required<double> proportional_gain;  ///< k_p [N/m] or [N m/rad]
  Required<double> integral_gain;      ///< k_i [N/(m s)] or [N m/(rad s)]
  Required<double> derivative_gain;    ///< k_d [N s/m] or [N m s/rad]
  Required<double> tracking_time;      ///< T [s]: time constant with which I returns from a bound
  double most_force = std::numeric_limits<double>::infinity();  ///< bound of |Q| [N] or [N m]
  double most_speed = std::numeric_limits<double>::infinity();  ///< bound of the commanded speed [m/s] or [rad/s]

  void check(std::string const& name, ScalarUnits const& unit) const {
    detail::check_servo(*this, name, unit);
    ScalarUnits::require_not_negative(integral_gain, (std::string(unit.stiffness) + "/s").c_str(), name,
                                      ": the integral gain");
    ScalarUnits::require_positive(tracking_time, "s", name, ": the tracking time");
  }
  std::vector<double> breakpoints() const { return breakpoints_of(target); }  ///< breakpoints of the target [s]

  /// Force Q [N] or [N m] at x [m] or [rad] with the rate `rate` and the integral part z.
  template <StateScalar T>
  T force(T const& x, T const& rate, std::array<T, 1> const& z, double t) const {
    return detail::limited<T>(detail::servo_command<PidServo, T>(*this, x, rate, target(t)) + z[0], most_force);
  }
  /// Rate of the integral part z [N/s] or [N m/s] at x [m] or [rad] with the rate `rate`.
  template <StateScalar T>
  std::array<T, 1> rates(T const& x, T const& rate, std::array<T, 1> const& z, double t) const {
    Motion const r = target(t);
    T const error = r.value - x;
    T const unbounded = error * proportional_gain.value + (r.rate - rate) * derivative_gain.value + z[0];
    return {error * integral_gain.value + (force<T>(x, rate, z, t) - unbounded) / tracking_time.value};
  }
};

/// Law L behind an actuator that builds up its force q with a lag τ and a bounded rate: with the force Q of the law,
/// q̇ = (Q − q)/τ, limited to [−most_rate, most_rate]. The force on the coordinate is q. The bounds of the law also
/// bound q. The integral part of a `PidServo` does not observe the bound of the rate.
template <ScalarLaw L>
struct RateLimited {
  static constexpr bool is_load = true;
  static constexpr int states = states_of<L>() + 1;  ///< those of the law, then the force q [N] or [N m]

  L law;                       ///< law that commands the force
  Required<double> most_rate;  ///< bound of |q̇| [N/s] or [N m/s]
  Required<double> lag;        ///< τ [s]

  void check(std::string const& name, ScalarUnits const& unit) const {
    law.check(name, unit);
    ScalarUnits::require_positive(lag, "s", name, ": the lag");
    detail::require_bound(most_rate, (std::string(unit.force) + "/s").c_str(), name, ": the largest rate of the force");
  }
  /// Breakpoints of the law [s].
  std::vector<double> breakpoints() const {
    if constexpr (requires { law.breakpoints(); })
      return law.breakpoints();
    else
      return {};
  }
  /// Initial states of the law, then the force of zero.
  std::array<double, std::size_t(states)> initial_states() const {
    std::array<double, std::size_t(states)> z{};
    if constexpr (requires { law.initial_states(); }) {
      auto const own = law.initial_states();
      std::copy(own.begin(), own.end(), z.begin());
    }
    return z;
  }
  /// Force q [N] or [N m], the last state of z.
  template <StateScalar T>
  T force(T const&, T const&, std::array<T, std::size_t(states)> const& z, double) const {
    return z.back();
  }
  /// Rates of the states z at x [m] or [rad] with the rate `rate`: those of the law, then q̇ [N/s] or [N m/s].
  template <StateScalar T>
  std::array<T, std::size_t(states)> rates(T const& x, T const& rate, std::array<T, std::size_t(states)> const& z,
                                           double t) const {
    std::array<T, std::size_t(states)> out;
    T command;
    if constexpr (states == 1) {
      command = law.template force<T>(x, rate, t);
    } else {
      std::array<T, std::size_t(states - 1)> own;
      std::copy(z.begin(), z.end() - 1, own.begin());
      command = law.template force<T>(x, rate, own, t);
      auto const own_rates = law.template rates<T>(x, rate, own, t);
      std::copy(own_rates.begin(), own_rates.end(), out.begin());
    }
    out.back() = detail::limited<T>((command - z.back()) / lag.value, most_rate);
    return out;
  }
};

}  // namespace polybody
