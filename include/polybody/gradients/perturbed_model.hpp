#pragma once
/// \file
/// A model for one choice of its parameters, with what its steps and questions need.
///
/// Not in polybody.hpp: few programs ask for derivatives of whole runs.

#include <polybody/compare/compare.hpp>
#include <polybody/gradients/alpha_linearised_step.hpp>
#include <polybody/gradients/full_states.hpp>
#include <polybody/gradients/requirements.hpp>
#include <polybody/gradients/run_sensitivity.hpp>

namespace polybody::detail {

/// A scenario for one choice of the parameters, with what its steps and questions need. It stays where it is.
template <class S, class I>
struct PerturbedModel {
  using Model = decltype(S::model);

  S scenario;
  System system;
  FullStates<Model> shown;
  AlphaMethod method;
  AlphaMethod::Workspace<DefaultSolver> work;
  bool steps = false;  ///< a step was taken, for which the tangent was laid out: most variants never take one
  EquationDerivative at_place;

  PerturbedModel(S made, AlphaMethod const& m)
      : scenario(std::move(made)),
        system(system_for<I>(scenario.model)),
        shown(scenario.model),
        method(m),
        work(system),
        at_place{VecX::Zero(system.velocities()), VecX::Zero(system.rows())} {}

  /// Consistent accelerations and multipliers, as a run begins. \param corrected as in `AlphaMethod::begin`
  void start(State& x, double h, std::optional<bool> corrected = {}) {
    work.forward.project_velocities(system, x.q, x.v, x.t);
    method.begin(system, x, h, work, corrected);
  }
  /// The same for y, as it was done for x.
  void start_like(State const& x, State& y, double h) { start(y, h, x.history[x.history.size() - 2] > 0.0); }
  /// Times at which a step must end, in no order: those of drives and loads, then those of the options [s].
  std::vector<double> breakpoints() const { return breakpoints_of(system, scenario.options); }
  /// The length of steps that is asked for [s].
  double length() const { return length_of_steps(scenario.options); }
  /// The first state that is stepped, before it is started.
  State first() const { return stepped_state(*this, scenario.start); }
  /// The state in which the run begins, for steps of h.
  State started(double h) {
    State x = first();
    start(x, h);
    return x;
  }
  /// Puts the speeds and own accelerations from which a step of h sets out into x, so that the step is a plain one.
  /// Returns whether they are others than before.
  bool start_step(State& x, double h) {
    bool const corrected = method.start_step(system, x, h, work);
    if (corrected) {
      x.v = work.v0;
      x.history.head(x.v.size()) = work.a0;
      x.history.tail(1)[0] = h;
    }
    return corrected;
  }
  /// Speeds and own accelerations of y become what is added to them where a step of h sets out from it. \param
  /// corrected as in `AlphaMethod::begin`
  void set_out_change(State& y, double h, std::optional<bool> corrected) {
    (void)method.start_step(system, y, h, work, corrected);
    y.v = work.v0 - y.v;
    auto own = y.history.head(y.v.size());
    own = work.a0 - own;
  }
  /// Whether variants that stand beside x set out corrected, as the run itself does, which `corrects`; none where that
  /// changes with the length of the step.
  static std::optional<bool> decided(State const& x, double h, bool corrects) {
    double const shifted = x.history[x.history.size() - 1];
    return std::abs(h - shifted) > 1e-9 * h ? std::optional<bool>(corrects) : std::nullopt;
  }
  /// A step of h that depends on x alone: with factors of its own, in the first order of elimination.
  StepReport step(State& x, double h) {
    if (!steps) method.analyse(system, work);
    steps = true;
    work.kept_factor = {};
    work.tangent.forget();
    work.solver().limit_reorderings(0);
    return method.step(system, x, h, work);
  }
  VecX outputs(State const& x) { return values_of_outputs(scenario, shown(x)); }
  /// The factors of the last step, if it was one of h and they serve.
  TangentSolver<StepSolver<DefaultSolver>>* factors(double h) {
    return work.kept_factor.usable && work.h_factored == h ? &work.solver() : nullptr;
  }
  /// r and Φ (of velocity rows Φ̇) at x, until they are asked again.
  EquationDerivative const& equations(State const& x) { return equations(x, x.t); }
  /// The same at another time t [s].
  EquationDerivative const& equations(State const& x, double t) {
    system.evaluate(x.q, x.v, t);
    system.residual(x.a, x.lambda, at_place.balance);
    system.violation(at_place.rows);
    if (system.nonholonomic_equations().empty()) return at_place;
    work.rate = at_place.rows;
    system.violation_rate(work.rate);
    for (Index const i : system.nonholonomic_equations()) at_place.rows[i] = work.rate[i];
    return at_place;
  }
};

}  // namespace polybody::detail
