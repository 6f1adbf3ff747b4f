#pragma once
/// \file
/// Entry points of a run: `simulate(model, state, integrator, options)` and `resume`.

#include <polybody/integrators/system_for.hpp>
#include <polybody/run/simulation.hpp>

namespace polybody {

namespace detail {
/// Capabilities that the warnings of a run by integrator I require.
template <class I>
inline constexpr Capabilities warned = HasStabilityLimit<I> ? Capabilities::compliance : Capabilities::motion;
}  // namespace detail

/// Systems of a run of `model` by integrator I, with the capabilities that the run requires and those of `more`. The
/// model must outlive the systems. `source` makes the systems for evaluations of the states.
template <class I, Capabilities more, class M>
[[gnu::cold]] RunSystems run_systems(M const& model, SystemSource const& source) {
  constexpr Capabilities full = detail::warned<I> | more;
  if constexpr (M::eliminates)
    return {std::make_unique<System>(system_for<I, more>(model)), std::make_unique<System>(model, with<full>), source};
  else
    return {std::make_unique<System>(system_for<I, full>(model)), nullptr, source};
}
/// Systems of a run of `model` by integrator I. The model must outlive the systems.
template <class I, class M>
RunSystems run_systems(M const& model) {
  return run_systems<I, Capabilities::motion>(model, system_source(model));
}

/// Returns a run of `model` from x by `integrator`, as a range of states. The run updates x to the state at the end of
/// each step. \throws InconsistentInitialConditions, InvalidInput immediately; NewtonConvergenceFailure,
/// NonFiniteValue, … from the step that fails.
template <LinearSolver Solver = DefaultSolver, class M, class I>
Simulation<I, Solver> simulate(M const& model, State& x, I const& integrator, RunOptions options) {
  return Simulation<I, Solver>(run_systems<I>(model), x, integrator, std::move(options));
}

/// Continues a run from its snapshot; x becomes the state of the snapshot. Model, integrator and options must be those
/// of the run; a later `end_time` extends the run. \throws InvalidInput for a snapshot of another model, integrator or
/// number of events.
template <LinearSolver Solver = DefaultSolver, class M, class I>
Simulation<I, Solver> resume(M const& model, State& x, I const& integrator, RunOptions options,
                             RunSnapshot const& from) {
  return Simulation<I, Solver>(run_systems<I>(model), x, integrator, std::move(options), from);
}

namespace detail {
template <class M>
constexpr void refuse_temporary() {
  static_assert(std::is_void_v<M>,
                "A run keeps a reference to its model, so a temporary model is refused. Put the model into a "
                "variable that outlives the run.");
}
}  // namespace detail

/// Refuses a temporary or constant state. The return type is deduced so that the compiler reports the refusal first.
template <LinearSolver Solver = DefaultSolver, class M, Integrator I>
auto simulate(M const& model, State const&, I const& integrator, RunOptions options) {
  static_assert(std::is_void_v<M>,
                "A run changes its state, so a temporary or constant state is refused. Put the state into a "
                "variable: State x = model.reference_state(); simulate(model, x, integrator, options).");
  State none;
  return simulate<Solver>(model, none, integrator, std::move(options));
}
/// Refuses a state in place of the model.
template <class M, class I>
auto simulate(State const&, M const&, I const&, RunOptions) {
  static_assert(std::is_void_v<M>,
                "The model must be the first argument: simulate(model, state, integrator, options).");
}
/// Refuses a run without an integrator.
template <class M>
auto simulate(M const&, State&, RunOptions) {
  static_assert(std::is_void_v<M>,
                "A run needs an integrator before its options: simulate(model, state, GeneralisedAlpha{}, options).");
}
/// Refuses a run without options.
template <class M, class I>
  requires(!std::is_same_v<I, RunOptions>)
auto simulate(M const&, State&, I const&) {
  static_assert(std::is_void_v<M>,
                "A run needs options: simulate(model, state, integrator, {.end_time = 1.0, .step = 1e-3}), both in s.");
}
/// Refuses a type that is not an integrator.
template <LinearSolver Solver = DefaultSolver, class M, class I>
  requires(!Integrator<I>)
auto simulate(M const&, State&, I const&, RunOptions) {
  static_assert(std::is_void_v<M>,
                "The third argument of simulate must be an integrator, such as GeneralisedAlpha{}. A user-defined type "
                "needs the members of the concept Integrator, see docs/extending.md.");
}

/// Refuses a temporary model, to which the run would keep a reference.
template <LinearSolver Solver = DefaultSolver, class M, class I>
void simulate(M const&&, State&, I const&, RunOptions) {
  detail::refuse_temporary<M>();
}
/// Refuses a temporary model, like `simulate`.
template <LinearSolver Solver = DefaultSolver, class M, class I>
void resume(M const&&, State&, I const&, RunOptions, RunSnapshot const&) {
  detail::refuse_temporary<M>();
}
/// Refuses a temporary model, to which the systems would keep a reference.
template <class I, class M>
RunSystems run_systems(M const&& model) = delete;

}  // namespace polybody
