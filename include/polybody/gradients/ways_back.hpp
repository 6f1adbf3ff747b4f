#pragma once
/// \file
/// How a run goes back over its steps, by the family of its integrator.
///
/// Not in polybody.hpp: few programs ask for derivatives of whole runs.

#include <polybody/gradients/alpha_step_adjoint.hpp>
#include <polybody/gradients/equation_slopes.hpp>
#include <polybody/gradients/stages_variant.hpp>
#include <polybody/gradients/variant.hpp>

namespace polybody::detail {

/// Under the generalised-α family.
template <class S, class I>
class AlphaWayBack {
 public:
  using V = Variant<S, I>;

  explicit AlphaWayBack(V& v) : adjoint_(v.scenario.model, v.system, v.method) {}

  /// The state from which the first step, of h, sets out.
  static State set_out(V& v, State started, double h) {
    (void)v.set_out(started, h);
    return started;
  }
  /// Both starts were corrected, or none.
  static bool begin_alike(State const& x, State const& y) {
    return x.memory.tail(StepHistory::lengths) == y.memory.tail(StepHistory::lengths);
  }
  /// Steps must be of one length.
  static bool asks_for_equal_steps(V const& v) { return v.method.start_correction; }
  static StepReport step(V& v, State& x, double h) { return v.step(x, h); }

  /// Takes a costate back over a step; what parameters do in it is taken from their slopes.
  double retreat(StepTaken const& step, Costate& bar, EquationSlopes<V>& equations, VecX& slopes) {
    Index const nv = step.before.v.size();
    VecX const own_before = step.before.memory.head(nv), own_after = step.after.memory.head(nv);
    double const left = adjoint_.retreat({step.before, step.after, own_before, own_after, step.h}, bar, mu_);
    equations.evaluate(step.after);
    equations.take_from(slopes, mu_);
    return left;
  }

 private:
  AlphaStepAdjoint<> adjoint_;
  VecX mu_;
};

/// Under methods of several stages.
template <class S, class I>
class StagesWayBack {
 public:
  using V = StagesVariant<S, I>;

  explicit StagesWayBack(V& v) : adjoint_(v.scenario.model, v.system, v.method) {}

  static State set_out(V&, State started, double) { return started; }
  static bool begin_alike(State const&, State const&) { return true; }
  static bool asks_for_equal_steps(V const&) { return false; }
  static StepReport step(V& v, State& x, double h) { return v.step(x, h); }

  double retreat(StepTaken const& step, Costate& bar, EquationSlopes<V>& equations, VecX& slopes) {
    return adjoint_.retreat(step, bar, [&](EquationPlace<> const& place, VecX const& mu) {
      equations.evaluate(place);
      equations.take_from(slopes, mu);
    });
  }

 private:
  typename AdjointsOfStages<I>::Type adjoint_;
};

}  // namespace polybody::detail
