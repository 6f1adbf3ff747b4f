#pragma once
/// \file
/// Derivatives of a run's state, and sums of states.
///
/// Not in polybody.hpp: few programs ask for derivatives of whole runs.

#include <polybody/integrators/step_history.hpp>

namespace polybody::detail {

/// The derivative of a run where it stands, by a parameter or by the length of a step.
struct RunSensitivity {
  State dx;         ///< of the state; lengths of steps in its memory are those of the run
  double dt = 0.0;  ///< of the time [s]
  VecX lengths;     ///< of those lengths [s]
};

/// The lengths of steps that an integrator remembers in a state or its derivative [s]; none without a memory.
template <class = void>
auto lengths_of(State& x) {
  return x.history.tail(std::min<Index>(StepHistory::lengths, x.history.size()));
}
template <class = void>
auto lengths_of(State const& x) {
  return x.history.tail(std::min<Index>(StepHistory::lengths, x.history.size()));
}

template <class = void>
void add(State& sum, State const& x, double by) {
  sum.q += by * x.q;
  sum.v += by * x.v;
  sum.a += by * x.a;
  sum.lambda += by * x.lambda;
  sum.history += by * x.history;
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
  for (VecX* const part : {&out.q, &out.v, &out.a, &out.lambda, &out.history}) part->setZero();
  return out;
}

/// x + e dx, with the lengths of steps that x remembers.
template <class = void>
State beside(State const& x, State const& dx, double e) {
  State out = x;
  add(out, dx, e);
  lengths_of(out) = lengths_of(x);
  return out;
}

}  // namespace polybody::detail
