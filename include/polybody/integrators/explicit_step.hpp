#pragma once
#include <polybody/integrators/integrator.hpp>

namespace polybody::detail {

/// Next state of an explicit one-step method, with the memory for its computation.
template <class Solver>
struct ExplicitStep {
  VecX q, v, a, dq, lambda;
  ForwardDynamics<Solver> forward;
  StepCheck check;

  explicit ExplicitStep(System& s)
      : q(VecX::Zero(s.coordinates())),
        v(VecX::Zero(s.velocities())),
        a(v),
        dq(v),
        lambda(VecX::Zero(s.rows())),
        forward(s) {}

  /// Stores the next state in x, as the state at x.t + h. \param cost cost of the step, added to `check.failed` if
  /// the check of the state fails \throws NonFiniteValue, Diverged.
  void accept(System& system, State& x, double h, StepReport const& cost = {}) {
    count_if_failed(check.failed, cost, [&] { check.require_end(system, {q, v, lambda, x.t + h, h}); });
    x.q.swap(q);
    x.v.swap(v);
    x.a.swap(a);
    x.lambda.swap(lambda);
    x.t += h;
  }
};

}  // namespace polybody::detail
