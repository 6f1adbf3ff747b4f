#pragma once
/// \file
/// Ends of a step of the generalised-α family, and the derivatives of the equations of the step with respect to a
/// parameter.
///
/// Not in polybody.hpp: few programs need derivatives of whole runs.

#include <polybody/integrators/alpha_method.hpp>
#include <polybody/solvers/reduced_coordinates.hpp>

namespace polybody {

/// Derivatives of the equations at the end of a step with respect to a parameter, at constant unknowns. For
/// nonholonomic constraints Φ̇ replaces Φ.
struct EquationDerivative {
  VecX balance;        ///< (nv) ∂r/∂p
  VecX rows;           ///< (rows) ∂Φ/∂p
  double scale = 1.0;  ///< change of the parameter that may change a and λ by their own size, in its unit
};

/// Ends of a step of length h: states before and after the step, and the algorithmic accelerations there.
struct StepEnds {
  State const& before;     ///< state at the start of the step, with corrected velocities
  State const& after;      ///< state at the end of the step
  VecX const& own_before;  ///< (nv) algorithmic accelerations a₀ at the start
  VecX const& own_after;   ///< (nv) algorithmic accelerations a₁ at the end
  double h;                ///< length of the step [s]

  /// Increment δ (nv) of the step with `method`: q₁ = q₀ ⊞ δ.
  VecX increment(AlphaMethod const& method) const {
    return h * before.v + h * h * ((0.5 - method.beta) * own_before + method.beta * own_after);
  }
  /// Coordinates, velocities, time, accelerations and multipliers at the end of the step.
  StepPosition end() const { return {{after.q, after.v, after.t}, after.a, after.lambda}; }
};

/// Direction of differentiation of a step.
struct StepDirection {
  EquationDerivative by;  ///< derivatives of the equations at the end of the step
  State* dx = nullptr;    ///< derivative of the state before the step, converted in place to the state after it
  double dh = 0.0;        ///< derivative of the step length [s]; `by` includes the change of the end time
};

namespace detail {
/// Evaluates the system for its tangent matrix with second-order terms. If joints are eliminated, the residual is also
/// evaluated, because the matrix depends on the reactions of these joints in the last reduced residual. \param r (nv)
/// workspace
template <class = void>
void evaluate_for_tangent(System& system, StepPosition const& x, VecX& r) {
  system.evaluate(x.at.q, x.at.v, x.at.t);
  if (!system.step_coordinates()) return;
  r.resize(system.velocities());
  system.residual(x.a, x.lambda, r);
}
}  // namespace detail

}  // namespace polybody
