#pragma once
#include <polybody/integrators/conserving_step.hpp>

namespace polybody {

/// Energy–momentum method of order two [Simo & Tarnow 1992; Gonzalez 1996], `ConservingStep` with χ = 0. It conserves
/// energy, and is therefore stable, for every h at which Newton's method converges. High modes are not damped. The
/// tolerance of Newton's method determines the errors of energy and momenta.
struct EnergyMomentum {
  static constexpr char const* name = "EnergyMomentum";
  static constexpr int order = 2;
  static constexpr bool accepts_constraints = true;
  static constexpr Capabilities capabilities = Capabilities::implicit_step | Capabilities::secants;

  double tolerance = 1e-10;                       ///< tolerance of Newton's corrections, relative to the accelerations
  NewtonOptions newton = {.max_iterations = 50};  ///< options of Newton's method

  /// \throws InvalidInput unless the tolerance is positive.
  void check() const {
    require_positive(tolerance, "EnergyMomentum: the tolerance");
    newton.check(name);
  }

  ConservingStep method() const { return {name, 0.0, tolerance, newton}; }
};

/// Energy-decaying method, `ConservingStep` with χ = ½ (1 − ρ∞)/(1 + ρ∞): energy decreases in every step, in a linear
/// mode by the factor ρ∞² as ωh → ∞. The method has order one for ρ∞ < 1. The dissipation by strains is that of the
/// energy-dissipative momentum-conserving method EDMC-1 [Armero & Romero 2001]. The dissipation by velocities uses the
/// norm of M, so that every mode is damped; the angular momentum is then accurate to first order only. Force elements
/// with a potential do not dissipate energy themselves: the dissipation by velocities damps their motion.
struct EnergyDecaying {
  static constexpr char const* name = "EnergyDecaying";
  static constexpr int order = 1;
  static constexpr bool accepts_constraints = true;
  static constexpr Capabilities capabilities = Capabilities::implicit_step | Capabilities::secants;

  double rho_inf = 0.9;      ///< spectral radius of a strain mode as ωh → ∞, in [0, 1]; 1 conserves energy
  double tolerance = 1e-10;  ///< tolerance of Newton's corrections, relative to the accelerations
  NewtonOptions newton = {.max_iterations = 50};  ///< options of Newton's method

  /// \throws InvalidInput unless 0 ≤ ρ∞ ≤ 1 and the tolerance is positive.
  void check() const {
    if (!(rho_inf >= 0.0 && rho_inf <= 1.0))
      throw InvalidInput("integrator.option", {ErrorObject{"EnergyDecaying"}, ": rho_inf must lie in [0, 1], but is ",
                                               ErrorValue{rho_inf}, "."});
    require_positive(tolerance, "EnergyDecaying: the tolerance");
    newton.check(name);
  }

  ConservingStep method() const { return {name, 0.5 * (1.0 - rho_inf) / (1.0 + rho_inf), tolerance, newton}; }
};

}  // namespace polybody
