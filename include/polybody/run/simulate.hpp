#pragma once
/// \file
/// The door of a run: `simulate(model, state, integrator, options)`.

#include <polybody/integrators/system_for.hpp>
#include <polybody/run/simulation.hpp>

namespace polybody {

/// The systems of a run of `model` by integrator I. The model must outlive them.
template <class I, class M>
[[gnu::cold]] RunSystems run_systems(M const& model) {
  constexpr Entries warned = NamesStableStep<I> ? Entries::compliance : Entries::motion;
  if constexpr (M::eliminates)
    return {std::make_unique<System>(system_for<I>(model)), std::make_unique<System>(model, with<warned>)};
  else
    return {std::make_unique<System>(system_for<I, warned>(model)), nullptr};
}

/// The whole mechanism of `model`, for questions about its states. The model must outlive it.
template <class M>
[[gnu::cold]] System question_system(M const& model) {
  return System(model, with<Entries::motion>);
}

/// Runs `model` from x by `integrator`: a range of states. x is moved along and holds the last state afterwards.
/// \throws InconsistentStart, InvalidInput at once; NewtonStalled, NonFinite, … from the step that fails.
template <LinearSolver Solver = DefaultSolver, class M, class I>
Simulation<I, Solver> simulate(M const& model, State& x, I const& integrator, RunOptions options) {
  return Simulation<I, Solver>(run_systems<I>(model), x, integrator, std::move(options));
}

/// Takes a run up where its snapshot was made; x becomes its state. Model, integrator and options must be those of the
/// run; a later `until` lets it go on for longer. \throws InvalidInput for a snapshot of another model, integrator or
/// count of events.
template <LinearSolver Solver = DefaultSolver, class M, class I>
Simulation<I, Solver> resume(M const& model, State& x, I const& integrator, RunOptions options,
                             RunSnapshot const& from) {
  return Simulation<I, Solver>(run_systems<I>(model), x, integrator, std::move(options), from);
}

}  // namespace polybody
