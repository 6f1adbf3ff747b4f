#pragma once
/// \file
/// Derivative of the state of a run, and conversion of reduced states to full states and back.

#include <polybody/elimination/reduced_coordinates.hpp>
#include <polybody/integrators/forward_dynamics.hpp>
#include <polybody/integrators/step_history.hpp>
#include <polybody/run/event_action.hpp>
#include <polybody/run/initial_conditions.hpp>

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
/// moved = x + e dx for q, v, v̇ and λ. The time and the integrator history of `moved` remain unchanged.
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

/// Converts reduced states of a run to full states with the multipliers of eliminated joints. \tparam M model; if its
/// joints eliminate no unknowns, both states are the same
template <class M, StateScalar T = double>
class FullStates {
 public:
  explicit FullStates(M const&) {}
  StateOf<T> const& operator()(StateOf<T> const& x) const { return x; }
};
template <class M, StateScalar T>
  requires M::eliminates
class FullStates<M, T> {
 public:
  [[gnu::cold]] explicit FullStates(M const& model) : system_(stepped_system<T>(model, with<Capabilities::motion>)) {}
  /// Returns the full state of x; the reference is valid until the next call. Multipliers of joints with joint
  /// coordinates are evaluated from the equations, because their estimates in x have no derivatives.
  StateOf<T> const& operator()(StateOf<T> const& x) {
    stepped_ = x;
    stepped_.lambda.conservativeResize(system_.rows());
    expand(system_, stepped_, full_, scratch_);
    return full_;
  }

 private:
  BasicSystem<T> system_;
  StateOf<T> stepped_, full_;
  VecXOf<T> scratch_;
};

/// Reduced state of the model v for a full state x. If the model eliminates unknowns, the velocities are first
/// projected onto the constraint equations. Otherwise both states are the same.
template <class V>
[[gnu::cold]] State stepped_state(V const& v, State x) {
  if constexpr (V::Model::eliminates) {
    System full(v.scenario.model, with<Capabilities::motion>);
    ForwardDynamics<> forward(full);
    forward.project_velocities(full, x.q, x.v, x.t);
    return reduce(v.system, x);
  } else {
    return x;
  }
}

/// Applies the actions of the events that occurred last to the full state x. Returns the reduced state of the model v.
/// \throws InvalidInput if the state after an action is invalid (see `act`).
template <class V>
[[gnu::cold]] State acted_state(V& v, EventDetector const& watch, State x) {
  RunOptions const& o = v.scenario.options;
  if constexpr (V::Model::eliminates) {
    System full(v.scenario.model, with<Capabilities::motion>);
    act(watch, o.events, x, full, o.assembly_tolerance);
  } else {
    act(watch, o.events, x, v.system, o.assembly_tolerance);
  }
  return stepped_state(v, std::move(x));
}

/// \throws InconsistentInitialConditions if the initial state of a scenario violates a joint, including eliminated
/// joints.
template <class V>
[[gnu::cold]] void require_assembled_start(V& v) {
  State const& x = v.scenario.start;
  double const tolerance = v.scenario.options.assembly_tolerance;
  if constexpr (V::Model::eliminates) {
    System full(v.scenario.model, with<Capabilities::motion>);
    require_assembled(full, x, tolerance);
  } else {
    require_assembled(v.system, x, tolerance);
  }
}

}  // namespace polybody::detail
