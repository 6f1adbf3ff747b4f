#pragma once
/// \file
/// Normal force laws of contact, as functions of the penetration d > 0 and its rate ḋ. The force is never negative:
/// bodies do not adhere.
/// Theory: Eqs. 8.4 to 8.9, 9.19 to 9.23.

#include <polybody/math/dual.hpp>
#include <polybody/math/types.hpp>

namespace polybody {

/// Normal force law: force N(d, ḋ) [N], derivative and potential ∫₀ᵈ N(x, 0) dx [J]. The derivative ck ∂N/∂d + cd ∂N/∂ḋ
/// is never negative; ck and cd are given coefficients.
template <class N>
concept NormalForce = requires(N const law, double d, double rate, std::string const name) {
  { law.template force<double>(d, rate) } -> std::convertible_to<double>;
  { law.slope(d, rate, 1.0, 1.0) } -> std::convertible_to<double>;
  { law.template potential<double>(d) } -> std::convertible_to<double>;
  law.check(name);
};

namespace detail {
/// \throws InvalidInput unless 0 < e ≤ 1; `of` names the law.
inline void require_restitution(double e, char const* of) {
  if (!(e > 0.0 && e <= 1.0))
    throw InvalidInput(
        "contact.restitution",
        {ErrorObject{of}, ": the coefficient of restitution must lie in (0, 1], but is ", ErrorValue{e}, "."});
}
/// Root of the decreasing function `f` with f(from) > 0, by bisection.
template <class F>
double falling_root(F const& f, double from, double to) {
  for (int k = 0; k < 200 && to - from > 1e-16 * to; ++k) {
    double const middle = 0.5 * (from + to);
    (f(middle) > 0.0 ? from : to) = middle;
  }
  return 0.5 * (from + to);
}
}  // namespace detail

/// Spring and damper, N = max(0, k d + c ḋ) [thesis §3.6]. Without an `onset`, the coefficient of restitution is
/// independent of the impact velocity v, and the force jumps to c v at the first contact. With an `onset`, the damping
/// coefficient increases with the penetration, c min(1, d/onset), and the force is continuous. Steps that are
/// long compared with an impact require a continuous force.
struct SpringDamperContact {
  Required<double> stiffness;  ///< k [N/m]
  double damping = 0.0;        ///< c [N s/m]
  double onset = 0.0;          ///< penetration from which the damping is full [m]; 0 for full damping at first contact

  /// Damper with a given coefficient of restitution e: a body of `mass` [kg] on a spring of `stiffness` [N/m] arrives
  /// with the velocity v and departs with e v. With ζ = c/(2√(km)) = cos θ, the body departs when N = 0, after the
  /// phase 2θ of its damped oscillation, so that e = exp(−2θ cot θ). For ζ = cosh η > 1, e = exp(−2η coth η). [derived;
  /// Schwager & Pöschel 2007 give equivalent formulas] The equation is solved to rounding, for all velocities. The
  /// logarithmic decrement ζ = −ln e/√(π² + ln² e), which lets the contact pull, would yield 0.951, 0.718, 0.550 and
  /// 0.253 for e = 0.95, 0.7, 0.5 and 0.1. With an `onset` δ that is added to the result, the restitution of slow
  /// impacts approaches one: 1 − e ≈ (2/3) c v/(k δ) if v √(m/k) is small compared with δ.
  static SpringDamperContact with_restitution(double stiffness, double mass, double e) {
    require_positive(stiffness, "SpringDamperContact: the stiffness", "", "N/m");
    require_positive(mass, "SpringDamperContact: the mass", "", "kg");
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
    require_positive(stiffness, name, ": the contact stiffness", "N/m");
    require_not_negative(damping, name, ": the contact damping", "N s/m");
    require_not_negative(onset, name, ": the onset of the contact damping", "m");
  }
  bool is_lossless() const { return damping == 0.0; }  ///< true if an impact conserves energy
  /// Force N ≥ 0 [N] at penetration d [m] with the rate `rate` [m/s].
  template <StateScalar T>
  T force(T const& d, T const& rate) const {
    T const c = value_of(d) < onset ? T(d * (damping / onset)) : T(damping);
    T const n = d * stiffness.value + c * rate;
    return value_of(n) > 0.0 ? n : T(0.0);
  }
  /// Derivative ck ∂N/∂d + cd ∂N/∂rate with given ck, cd. Within the onset, the damping force of a departing body
  /// decreases with d. The derivative neglects this term.
  double slope(double d, double rate, double ck, double cd) const {
    bool const begins = d < onset;
    double const c = begins ? damping * d / onset : damping;
    if (stiffness * d + c * rate <= 0.0) return 0.0;
    return ck * (stiffness + (begins && rate > 0.0 ? damping * rate / onset : 0.0)) + cd * c;
  }
  /// Stored energy ∫₀ᵈ N(x, 0) dx [J] at penetration d [m].
  template <StateScalar T>
  T potential(T const& d) const {
    return d * d * (0.5 * stiffness);
  }
};

/// Hertz contact of elastic spheres, N = (4/3) E* √R d^(3/2) [Hertz 1882; Johnson 1985, §4.2].
struct HertzContact {
  Required<double> modulus;  ///< E*, 1/E* = (1 − ν₁²)/E₁ + (1 − ν₂²)/E₂ [Pa]
  Required<double> radius;   ///< R, 1/R = 1/R₁ + 1/R₂ [m]

  double stiffness() const { return 4.0 / 3.0 * modulus * std::sqrt(radius.value); }  ///< (4/3) E* √R [N/m^(3/2)]

  void check(std::string const& name) const {
    require_positive(modulus, name, ": the contact modulus", "Pa");
    require_positive(radius, name, ": the contact radius", "m");
  }
  bool is_lossless() const { return true; }  ///< true: an impact conserves energy
  /// Force N ≥ 0 [N] at penetration d [m].
  template <StateScalar T>
  T force(T const& d, T const&) const {
    using std::sqrt;
    return d * sqrt(d) * stiffness();
  }
  /// Derivative ck ∂N/∂d at penetration d [m] with a given ck.
  double slope(double d, double, double ck, double) const { return ck * 1.5 * stiffness() * std::sqrt(d); }
  /// Stored energy [J] at penetration d [m].
  template <StateScalar T>
  T potential(T const& d) const {
    using std::sqrt;
    return d * d * sqrt(d) * (0.4 * stiffness());
  }
};

/// Hunt–Crossley contact, N = max(0, K dⁿ (1 + D ḋ)) [Hunt & Crossley 1975]. The force begins and ends at zero, and
/// the restitution decreases with the impact velocity.
struct HuntCrossleyContact {
  Required<double> stiffness;  ///< K [N/mⁿ]
  double exponent = 1.5;       ///< exponent n [1]
  Required<double> damping;    ///< D [s/m]

  /// Contact law with the coefficient of restitution e at the impact velocity `speed` v [m/s]: the body departs with
  /// e v. The `stiffness` K [N/mⁿ] and the `exponent` n are given. The equation m v dv/dd = −K dⁿ(1 + D v) yields for
  /// any m, K and n
  ///   D v − ln(1 + D v) = −e D v − ln(1 − e D v).
  /// The equation is solved to rounding. The explicit formula D = 3 (1 − e)/(2 v) of Hunt & Crossley would yield 0.952,
  /// 0.768, 0.663 and 0.516 for e = 0.95, 0.7, 0.5 and 0.1. At another velocity w the restitution is that of D w.
  static HuntCrossleyContact with_restitution(double stiffness, double exponent, double e, double speed) {
    detail::require_restitution(e, "HuntCrossleyContact");
    require_positive(speed, "HuntCrossleyContact: the speed of the impact", "", "m/s");
    if (e == 1.0) return {.stiffness = stiffness, .exponent = exponent, .damping = 0.0};
    auto const excess = [&](double y) { return (y - std::log1p(y)) + (e * y + std::log1p(-e * y)); };
    double const y = detail::falling_root([&](double x) { return excess(x); }, 0.5 * (1.0 - e), (1.0 - 1e-15) / e);
    return {.stiffness = stiffness, .exponent = exponent, .damping = y / speed};
  }

  /// \throws InvalidInput for invalid parameters; `angular` if the penetration is an angle.
  void check(std::string const& name, bool angular = false) const {
    require_positive(stiffness, name, ": the contact stiffness", angular ? "N m/rad^n" : "N/m^n");
    require_not_negative(damping, name, ": the contact damping", angular ? "s/rad" : "s/m");
    if (!(exponent >= 1.0) || !std::isfinite(exponent))
      throw InvalidInput("contact.exponent",
                         {ErrorObject{name}, ": the exponent of the contact law must be at least 1, but is ",
                          ErrorValue{exponent}, "."});
  }
  bool is_lossless() const { return damping == 0.0; }  ///< true if an impact conserves energy
  /// Force N ≥ 0 [N] at penetration d [m] with the rate `rate` [m/s].
  template <StateScalar T>
  T force(T const& d, T const& rate) const {
    using std::pow;
    T const factor = rate * damping.value + 1.0;
    return value_of(factor) > 0.0 ? T(pow(d, exponent) * factor * stiffness.value) : T(0.0);
  }
  /// Derivative ck ∂N/∂d + cd ∂N/∂rate with given ck, cd.
  double slope(double d, double rate, double ck, double cd) const {
    double const factor = 1.0 + damping * rate, power = stiffness * std::pow(d, exponent - 1.0);
    return factor > 0.0 ? power * (ck * exponent * factor + cd * damping * d) : 0.0;
  }
  /// Stored energy ∫₀ᵈ N(x, 0) dx [J] at penetration d [m].
  template <StateScalar T>
  T potential(T const& d) const {
    using std::pow;
    return pow(d, exponent + 1.0) * (stiffness / (exponent + 1.0));
  }
};

}  // namespace polybody
