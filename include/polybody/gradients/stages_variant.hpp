#pragma once
/// \file
/// A model for one choice of its parameters, with what its start and questions need under methods of several stages.
///
/// Not in polybody.hpp: few programs ask for derivatives of whole runs.

#include <polybody/compare/compare.hpp>
#include <polybody/gradients/equation_place.hpp>
#include <polybody/gradients/requirements.hpp>
#include <polybody/gradients/shown_states.hpp>

namespace polybody::detail {

/// A scenario for one choice of the parameters, with what its start and questions need. It stays where it is.
template <class S, class I>
struct StagesVariant {
  using Model = decltype(S::model);

  S scenario;
  System system;
  ShownStates<Model> shown;
  MethodOf<I> method;
  decltype(std::declval<MethodOf<I> const&>().template workspace<DefaultSolver>(std::declval<System&>())) work;
  PlaceEquations<> at_place;

  StagesVariant(S made, MethodOf<I> const& m)
      : scenario(std::move(made)),
        system(system_for<I, Entries::implicit_step>(scenario.model)),
        shown(scenario.model),
        method(m),
        work(method.template workspace<DefaultSolver>(system)) {}

  /// The length of steps that is asked for, or of the first one [s].
  double length() const { return length_of_steps(scenario.options); }
  /// Times at which a step must end: those of drives and loads, then those of the options [s].
  std::vector<double> corners() const { return corners_of(system, scenario.options); }
  VecX outputs(State const& x) { return values_of_outputs(scenario, shown(x)); }
  /// The left sides of the equations at a place.
  EquationSlope equations(EquationPlace<> const& x) {
    at_place.evaluate(system, x);
    return {at_place.balance, at_place.rows};
  }
  /// The same at another time t [s].
  EquationSlope equations(EquationPlace<> const& x, double t) {
    EquationPlace<> y = x;
    y.t = t;
    return equations(y);
  }
  /// The same of accelerations in a state.
  EquationSlope equations(State const& x) {
    return equations(
        EquationPlace<>{.q = x.q, .v = x.v, .t = x.t, .terms = {}, .also = {}, .a = x.a, .lambda = x.lambda});
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
