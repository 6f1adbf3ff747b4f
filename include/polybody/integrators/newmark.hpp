#pragma once
#include <polybody/integrators/alpha_method.hpp>

namespace polybody {

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

  /// \throws InvalidInput unless γ ≥ ½, β > 0 and the tolerance is positive.
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

  /// \throws InvalidInput unless the tolerance is positive.
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
