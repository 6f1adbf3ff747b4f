#pragma once
/// \file
/// Model for given values of the parameters, with the data for its steps and evaluations.

#include <memory>
#include <span>

#include <polybody/compare/compare.hpp>
#include <polybody/gradients/evaluation_point.hpp>
#include <polybody/gradients/requirements.hpp>
#include <polybody/gradients/run_sensitivity.hpp>

namespace polybody::detail {

/// Scenario for given values of the parameters, with its system. It must not be moved or copied. \tparam S scenario
/// \tparam I integrator \tparam wanted capabilities of the system in addition to those of the integrator
template <class S, class I, Capabilities wanted>
struct ScenarioSystem {
  using Scenario = S;
  using Model = decltype(S::model);

  std::shared_ptr<S const> shared;  ///< owner of the scenario, which other objects may share
  S const& scenario;
  System system;
  FullStates<Model> full_state;

  explicit ScenarioSystem(std::shared_ptr<S const> made)
      : shared(std::move(made)),
        scenario(*shared),
        system(system_for<I, wanted>(scenario.model)),
        full_state(scenario.model) {}

  /// Times of the breakpoints, unordered: first those of drives and loads, then those of the options [s].
  std::vector<double> breakpoints() const { return breakpoints_of(system, scenario.options); }
  /// Requested step length, or length of the first step if the integrator chooses the lengths [s].
  double length() const { return length_of_steps(scenario.options); }
  /// Initial state of the run, reduced, before `start`.
  State first() const { return stepped_state(*this, scenario.start); }
  VecX outputs(State const& x) { return values_of_outputs(scenario, full_state(x)); }
};

/// New scenario of `make` for the values p of the parameters. \tparam V a model with a scenario
template <class V, class Make>
std::shared_ptr<typename V::Scenario const> shared_scenario(Make const& make, std::span<double const> p) {
  return std::make_shared<typename V::Scenario const>(make(p));
}

/// Model for steps of the generalised-α family.
template <class S, class I>
struct PerturbedModel : ScenarioSystem<S, I, Capabilities::motion> {
  using Base = ScenarioSystem<S, I, Capabilities::motion>;
  using Base::scenario, Base::system, Base::full_state;

  AlphaMethod method;
  AlphaMethod::Workspace<DefaultSolver> work;
  /// True after the first step, which analyses the tangent. Most perturbed models compute no step.
  bool steps = false;
  EquationDerivative at_place;

  PerturbedModel(std::shared_ptr<S const> made, AlphaMethod const& m)
      : Base(std::move(made)),
        method(m),
        work(system),
        at_place{VecX::Zero(system.velocities()), VecX::Zero(system.rows())} {}

  /// Computes consistent velocities, accelerations and multipliers at the start of a run. \param corrected as in
  /// `AlphaMethod::begin`
  void start(State& x, double h, std::optional<bool> corrected = {}) {
    work.forward.project_velocities(system, x.q, x.v, x.t);
    method.begin(system, x, h, work, corrected);
  }
  /// Starts y with the start correction if x was started with it, otherwise without.
  void start_like(State const& x, State& y, double h) { start(y, h, StepHistory::has_earlier_point(x)); }
  /// Initial state of the run after `start`, for steps of length h.
  State started(double h) {
    State x = this->first();
    start(x, h);
    return x;
  }
  /// Applies the start correction of a step of length h to the velocities and algorithmic accelerations of x. The step
  /// itself then needs no correction. Returns true if there is a correction.
  bool start_step(State& x, double h) {
    bool const corrected = method.start_step(system, x, h, work);
    if (corrected) {
      x.v = work.v0;
      StepHistory(x).shift(work.a0, h);
    }
    return corrected;
  }
  /// Replaces velocities and algorithmic accelerations of y by their changes due to the start correction of a step of
  /// length h. \param corrected as in `AlphaMethod::begin`
  void set_out_change(State& y, double h, std::optional<bool> corrected) {
    (void)method.start_step(system, y, h, work, corrected);
    y.v = work.v0 - y.v;
    auto own = StepHistory::own_of(y);
    own = work.a0 - own;
  }
  /// Decision about the start correction in perturbed models near x: the same as in the run itself, `corrects`. Returns
  /// no decision if x already includes the correction for the step length h, because the decision then depends on the
  /// perturbed length.
  static std::optional<bool> decided(State const& x, double h, bool corrects) {
    return std::abs(h - StepHistory::shifted_of(x)) > 1e-9 * h ? std::optional<bool>(corrects) : std::nullopt;
  }
  /// Computes a step of length h whose result depends on x only: with a new factorisation, in the initial elimination
  /// order.
  StepReport step(State& x, double h) {
    if (!steps) method.analyse(system, work);
    steps = true;
    work.reused_factorisation = {};
    work.tangent.forget();
    work.solver().limit_reorderings(0);
    return method.step(system, x, h, work);
  }
  /// Factorisation of the last step if it has the length h and is usable, otherwise null.
  TangentSolver<StepSolver<DefaultSolver>>* factors(double h) {
    return work.reused_factorisation.usable && work.h_factored == h ? &work.solver() : nullptr;
  }
  /// Residual r of the equations of motion and constraint violation Φ (nonholonomic: Φ̇) at x. The reference is valid
  /// until the next call.
  EquationDerivative const& equations(State const& x) { return equations(x, x.t); }
  /// r and Φ (nonholonomic: Φ̇) for the state x at another time t [s].
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

/// Model for steps of Runge–Kutta methods.
template <class S, class I>
struct PerturbedStageModel : ScenarioSystem<S, I, Capabilities::implicit_step> {
  using Base = ScenarioSystem<S, I, Capabilities::implicit_step>;
  using Base::scenario, Base::system, Base::full_state;

  MethodOf<I> method;
  decltype(std::declval<MethodOf<I> const&>().template workspace<DefaultSolver>(std::declval<System&>())) work;
  PointEquations<> at_place;

  PerturbedStageModel(std::shared_ptr<S const> made, MethodOf<I> const& m)
      : Base(std::move(made)), method(m), work(method.template workspace<DefaultSolver>(system)) {}

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
  /// Initial state of the run after `start`, for steps of length h.
  State started(double h) {
    State x = this->first();
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
