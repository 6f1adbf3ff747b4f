#pragma once
/// \file
/// A step of the generalised-α family where it is differentiated: its ends, and what changes with a parameter.
///
/// Not in polybody.hpp: few programs ask for derivatives of whole runs.

#include <polybody/integrators/alpha_method.hpp>
#include <polybody/solvers/reduced_coordinates.hpp>

namespace polybody {

/// What a parameter does to the equations of a step at its end while unknowns stay: ∂r/∂p (nv) and ∂Φ/∂p, of velocity
/// rows ∂Φ̇/∂p (rows).
struct EquationDerivative {
  VecX balance;        ///< (nv) ∂r/∂p
  VecX rows;           ///< (rows) ∂Φ/∂p
  double scale = 1.0;  ///< of the parameter, in its own unit: over it a and λ may change by their own size
};

/// The ends of a step of h: its state before and after, and the method's own accelerations there.
struct StepEnds {
  State const& before;     ///< at its start, with the speeds that the step set out with
  State const& after;      ///< at its end
  VecX const& own_before;  ///< (nv) a₀
  VecX const& own_after;   ///< (nv) a₁
  double h;                ///< [s]

  /// δ (nv) of the step by `method`: q₁ = q₀ ⊞ δ.
  VecX increment(AlphaMethod const& method) const {
    return h * before.v + h * h * ((0.5 - method.beta) * own_before + method.beta * own_after);
  }
  /// The place of its end.
  StepPosition end() const { return {{after.q, after.v, after.t}, after.a, after.lambda}; }
};

/// A direction along which a step is differentiated.
struct StepDirection {
  EquationDerivative by;  ///< what the parameter does to the equations at the end of the step
  State* dx = nullptr;    ///< the derivative of the state before the step; it becomes that of the state after it
  double dh = 0.0;  ///< that of the length of the step [s]; what the time of its end does to the equations is in `by`
};

namespace detail {
/// The system at a place where its tangent with second-order terms is asked: what eliminated joints hold is taken from
/// the residual that was reduced last. \param r (nv) is scratch
template <class = void>
void evaluate_for_tangent(System& system, StepPosition const& x, VecX& r) {
  system.evaluate(x.at.q, x.at.v, x.at.t);
  if (!system.step_coordinates()) return;
  r.resize(system.velocities());
  system.residual(x.a, x.lambda, r);
}
}  // namespace detail

}  // namespace polybody
