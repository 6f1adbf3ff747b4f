#pragma once
/// \file
/// A model for one choice of its parameters, with what its start and questions need under methods of several stages.
///
/// Not in polybody.hpp: few programs ask for derivatives of whole runs.

#include <polybody/compare/compare.hpp>
#include <polybody/gradients/evaluation_point.hpp>
#include <polybody/gradients/full_states.hpp>
#include <polybody/gradients/requirements.hpp>

namespace polybody::detail {

/// A scenario for one choice of the parameters, with what its start and questions need. It stays where it is.
template <class S, class I>
struct PerturbedStageModel {
  using Model = decltype(S::model);

  S scenario;
  System system;
  FullStates<Model> shown;
  MethodOf<I> method;
  decltype(std::declval<MethodOf<I> const&>().template workspace<DefaultSolver>(std::declval<System&>())) work;
  PointEquations<> at_place;

  PerturbedStageModel(S made, MethodOf<I> const& m)
      : scenario(std::move(made)),
        system(system_for<I, Capabilities::implicit_step>(scenario.model)),
        shown(scenario.model),
        method(m),
        work(method.template workspace<DefaultSolver>(system)) {}

  /// The length of steps that is asked for, or of the first one [s].
  double length() const { return length_of_steps(scenario.options); }
  /// Times at which a step must end: those of drives and loads, then those of the options [s].
  std::vector<double> breakpoints() const { return breakpoints_of(system, scenario.options); }
  VecX outputs(State const& x) { return values_of_outputs(scenario, shown(x)); }
  /// The left sides of the equations at a place.
  EquationDerivative equations(EvaluationPoint<> const& x) {
    at_place.evaluate(system, x);
    return {at_place.balance, at_place.rows};
  }
  /// The same at another time t [s].
  EquationDerivative equations(EvaluationPoint<> const& x, double t) {
    EvaluationPoint<> y = x;
    y.t = t;
    return equations(y);
  }
  /// The same of accelerations in a state.
  EquationDerivative equations(State const& x) {
    return equations(
        EvaluationPoint<>{.q = x.q, .v = x.v, .t = x.t, .terms = {}, .also = {}, .a = x.a, .lambda = x.lambda});
  }
  /// Consistent accelerations and multipliers, as a run begins.
  void start(State& x, double h) {
    work.forward.project_velocities(system, x.q, x.v, x.t);
    method.start(system, x, h, work);
  }
  /// The same for y; nothing is decided by what was done for another state.
  void start_like(State const&, State& y, double h) { start(y, h); }
  /// The first state that is stepped, before it is started.
  State first() const { return stepped_state(*this, scenario.start); }
  /// The state in which the run begins, for steps of h.
  State started(double h) {
    State x = first();
    start(x, h);
    return x;
  }
  /// A step of at most h that depends on x alone: with factors of its own.
  StepReport step(State& x, double h) {
    if constexpr (requires { work.kept_factor; }) work.kept_factor = {};
    return method.step(system, x, h, work);
  }
};

}  // namespace polybody::detail
