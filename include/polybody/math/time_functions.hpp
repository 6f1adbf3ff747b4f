#pragma once
/// \file
/// Functions of time with rate and acceleration, for driving constraints and loads.

#include <algorithm>
#include <array>
#include <concepts>
#include <limits>
#include <numbers>
#include <vector>

#include <polybody/math/types.hpp>

namespace polybody {

/// Prescribed value with its first and second derivative with respect to time.
struct Motion {
  double value = 0.0;         ///< prescribed value [m] or [rad]
  double rate = 0.0;          ///< first derivative [m/s] or [rad/s]
  double acceleration = 0.0;  ///< second derivative [m/s²] or [rad/s²]
};

/// Function of time t [s] that returns a Motion, for example a lambda.
template <class L>
concept TimeFunction = requires(L const law, double t) {
  { law(t) } -> std::convertible_to<Motion>;
};

namespace detail {
/// Refuses at compile time a `Law` that does not satisfy `TimeFunction`. Returns true.
template <class Law>
constexpr bool require_time_function() {
  static_assert(TimeFunction<Law>,
                "The law must be a function of time that returns a Motion. Write a lambda as "
                "[](double t) -> Motion { return {value, rate, acceleration}; }.");
  return true;
}
}  // namespace detail

/// Function of time with a member `breakpoints()`: times [s] at which the value or a derivative jumps. `simulate` ends
/// a step at each breakpoint.
template <class L>
concept HasBreakpoints = requires(L const law) {
  { law.breakpoints() } -> std::convertible_to<std::vector<double>>;
};

/// Calls `law.check(what)` if the law has this member; `what` begins the message. \throws InvalidInput for invalid
/// values.
template <TimeFunction Law>
void check_time_function(Law const& law, std::string const& what) {
  if constexpr (requires { law.check(what); }) law.check(what);
}

/// Breakpoints of the function of time `law` [s]; none if it has no member `breakpoints()`.
template <TimeFunction Law>
std::vector<double> breakpoints_of(Law const& law) {
  if constexpr (HasBreakpoints<Law>)
    return law.breakpoints();
  else
    return {};
}

/// Checks a function of time that prescribes a motion. \throws InvalidInput for invalid values, and if the value is
/// discontinuous at a breakpoint.
template <TimeFunction Law>
void check_driving_function(Law const& law, std::string const& what) {
  check_time_function(law, what);
  for (double const t : breakpoints_of(law)) {
    if (!std::isfinite(t)) continue;
    double const before = Motion(law(std::nextafter(t, -std::numeric_limits<double>::infinity()))).value;
    double const after = Motion(law(t)).value;
    if (!(std::abs(after - before) <= 1e-9 * (1.0 + std::abs(after))))
      throw InvalidInput("time_function.jump",
                         {ErrorObject{what}, ": the value jumps from ", before, " to ", ErrorValue{after}, " at t = ",
                          ErrorTime{t}, " s, but a body cannot jump. Use a Ramp or SmoothRamp instead of the jump."});
  }
}

/// Function of time with a known integral ∫ value dt from a fixed time.
template <class L>
concept HasIntegral = TimeFunction<L> && requires(L const law, double t) {
  { law.integral(t) } -> std::convertible_to<double>;
};

/// Integral ∫ value dt from t = 0: a displacement if `law` is a velocity, an angle if `law` is an angular velocity.
template <HasIntegral Law>
struct IntegralOf {
  Law law;  ///< integrand

  void check(std::string const& what) const { check_time_function(law, what); }
  /// Returns the integral as value, and the value and the rate of `law` as rate and acceleration.
  Motion operator()(double t) const {
    Motion const speed = law(t);
    return {law.integral(t) - law.integral(0.0), speed.value, speed.rate};
  }
  std::vector<double> breakpoints() const { return breakpoints_of(law); }  ///< breakpoints of `law` [s]
};

namespace detail {

inline void check_ramp(double target, double duration, double start, std::string const& what) {
  require_positive(duration, what, ": the duration", "s");
  require_finite(target, what, ": the target");
  require_finite(start, what, ": the start", "s");
}

}  // namespace detail

/// Ramp from 0 at `start` to `target` within `duration`, constant afterwards. Without `rounding` the rate is
/// discontinuous at both ends, which are the breakpoints. At a breakpoint the rate is that of the following piece.
///
/// With `rounding` w, a parabola replaces the ramp from w/2 before to w/2 after each end t₀. At the first end,
/// value = (target/duration) s²/(2w), s = t − t₀ + w/2. Only the acceleration is then discontinuous. After both
/// parabolas, value and integral equal those without rounding.
struct Ramp {
  Required<double> target;    ///< final value [m] or [rad]
  Required<double> duration;  ///< duration of the ramp [s]
  double start = 0.0;         ///< time at which the ramp begins [s]
  double rounding = 0.0;      ///< duration w of each parabola [s], at most `duration`

  void check(std::string const& what) const {
    detail::check_ramp(target, duration, start, what);
    require_not_negative(rounding, what, ": the rounding");
    if (rounding > duration)
      throw InvalidInput("time_function.rounding", {ErrorObject{what}, ": the rounding ", ErrorValue{rounding},
                                                    " s must not exceed the duration ", duration, " s."});
  }
  /// Value, rate and acceleration at t [s].
  Motion operator()(double t) const {
    if (t < start - 0.5 * rounding) return {};
    if (t >= start + duration + 0.5 * rounding) return {target, 0.0, 0.0};
    Motion const begin = rounded_kink(t - start), end = rounded_kink(t - start - duration);
    return {target * (begin.value - end.value) / duration, target * (begin.rate - end.rate) / duration,
            target * (begin.acceleration - end.acceleration) / duration};
  }
  /// Integral ∫ value dt from −∞ to t: [m s] or [rad s].
  double integral(double t) const {
    double const x = t - start, y = x - duration;
    if (y >= 0.5 * rounding) return target * 0.5 * (x + y);
    return target * (rounded_kink_integral(x) - rounded_kink_integral(y)) / duration;
  }
  /// Breakpoints [s]; none if `rounding` is positive.
  std::vector<double> breakpoints() const {
    if (rounding > 0.0) return {};
    return {start, start + duration};
  }

 private:
  /// max(0, x), with a parabola within w/2 of x = 0.
  Motion rounded_kink(double x) const {
    double const s = x + 0.5 * rounding;
    if (x >= 0.5 * rounding) return {x, 1.0, 0.0};
    if (s <= 0.0) return {};
    return {0.5 * s * s / rounding, s / rounding, 1.0 / rounding};
  }
  /// Integral of `rounded_kink`: s³/(6w) within the rounding, s = x + w/2; x²/2 + w²/24 above it.
  double rounded_kink_integral(double x) const {
    double const s = x + 0.5 * rounding;
    if (x >= 0.5 * rounding) return 0.5 * x * x + rounding * rounding / 24.0;
    return s <= 0.0 ? 0.0 : s * s * s / (6.0 * rounding);
  }
};

/// Smooth ramp from 0 to `target` within `duration`, with continuous rate and acceleration:
/// value = target (10 x³ − 15 x⁴ + 6 x⁵), x = (t − start)/duration.
struct SmoothRamp {
  Required<double> target;    ///< final value [m] or [rad]
  Required<double> duration;  ///< duration of the ramp [s]
  double start = 0.0;         ///< time at which the ramp begins [s]

  void check(std::string const& what) const { detail::check_ramp(target, duration, start, what); }
  /// Value, rate and acceleration at t [s].
  Motion operator()(double t) const {
    if (t < start) return {};
    if (t >= start + duration) return {target, 0.0, 0.0};
    double const d = duration, x = (t - start) / d, x2 = x * x;
    return {target * x2 * x * (10.0 - 15.0 * x + 6.0 * x2), target * 30.0 * x2 * (1.0 - 2.0 * x + x2) / d,
            target * 60.0 * x * (1.0 - 3.0 * x + 2.0 * x2) / (d * d)};
  }
  /// Integral ∫ value dt from −∞ to t: [m s] or [rad s].
  double integral(double t) const {
    double const d = duration, x = std::clamp((t - start) / d, 0.0, 1.0), x2 = x * x;
    return target * (d * x2 * x2 * (2.5 - 3.0 * x + x2) + std::max(0.0, t - start - d));
  }
};

/// Spin-up of Kane, Ryan & Banerjee 1987 from rest at t = 0 to the rate `speed` within `duration` T. The angle is
/// ψ = (speed/T)[t²/2 + (T/2π)²(cos(2πt/T) − 1)] for 0 ≤ t ≤ T, and ψ = speed (t − T/2) afterwards.
struct SpinUp {
  Required<double> speed;     ///< final rate [rad/s]
  Required<double> duration;  ///< duration T of the spin-up [s]

  void check(std::string const& what) const { detail::check_ramp(speed, duration, 0.0, what); }
  /// Angle ψ [rad], its rate and its acceleration at t [s].
  Motion operator()(double t) const {
    if (t <= 0.0) return {};
    double const period = duration;
    if (t >= period) return {speed * (t - 0.5 * period), speed, 0.0};
    double const w = 2.0 * std::numbers::pi / period;
    return {speed / period * (0.5 * t * t + (std::cos(w * t) - 1.0) / (w * w)),
            speed / period * (t - std::sin(w * t) / w), speed / period * (1.0 - std::cos(w * t))};
  }
};

/// Constant function of time, `value`.
struct Constant {
  double value = 1.0;  ///< value at all times; a factor if it scales a load

  void check(std::string const& what) const { require_finite(value, what, ": the value"); }
  Motion operator()(double) const { return {value, 0.0, 0.0}; }  ///< rate and acceleration are zero
  double integral(double t) const { return value * t; }          ///< integral from zero to t
};

/// Function of time of a load that is switched on and off: `value` for from ≤ t < to, otherwise zero.
struct Window {
  double from = 0.0;                                    ///< time of switching on [s]
  double to = std::numeric_limits<double>::infinity();  ///< time of switching off [s]
  double value = 1.0;                                   ///< value between `from` and `to`; a factor if it scales a load

  void check(std::string const& what) const {
    if (!(from < to) || !std::isfinite(value))
      throw InvalidInput("time_function.window",
                         {ErrorObject{what}, ": a window needs from < to and a finite value, but has from = ", from,
                          " s, to = ", to, " s, value = ", value, "."});
  }
  /// Returns `value` within the interval, otherwise zero. The rate is zero.
  Motion operator()(double t) const { return {t >= from && t < to ? value : 0.0, 0.0, 0.0}; }
  std::vector<double> breakpoints() const { return {from, to}; }  ///< both ends [s]
};

}  // namespace polybody
