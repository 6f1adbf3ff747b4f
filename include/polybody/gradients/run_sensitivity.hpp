#pragma once
/// \file
/// Derivative of the state of a run, and linear combinations of such derivatives.

#include <polybody/integrators/step_history.hpp>

namespace polybody::detail {

/// Derivative of the current state of a run with respect to p, which is a parameter or the length of a step.
struct RunSensitivity {
  State dx;         ///< derivative of the state; the history of `dx` contains the step lengths of the run itself
  double dt = 0.0;  ///< derivative of the time [s / unit of p]
  VecX lengths;     ///< derivatives of the step lengths in the history [s / unit of p]
};

template <class = void>
void add(State& sum, State const& x, double by) {
  sum.q += by * x.q;
  sum.v += by * x.v;
  sum.a += by * x.a;
  sum.lambda += by * x.lambda;
  sum.history += by * x.history;
}
/// moved = x + e dx, without the integrator history.
template <class = void>
void add_motion(State& moved, State const& dx, double e, State const& x) {
  moved.q = x.q + e * dx.q;
  moved.v = x.v + e * dx.v;
  moved.a = x.a + e * dx.a;
  moved.lambda = x.lambda + e * dx.lambda;
}
template <class = void>
State zeros_like(State const& x) {
  State out = x;
  for (VecX* const part : {&out.q, &out.v, &out.a, &out.lambda, &out.history}) part->setZero();
  return out;
}

/// x + e dx, with the step lengths in the history of x.
template <class = void>
State displaced(State const& x, State const& dx, double e) {
  State out = x;
  add(out, dx, e);
  StepHistory::lengths_of(out) = StepHistory::lengths_of(x);
  return out;
}

}  // namespace polybody::detail
