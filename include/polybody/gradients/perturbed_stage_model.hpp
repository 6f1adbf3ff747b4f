#pragma once
/// \file
/// Model for given values of the parameters, with the data for Runge–Kutta methods.
///
/// Not in polybody.hpp: few programs need derivatives of whole runs.

#include <polybody/compare/compare.hpp>
#include <polybody/gradients/evaluation_point.hpp>
#include <polybody/gradients/full_states.hpp>
#include <polybody/gradients/requirements.hpp>

namespace polybody::detail {

/// Scenario for given values of the parameters, with the data for its steps and evaluations under Runge–Kutta methods.
/// It must not be moved or copied.
template <class S, class I>
struct PerturbedStageModel {
  using Model = decltype(S::model);

  S scenario;
  System system;
  FullStates<Model> full_state;
  MethodOf<I> method;
  decltype(std::declval<MethodOf<I> const&>().template workspace<DefaultSolver>(std::declval<System&>())) work;
  PointEquations<> at_place;

  PerturbedStageModel(S made, MethodOf<I> const& m)
      : scenario(std::move(made)),
        system(system_for<I, Capabilities::implicit_step>(scenario.model)),
        full_state(scenario.model),
        method(m),
        work(method.template workspace<DefaultSolver>(system)) {}

  /// Requested step length, or length of the first step if the integrator chooses the lengths [s].
  double length() const { return length_of_steps(scenario.options); }
  /// Times of the breakpoints: first those of drives and loads, then those of the options [s].
  std::vector<double> breakpoints() const { return breakpoints_of(system, scenario.options); }
  VecX outputs(State const& x) { return values_of_outputs(scenario, full_state(x)); }
  /// Residuals of the equations at an evaluation point.
  EquationDerivative equations(EvaluationPoint<> const& x) {
    at_place.evaluate(system, x);
    return {at_place.balance, at_place.rows};
  }
  /// Residuals of the equations at the point x with the time t [s] instead of its own.
  EquationDerivative equations(EvaluationPoint<> const& x, double t) {
    EvaluationPoint<> y = x;
    y.t = t;
    return equations(y);
  }
  /// Residuals of the equations of motion and of the second derivative of the constraint equations, in a state.
  EquationDerivative equations(State const& x) {
    return equations(
        EvaluationPoint<>{.q = x.q, .v = x.v, .t = x.t, .terms = {}, .also = {}, .a = x.a, .lambda = x.lambda});
  }
  /// Computes consistent velocities, accelerations and multipliers at the start of a run.
  void start(State& x, double h) {
    work.forward.project_velocities(system, x.q, x.v, x.t);
    method.start(system, x, h, work);
  }
  /// Starts y. These methods have no start correction, so the first state is unused.
  void start_like(State const&, State& y, double h) { start(y, h); }
  /// Initial state of the run, reduced, before `start`.
  State first() const { return stepped_state(*this, scenario.start); }
  /// Initial state of the run after `start`, for steps of length h.
  State started(double h) {
    State x = first();
    start(x, h);
    return x;
  }
  /// Computes a step of length h or less whose result depends on x only: with a new factorisation.
  StepReport step(State& x, double h) {
    if constexpr (requires { work.reused_factorisation; }) work.reused_factorisation = {};
    return method.step(system, x, h, work);
  }
};

}  // namespace polybody::detail
