#pragma once
#include <polybody/integrators/alpha_method.hpp>

namespace polybody {

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

  /// \throws InvalidInput unless −1/3 ≤ α ≤ 0 and the tolerance is positive.
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

}  // namespace polybody
