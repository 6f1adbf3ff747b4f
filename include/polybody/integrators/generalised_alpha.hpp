#pragma once
#include <polybody/integrators/alpha_method.hpp>

namespace polybody {

/// Generalised-α method [Chung & Hulbert 1993]: for a given ρ∞ it has the least dissipation of low frequencies.
/// Its parameters are
///   α_m = (2ρ∞ − 1)/(ρ∞ + 1),  α_f = ρ∞/(ρ∞ + 1),  γ = ½ − α_m + α_f,  β = ¼(γ + ½)².
struct GeneralisedAlpha {
  static constexpr char const* name = "GeneralisedAlpha";
  static constexpr int order = 2;
  static constexpr bool accepts_constraints = true;
  static constexpr Capabilities capabilities = Capabilities::implicit_step;

  /// Spectral radius at infinity, in [0, 1]: 1 keeps energy, 0 damps most. With rows stay below 1 (0.99 will do): there
  /// the multipliers are only marginally stable, alternate in sign and grow over some thousand steps.
  double rho_inf = 0.8;
  /// Tolerance of Newton's corrections, relative to the accelerations. At 1e-5 the error that is left of a smooth
  /// motion is still far below the error of a step of ωh = 0.1, and a step takes two iterations less. Near singular
  /// configurations, which amplify that error, leave it at 1e-8.
  double tolerance = 1e-8;
  NewtonOptions newton = {};        ///< when Newton's method stops, refactors and gives up
  bool start_correction = true;     ///< second-order multipliers from the first step and across changes of h
  bool second_order_terms = false;  ///< put ∂(Gᵀλ)/∂q into the tangent from the start
  bool stabilised =
      false;  ///< keep the rows of the speeds too, at the cost of one factorisation of [M, Gᵀ; G, 0] a step

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
