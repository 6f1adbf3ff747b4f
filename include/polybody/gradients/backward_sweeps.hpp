#pragma once
/// \file
/// Backward sweeps over the steps of a run, one class for each family of integrators.
///
/// Not in polybody.hpp: few programs need derivatives of whole runs.

#include <polybody/gradients/alpha_step_adjoint.hpp>
#include <polybody/gradients/equation_derivatives.hpp>
#include <polybody/gradients/perturbed_model.hpp>
#include <polybody/gradients/perturbed_stage_model.hpp>

namespace polybody::detail {

/// Backward sweep for the generalised-α family.
template <class S, class I>
class AlphaBackwardSweep {
 public:
  using V = PerturbedModel<S, I>;

  explicit AlphaBackwardSweep(V& v) : adjoint_(v.scenario.model, v.system, v.method) {}

  /// State at the start of the first step, of length h, with corrected velocities and algorithmic accelerations.
  static State start_step(V& v, State started, double h) {
    (void)v.start_step(started, h);
    return started;
  }
  /// Returns true if both states have a start correction or both have none.
  static bool begin_alike(State const& x, State const& y) {
    return x.history.tail(StepHistory::lengths) == y.history.tail(StepHistory::lengths);
  }
  /// Returns true if all steps must have the same length.
  static bool asks_for_equal_steps(V const& v) { return v.method.start_correction; }
  static StepReport step(V& v, State& x, double h) { return v.step(x, h); }

  /// Converts the adjoint variables after a step to adjoint variables before the step, and adds the effect of the
  /// parameters to `derivatives`. Returns the relative size of the last correction.
  double backward_step(StepTaken const& step, Costate& bar, EquationDerivatives<V>& equations, VecX& derivatives) {
    Index const nv = step.before.v.size();
    VecX const own_before = step.before.history.head(nv), own_after = step.after.history.head(nv);
    double const left = adjoint_.backward_step({step.before, step.after, own_before, own_after, step.h}, bar, mu_);
    equations.evaluate(step.after);
    equations.take_from(derivatives, mu_);
    return left;
  }

 private:
  AlphaStepAdjoint<> adjoint_;
  VecX mu_;
};

/// Backward sweep for Runge–Kutta methods.
template <class S, class I>
class StageBackwardSweep {
 public:
  using V = PerturbedStageModel<S, I>;

  explicit StageBackwardSweep(V& v) : adjoint_(v.scenario.model, v.system, v.method) {}

  static State start_step(V&, State started, double) { return started; }
  static bool begin_alike(State const&, State const&) { return true; }
  static bool asks_for_equal_steps(V const&) { return false; }
  static StepReport step(V& v, State& x, double h) { return v.step(x, h); }

  double backward_step(StepTaken const& step, Costate& bar, EquationDerivatives<V>& equations, VecX& derivatives) {
    return adjoint_.backward_step(step, bar, [&](EvaluationPoint<> const& place, VecX const& mu) {
      equations.evaluate(place);
      equations.take_from(derivatives, mu);
    });
  }

 private:
  typename StageAdjoints<I>::Type adjoint_;
};

}  // namespace polybody::detail
