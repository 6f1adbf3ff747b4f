#pragma once
#include <polybody/integrators/conserving_step.hpp>

namespace polybody {

/// χ = 0: the energy–momentum method, of order two [Simo & Tarnow 1992; Gonzalez 1996]. Energy, and with it stability,
/// holds for every h at which Newton's method converges; high modes are kept too. Energy and momenta err by what
/// Newton's method leaves.
struct EnergyMomentum {
  static constexpr char const* name = "EnergyMomentum";
  static constexpr int order = 2;
  static constexpr bool accepts_constraints = true;
  static constexpr Capabilities capabilities = Capabilities::implicit_step | Capabilities::secants;

  double tolerance = 1e-10;                       ///< of Newton's corrections, relative to the accelerations
  NewtonOptions newton = {.max_iterations = 50};  ///< when Newton's method stops, refactors and gives up

  /// \throws InvalidInput unless the tolerance is positive.
  void check() const {
    require_positive(tolerance, "EnergyMomentum: the tolerance");
    newton.check(name);
  }

  ConservingStep method() const { return {name, 0.0, tolerance, newton}; }
};

/// χ = ½ (1 − ρ∞)/(1 + ρ∞): energy falls in every step, in a linear mode by the factor ρ∞² as ωh → ∞. Of order one for
/// ρ∞ < 1. The strains' part is that of the energy-dissipative momentum-conserving method EDMC-1 [Armero & Romero
/// 2001]; the speeds' part is taken in the norm of M here, so that no mode escapes, and the angular momentum follows to
/// first order only. Force elements with a potential of their own keep their energy: the speeds damp them.
struct EnergyDecaying {
  static constexpr char const* name = "EnergyDecaying";
  static constexpr int order = 1;
  static constexpr bool accepts_constraints = true;
  static constexpr Capabilities capabilities = Capabilities::implicit_step | Capabilities::secants;

  double rho_inf = 0.9;                           ///< of a mode of strain as ωh → ∞, in [0, 1]; 1 keeps energy
  double tolerance = 1e-10;                       ///< of Newton's corrections, relative to the accelerations
  NewtonOptions newton = {.max_iterations = 50};  ///< when Newton's method stops, refactors and gives up

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
