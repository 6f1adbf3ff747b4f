#pragma once
/// \file
/// How a run goes back over its steps, by the family of its integrator.
///
/// Not in polybody.hpp: few programs ask for derivatives of whole runs.

#include <polybody/gradients/alpha_step_adjoint.hpp>
#include <polybody/gradients/equation_derivatives.hpp>
#include <polybody/gradients/perturbed_model.hpp>
#include <polybody/gradients/perturbed_stage_model.hpp>

namespace polybody::detail {

/// Under the generalised-α family.
template <class S, class I>
class AlphaBackwardSweep {
 public:
  using V = PerturbedModel<S, I>;

  explicit AlphaBackwardSweep(V& v) : adjoint_(v.scenario.model, v.system, v.method) {}

  /// The state from which the first step, of h, sets out.
  static State start_step(V& v, State started, double h) {
    (void)v.start_step(started, h);
    return started;
  }
  /// Both starts were corrected, or none.
  static bool begin_alike(State const& x, State const& y) {
    return x.history.tail(StepHistory::lengths) == y.history.tail(StepHistory::lengths);
  }
  /// Steps must be of one length.
  static bool asks_for_equal_steps(V const& v) { return v.method.start_correction; }
  static StepReport step(V& v, State& x, double h) { return v.step(x, h); }

  /// Takes a costate back over a step; what parameters do in it is taken from their slopes.
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

/// Under methods of several stages.
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
