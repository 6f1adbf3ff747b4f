#pragma once
/// \file
/// Integrators of the generalised-α family: generalised-α, HHT-α, Newmark and the trapezoidal rule.
/// Theory: Eqs. 6.4, 6.5.

#include <polybody/integrators/alpha_method.hpp>

namespace polybody {

/// Generalised-α method [Chung & Hulbert 1993]: for a given spectral radius ρ∞ at infinity, it has the least
/// dissipation of low frequencies.
/// Its parameters are
///   α_m = (2ρ∞ − 1)/(ρ∞ + 1),  α_f = ρ∞/(ρ∞ + 1),  γ = ½ − α_m + α_f,  β = ¼(γ + ½)².
struct GeneralisedAlpha {
  static constexpr char const* name = "GeneralisedAlpha";
  static constexpr int order = 2;
  static constexpr bool accepts_constraints = true;
  static constexpr Capabilities capabilities = Capabilities::implicit_step;

  /// Spectral radius at infinity, in [0, 1]: 1 conserves the energy of linear models, 0 damps most. With constraint
  /// equations, use a value below 1 (0.99 is sufficient). At 1 the multipliers are only marginally stable: they
  /// alternate in sign and grow over some thousand steps.
  double rho_inf = 0.8;
  /// Tolerance of Newton's corrections, relative to the accelerations. At 1e-5 the remaining error of a smooth motion
  /// is far below the error of a step of ωh = 0.1, and a step needs two iterations fewer. Near singular configurations,
  /// which amplify this error, use 1e-8.
  double tolerance = 1e-8;
  NewtonOptions newton = {};        ///< options of Newton's method
  bool start_correction = true;     ///< true: multipliers of second order from the first step, and across changes of h
  bool second_order_terms = false;  ///< true: ∂(Gᵀλ)/∂q, ∂(Jᵀw)/∂q in every tangent; false: only after failed steps
  /// True to satisfy also Φ̇ = 0, at the cost of one factorisation of [M, Gᵀ; G, 0] per step.
  bool stabilised = false;

  /// \throws InvalidInput unless 0 ≤ ρ∞ ≤ 1, the tolerance is positive, and the options of `newton` are valid.
  void check() const {
    if (!(rho_inf >= 0.0 && rho_inf <= 1.0))
      throw InvalidInput("integrator.option", {ErrorObject{"GeneralisedAlpha"}, ": rho_inf must lie in [0, 1], but is ",
                                               ErrorValue{rho_inf}, "."});
    require_positive(tolerance, "GeneralisedAlpha: the tolerance");
    newton.check(name);
  }

  AlphaMethod method() const {
    double const alpha_m = (2.0 * rho_inf - 1.0) / (rho_inf + 1.0), alpha_f = rho_inf / (rho_inf + 1.0);
    double const gamma = 0.5 - alpha_m + alpha_f, beta = 0.25 * (gamma + 0.5) * (gamma + 0.5);
    return {name, alpha_m, alpha_f, gamma, beta, tolerance, newton, start_correction, second_order_terms, stabilised};
  }
};

/// HHT-α method: a step uses a weighted mean of the forces at its two ends,
///   M a₁ = (1 + α) f₁ − α f₀,   γ = ½ − α,   β = ¼(1 − α)²   [Hilber, Hughes & Taylor 1977].
/// It is the generalised-α method with α_m = 0, α_f = −α. Its spectral radius at infinity is (1 + α)/(1 − α).
struct HhtAlpha {
  static constexpr char const* name = "HhtAlpha";
  static constexpr int order = 2;
  static constexpr bool accepts_constraints = true;
  static constexpr Capabilities capabilities = Capabilities::implicit_step;

  /// α in [−1/3, 0]: −1/3 damps most, and 0 is the trapezoidal rule. With constraint equations, use α < 0.
  double alpha = -0.1;
  double tolerance = 1e-8;          ///< tolerance of Newton's corrections, relative to the accelerations
  NewtonOptions newton = {};        ///< options of Newton's method
  bool start_correction = true;     ///< true: multipliers of second order from the first step, and across changes of h
  bool second_order_terms = false;  ///< true: ∂(Gᵀλ)/∂q, ∂(Jᵀw)/∂q in every tangent; false: only after failed steps
  bool stabilised = false;          ///< true: a step also satisfies Φ̇ = 0

  /// \throws InvalidInput unless −1/3 ≤ α ≤ 0, the tolerance is positive, and the options of `newton` are valid.
  void check() const {
    if (!(alpha >= -1.0 / 3.0 && alpha <= 0.0))
      throw InvalidInput("integrator.option",
                         {ErrorObject{"HhtAlpha"}, ": alpha must lie in [-1/3, 0], but is ", ErrorValue{alpha}, "."});
    require_positive(tolerance, "HhtAlpha: the tolerance");
    newton.check(name);
  }

  AlphaMethod method() const {
    double const alpha_m = 0.0, alpha_f = -alpha, gamma = 0.5 - alpha, beta = 0.25 * (1.0 - alpha) * (1.0 - alpha);
    return {name, alpha_m, alpha_f, gamma, beta, tolerance, newton, start_correction, second_order_terms, stabilised};
  }
};

/// Newmark's method, a = v̇ [Newmark 1959]. It has order two for γ = ½, otherwise order one; γ > ½ damps. It is stable
/// for every h if 2β ≥ γ ≥ ½, and for γ = ½ with smaller β if ωh < (γ/2 − β)^−½. With constraint equations, use γ > ½
/// and 2β ≥ γ, preferably β = ¼(γ + ½)²; at γ = ½ the multipliers are only marginally stable [Cardona & Géradin 1989].
struct Newmark {
  static constexpr char const* name = "Newmark";
  static constexpr int order = 1;
  static constexpr bool accepts_constraints = true;
  static constexpr Capabilities capabilities = Capabilities::implicit_step;

  double gamma = 0.5;               ///< coefficient γ [1]
  double beta = 0.25;               ///< coefficient β [1]
  double tolerance = 1e-8;          ///< tolerance of Newton's corrections, relative to the accelerations
  NewtonOptions newton = {};        ///< options of Newton's method
  bool second_order_terms = false;  ///< true: ∂(Gᵀλ)/∂q, ∂(Jᵀw)/∂q in every tangent; false: only after failed steps
  bool stabilised = false;          ///< true: a step also satisfies Φ̇ = 0

  /// \throws InvalidInput unless γ ≥ ½, β > 0, the tolerance is positive, and the options of `newton` are valid.
  void check() const {
    if (!(gamma >= 0.5) || !std::isfinite(gamma))
      throw InvalidInput("integrator.option", {ErrorObject{"Newmark"}, ": gamma must be at least 1/2, but is ",
                                               ErrorValue{gamma}, ". A smaller value makes every motion grow."});
    require_positive(beta, "Newmark: beta (for an explicit method take CentralDifference)");
    require_positive(tolerance, "Newmark: the tolerance");
    newton.check(name);
  }

  AlphaMethod method() const {
    double const alpha_m = 0.0, alpha_f = 0.0;
    return {name, alpha_m, alpha_f, gamma, beta, tolerance, newton, gamma == 0.5, second_order_terms, stabilised};
  }
};

/// Trapezoidal rule, Newmark's method with γ = ½, β = ¼: conserves the energy of linear models. Use it without
/// constraint equations, or for few steps: multipliers are only marginally stable, as in generalised-α with ρ∞ = 1.
struct Trapezoidal {
  static constexpr char const* name = "Trapezoidal";
  static constexpr int order = 2;
  static constexpr bool accepts_constraints = true;
  static constexpr Capabilities capabilities = Capabilities::implicit_step;

  double tolerance = 1e-8;          ///< tolerance of Newton's corrections, relative to the accelerations
  NewtonOptions newton = {};        ///< options of Newton's method
  bool start_correction = true;     ///< true: multipliers of second order from the first step, and across changes of h
  bool second_order_terms = false;  ///< true: ∂(Gᵀλ)/∂q, ∂(Jᵀw)/∂q in every tangent; false: only after failed steps
  bool stabilised = false;          ///< true: a step also satisfies Φ̇ = 0

  /// \throws InvalidInput unless the tolerance is positive and the options of `newton` are valid.
  void check() const {
    require_positive(tolerance, "Trapezoidal: the tolerance");
    newton.check(name);
  }

  AlphaMethod method() const {
    double const alpha_m = 0.0, alpha_f = 0.0, gamma = 0.5, beta = 0.25;
    return {name, alpha_m, alpha_f, gamma, beta, tolerance, newton, start_correction, second_order_terms, stabilised};
  }
};

}  // namespace polybody
