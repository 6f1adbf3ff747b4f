#pragma once
/// \file
/// How hard two bodies press on each other where they overlap by d > 0 and d grows at the rate ḋ. Never negative: they
/// do not stick together.

#include <polybody/math/dual.hpp>
#include <polybody/math/types.hpp>

namespace polybody {

/// N(d, ḋ) [N]; a slope ck ∂N/∂d + cd ∂N/∂ḋ, never negative; and its potential, ∫ N(d, 0) dd [J].
template <class N>
concept NormalForce = requires(N const law, double d, double rate, std::string const name) {
  { law.template force<double>(d, rate) } -> std::convertible_to<double>;
  { law.slope(d, rate, 1.0, 1.0) } -> std::convertible_to<double>;
  { law.template potential<double>(d) } -> std::convertible_to<double>;
  law.check(name);
};

namespace detail {
/// \throws InvalidInput unless 0 < e ≤ 1.
inline void require_restitution(double e, char const* of) {
  if (!(e > 0.0 && e <= 1.0))
    throw InvalidInput{of, ": the coefficient of restitution must lie above 0 and not above 1, but is ", e, "."};
}
/// The root of `f`, which falls from f(from) > 0, by halving.
template <class F>
double falling_root(F const& f, double from, double to) {
  for (int k = 0; k < 200 && to - from > 1e-16 * to; ++k) {
    double const middle = 0.5 * (from + to);
    (f(middle) > 0.0 ? from : to) = middle;
  }
  return 0.5 * (from + to);
}
}  // namespace detail

/// Spring and damper, N = max(0, k d + c ḋ) [thesis §3.6]. How much of its speed a body keeps does not depend on how
/// fast it came. A body that comes at v meets the force c v at once; with an `onset` the damper comes in over that
/// depth, c min(1, d/onset), and the force is continuous, as steps that are long beside an impact like it.
struct SpringDamperContact {
  Required<double> stiffness;  ///< k [N/m]
  double damping = 0.0;        ///< c [N s/m]
  double onset = 0.0;          ///< [m]

  /// The damper with which a body of `mass` [kg] on a spring of `stiffness` [N/m] that comes at v leaves at e v. With ζ
  /// = c/(2√(km)) = cos θ it leaves, where N = 0, after 2θ of its damped oscillation, so that e = exp(−2θ cot θ); for ζ
  /// = cosh η > 1, e = exp(−2η coth η). [derived; Schwager & Pöschel 2007 have the same in other words]
  static SpringDamperContact with_restitution(double stiffness, double mass, double e) {
    require_positive(stiffness, "SpringDamperContact: the stiffness");
    require_positive(mass, "SpringDamperContact: the mass");
    detail::require_restitution(e, "SpringDamperContact");
    double const lost = -std::log(e);
    double zeta = 0.0;
    if (lost >= 2.0) {
      zeta = std::cosh(
          detail::falling_root([&](double x) { return lost - 2.0 * (x > 0.0 ? x / std::tanh(x) : 1.0); }, 0.0, lost));
    } else if (lost > 0.0) {
      double const half = std::acos(0.0);
      zeta = std::cos(
          detail::falling_root([&](double x) { return (x > 0.0 ? 2.0 * x / std::tan(x) : 2.0) - lost; }, 0.0, half));
    }
    return {.stiffness = stiffness, .damping = 2.0 * zeta * std::sqrt(stiffness * mass)};
  }

  void check(std::string const& name) const {
    require_positive(stiffness, name, ": the contact stiffness");
    require_not_negative(damping, name, ": the contact damping");
    require_not_negative(onset, name, ": the onset of the contact damping");
  }
  bool is_lossless() const { return damping == 0.0; }  ///< an impact keeps its energy
  /// The force N ≥ 0 [N] at depth d [m] that grows at `rate` [m/s].
  template <StateScalar T>
  T force(T const& d, T const& rate) const {
    T const c = value_of(d) < onset ? T(d * (damping / onset)) : T(damping);
    T const n = d * stiffness.value + c * rate;
    return value_of(n) > 0.0 ? n : T(0.0);
  }
  /// ck ∂N/∂d + cd ∂N/∂rate. Where the damper comes in as the body leaves, that falls with d; the slope leaves it out.
  double slope(double d, double rate, double ck, double cd) const {
    bool const begins = d < onset;
    double const c = begins ? damping * d / onset : damping;
    if (stiffness * d + c * rate <= 0.0) return 0.0;
    return ck * (stiffness + (begins && rate > 0.0 ? damping * rate / onset : 0.0)) + cd * c;
  }
  /// The energy stored at depth d [m], without damping [J].
  template <StateScalar T>
  T potential(T const& d) const {
    return d * d * (0.5 * stiffness);
  }
};

/// Elastic spheres, N = (4/3) E* √R d^(3/2) [Hertz 1882; Johnson 1985, §4.2].
struct HertzContact {
  Required<double> modulus;  ///< E*, 1/E* = (1 − ν₁²)/E₁ + (1 − ν₂²)/E₂ [Pa]
  Required<double> radius;   ///< R, 1/R = 1/R₁ + 1/R₂ [m]

  double stiffness() const { return 4.0 / 3.0 * modulus * std::sqrt(radius.value); }  ///< [N/m^(3/2)]

  void check(std::string const& name) const {
    require_positive(modulus, name, ": the contact modulus");
    require_positive(radius, name, ": the contact radius");
  }
  bool is_lossless() const { return true; }  ///< an impact keeps its energy
  /// The force N ≥ 0 [N] at depth d [m].
  template <StateScalar T>
  T force(T const& d, T const&) const {
    using std::sqrt;
    return d * sqrt(d) * stiffness();
  }
  /// ck ∂N/∂d at depth d [m].
  double slope(double d, double, double ck, double) const { return ck * 1.5 * stiffness() * std::sqrt(d); }
  /// The energy stored at depth d [m] [J].
  template <StateScalar T>
  T potential(T const& d) const {
    using std::sqrt;
    return d * d * sqrt(d) * (0.4 * stiffness());
  }
};

/// N = max(0, K dⁿ (1 + D ḋ)) [Hunt & Crossley 1975]: the force begins and ends at zero, and faster impacts lose more.
struct HuntCrossleyContact {
  Required<double> stiffness;  ///< K [N/mⁿ]
  double exponent = 1.5;       ///< n, a ratio
  Required<double> damping;    ///< D [s/m]

  /// The damping with which a body that comes at `speed` v [m/s] leaves at e v, with K = `stiffness`
  /// [N/mⁿ] and n = `exponent` as given. From m v dv/dd = −K dⁿ(1 + D v), whatever m, K and n,
  ///   D v − ln(1 + D v) = −e D v − ln(1 − e D v).
  static HuntCrossleyContact with_restitution(double stiffness, double exponent, double e, double speed) {
    detail::require_restitution(e, "HuntCrossleyContact");
    require_positive(speed, "HuntCrossleyContact: the speed of the impact");
    if (e == 1.0) return {.stiffness = stiffness, .exponent = exponent, .damping = 0.0};
    auto const excess = [&](double y) { return (y - std::log1p(y)) + (e * y + std::log1p(-e * y)); };
    double const y = detail::falling_root([&](double x) { return excess(x); }, 0.5 * (1.0 - e), (1.0 - 1e-15) / e);
    return {.stiffness = stiffness, .exponent = exponent, .damping = y / speed};
  }

  void check(std::string const& name) const {
    require_positive(stiffness, name, ": the contact stiffness");
    require_not_negative(damping, name, ": the contact damping");
    if (!(exponent >= 1.0) || !std::isfinite(exponent))
      throw InvalidInput{name, ": the exponent of the overlap must be 1 or more, but is ", exponent, "."};
  }
  bool is_lossless() const { return damping == 0.0; }  ///< an impact keeps its energy
  /// The force N ≥ 0 [N] at depth d [m] that grows at `rate` [m/s].
  template <StateScalar T>
  T force(T const& d, T const& rate) const {
    using std::pow;
    T const factor = rate * damping.value + 1.0;
    return value_of(factor) > 0.0 ? T(pow(d, exponent) * factor * stiffness.value) : T(0.0);
  }
  /// ck ∂N/∂d + cd ∂N/∂rate.
  double slope(double d, double rate, double ck, double cd) const {
    double const factor = 1.0 + damping * rate, power = stiffness * std::pow(d, exponent - 1.0);
    return factor > 0.0 ? power * (ck * exponent * factor + cd * damping * d) : 0.0;
  }
  /// The energy stored at depth d [m], without damping [J].
  template <StateScalar T>
  T potential(T const& d) const {
    using std::pow;
    return pow(d, exponent + 1.0) * (stiffness / (exponent + 1.0));
  }
};

}  // namespace polybody
