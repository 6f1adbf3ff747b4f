#pragma once
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

  /// Spectral radius at infinity, in [0, 1]: 1 conserves energy, 0 damps most. With constraint equations, use a value
  /// below 1 (0.99 is sufficient). At 1 the multipliers are only marginally stable: they alternate in sign and grow
  /// over some thousand steps.
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

  /// \throws InvalidInput unless 0 ≤ ρ∞ ≤ 1 and the tolerance is positive.
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

}  // namespace polybody
