#pragma once
/// \file
/// The door of a run: `simulate(model, state, integrator, options)`.

#include <polybody/integrators/system_for.hpp>
#include <polybody/run/simulation.hpp>

namespace polybody {

/// The systems of a run of `model` by integrator I. The model must outlive them.
template <class I, class M>
[[gnu::cold]] RunSystems run_systems(M const& model) {
  constexpr Capabilities warned = HasStabilityLimit<I> ? Capabilities::compliance : Capabilities::motion;
  if constexpr (M::eliminates)
    return {std::make_unique<System>(system_for<I>(model)), std::make_unique<System>(model, with<warned>)};
  else
    return {std::make_unique<System>(system_for<I, warned>(model)), nullptr};
}

/// The whole mechanism of `model`, for questions about its states. The model must outlive it.
template <class M>
[[gnu::cold]] System observation_system(M const& model) {
  return System(model, with<Capabilities::motion>);
}

/// Runs `model` from x by `integrator`: a range of states. x is moved along and holds the last state afterwards.
/// \throws InconsistentInitialConditions, InvalidInput at once; NewtonConvergenceFailure, NonFiniteValue, … from the
/// step that fails.
template <LinearSolver Solver = DefaultSolver, class M, class I>
Simulation<I, Solver> simulate(M const& model, State& x, I const& integrator, RunOptions options) {
  return Simulation<I, Solver>(run_systems<I>(model), x, integrator, std::move(options));
}

/// Takes a run up where its snapshot was made; x becomes its state. Model, integrator and options must be those of the
/// run; a later `end_time` lets it go on for longer. \throws InvalidInput for a snapshot of another model, integrator
/// or count of events.
template <LinearSolver Solver = DefaultSolver, class M, class I>
Simulation<I, Solver> resume(M const& model, State& x, I const& integrator, RunOptions options,
                             RunSnapshot const& from) {
  return Simulation<I, Solver>(run_systems<I>(model), x, integrator, std::move(options), from);
}

namespace detail {
template <class M>
constexpr void refuse_temporary() {
  static_assert(std::is_void_v<M>,
                "A run keeps a reference to its model, so that a temporary model is refused. Put the model into a "
                "variable that outlives the run.");
}
}  // namespace detail

/// Refuses a temporary model, to which the run would keep a reference.
template <LinearSolver Solver = DefaultSolver, class M, class I>
void simulate(M const&&, State&, I const&, RunOptions) {
  detail::refuse_temporary<M>();
}
/// Refuses a temporary model, as `simulate`.
template <LinearSolver Solver = DefaultSolver, class M, class I>
void resume(M const&&, State&, I const&, RunOptions, RunSnapshot const&) {
  detail::refuse_temporary<M>();
}
/// Refuses a temporary model, to which the systems would keep a reference.
template <class I, class M>
RunSystems run_systems(M const&& model) = delete;
/// Refuses a temporary model, to which the system would keep a reference.
template <class M>
System observation_system(M const&& model) = delete;

}  // namespace polybody
