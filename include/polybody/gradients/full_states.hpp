#pragma once
/// \file
/// A run steps narrow states where policies eliminate unknowns, and its user sees whole ones: between the two, in
/// doubles and recorded numbers.
///
/// Not in polybody.hpp: few programs ask for derivatives of whole runs.

#include <polybody/integrators/forward_dynamics.hpp>
#include <polybody/run/event_action.hpp>
#include <polybody/run/initial_conditions.hpp>
#include <polybody/solvers/reduced_coordinates.hpp>

namespace polybody::detail {

/// Whole states of stepped ones, with the multipliers of eliminated joints. \tparam M a model; where its joints
/// eliminate nothing, both are the same
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
  /// It stays until the next one is shown. Estimates that a step keeps for joints that carry bodies have no
  /// derivatives: what these joints hold is worked out.
  StateOf<T> const& operator()(StateOf<T> const& x) {
    stepped_ = x;
    stepped_.lambda.conservativeResize(system_.rows());
    expand(system_, stepped_, shown_, scratch_);
    return shown_;
  }

 private:
  BasicSystem<T> system_;
  StateOf<T> stepped_, shown_;
  VecXOf<T> scratch_;
};

/// The state that a variant steps, next to a whole one, whose speeds are brought onto the joints before these are left
/// out.
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

/// The state that a variant steps after the events that were met last have acted on the whole one x. \throws
/// InvalidInput as `act`.
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

/// \throws InconsistentInitialConditions where a joint is open at the start of a variant's scenario, eliminated or not.
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
