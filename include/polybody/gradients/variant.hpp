#pragma once
/// \file
/// A model for one choice of its parameters, with what its steps and questions need; and sums of states.
///
/// Not in polybody.hpp: few programs ask for derivatives of whole runs.

#include <polybody/compare/compare.hpp>
#include <polybody/gradients/alpha_step_slope.hpp>

namespace polybody::detail {

/// A scenario for one choice of the parameters, with what its steps and questions need. It stays where it is.
template <class S, class I>
struct Variant {
  S scenario;
  System system;
  AlphaMethod method;
  AlphaMethod::Workspace<DefaultSolver> work;

  Variant(S made, AlphaMethod const& m)
      : scenario(std::move(made)),
        system(system_for<I>(scenario.model)),
        method(m),
        work(method.workspace<DefaultSolver>(system)) {}

  /// Consistent accelerations and multipliers, as a run begins.
  void start(State& x, double h) {
    work.forward.project_velocities(system, x.q, x.v, x.t);
    method.start(system, x, h, work);
  }
  /// The state in which the run begins, for steps of h.
  State started(double h) {
    State x = scenario.start;
    start(x, h);
    return x;
  }
  /// Puts the speeds and own accelerations from which a step of h sets out into x, so that the step is a plain one.
  /// Returns whether they are others than before.
  bool set_out(State& x, double h) {
    bool const corrected = method.set_out(system, x, h, work);
    if (corrected) {
      x.v = work.v0;
      x.memory.head(x.v.size()) = work.a0;
      x.memory.tail(1)[0] = h;
    }
    return corrected;
  }
  /// A step of h that depends on x alone: with factors of its own, in the first order of elimination.
  StepReport step(State& x, double h) {
    work.kept_factor = {};
    work.tangent.forget();
    work.solver().keep_reorderings(0);
    return method.step(system, x, h, work);
  }
  VecX outputs(State const& x) const {
    VecX out(Index(scenario.outputs.size()));
    for (Index i = 0; i < out.size(); ++i) {
      out[i] = scenario.outputs[std::size_t(i)].value(scenario.model, x);
      if (!std::isfinite(out[i]))
        throw NonFinite{"sensitivities: \"",
                        scenario.outputs[std::size_t(i)].name,
                        "\"",
                        how_not_finite(out[i]),
                        " at t = ",
                        x.t,
                        " s."};
    }
    return out;
  }
  /// r and Φ (of velocity rows Φ̇) at x.
  EquationSlope equations(State const& x) {
    EquationSlope out{VecX::Zero(system.speeds()), VecX::Zero(system.rows())};
    system.evaluate(x.q, x.v, x.t);
    system.residual(x.a, x.lambda, out.balance);
    system.violation(out.rows);
    if (system.velocity_rows().empty()) return out;
    VecX rate = out.rows;
    system.violation_rate(rate);
    for (Index const i : system.velocity_rows()) out.rows[i] = rate[i];
    return out;
  }
};

template <class = void>
void add(State& sum, State const& x, double by) {
  sum.q += by * x.q;
  sum.v += by * x.v;
  sum.a += by * x.a;
  sum.lambda += by * x.lambda;
  sum.memory += by * x.memory;
}
/// shown = x + e dx but for what an integrator remembers.
template <class = void>
void add_motion(State& shown, State const& dx, double e, State const& x) {
  shown.q = x.q + e * dx.q;
  shown.v = x.v + e * dx.v;
  shown.a = x.a + e * dx.a;
  shown.lambda = x.lambda + e * dx.lambda;
}
template <class = void>
State zeros_like(State const& x) {
  State out = x;
  for (VecX* const part : {&out.q, &out.v, &out.a, &out.lambda, &out.memory}) part->setZero();
  return out;
}

/// x + e dx, with the lengths of steps that x remembers.
template <class = void>
State beside(State const& x, State const& dx, double e) {
  State out = x;
  add(out, dx, e);
  out.memory.tail(StepHistory::lengths) = x.memory.tail(StepHistory::lengths);
  return out;
}

}  // namespace polybody::detail
