#pragma once
/// \file
/// Gradient of one result of a run, J = Φ(x_N) + ∫ g(x) dt, with respect to any number of parameters of its model, by
/// the discrete adjoint:
///
///     auto const make = [](std::span<double const> p) {
///       return with_objective(Scenario<M>{model_of(p), start, options}, end);
///     };
///     GradientResult const g = gradient(make, {{"length [m]", 1.0}}, GeneralisedAlpha{});
///     g.derivatives[0];  // dJ/dp of the first parameter
///
/// A forward run is followed by a backward sweep from its end (`AlphaStepAdjoint`), also over breakpoints and events
/// (`AdjointEventHandler`). The states of the run are stored in snapshots or computed again (`reverse_steps`).
/// A factory makes models from parameters. The equations of these models are differenced at fixed unknowns, as in
/// `sensitivities`. Parameters that affect no common equation share these differences (`Parameter::affects`). All other
/// costs of a step are independent of the number of parameters. Each step begins with a new factorisation, so that
/// repeated steps are bitwise identical.
///
/// Not in polybody.hpp: few programs need derivatives of whole runs.

#include <memory>
#include <span>

#include <polybody/gradients/adjoint_through_events.hpp>
#include <polybody/gradients/backward_sweeps.hpp>
#include <polybody/gradients/gradient_result.hpp>
#include <polybody/gradients/objective.hpp>
#include <polybody/gradients/requirements.hpp>

namespace polybody {

/// User function that makes a scenario with an objective function from the values of the parameters, in their order.
template <class F>
concept ObjectiveFactory = requires(F const make, std::span<double const> p) {
  { make(p).model };
  { make(p).start } -> std::convertible_to<State>;
  { make(p).end };
  { make(p).integrand };
};

namespace detail {

/// Forward run and backward sweep of a run without events and breakpoints. \tparam Sweep backward sweep for the
/// integrator's family
template <class Make, class I, template <class, class> class Sweep>
class AdjointRun {
  using S = std::remove_cvref_t<decltype(std::declval<Make const&>()(std::declval<std::span<double const>>()))>;
  using W = Sweep<S, I>;
  using V = typename W::V;
  using M = typename V::Model;
  /// Scenario with one perturbed parameter, and the conversion of its states to full states.
  struct ParameterDifferences {
    S scenario;
    FullStates<M> full_state;
    explicit ParameterDifferences(S of) : scenario(std::move(of)), full_state(scenario.model) {}
  };

 public:
  [[gnu::cold]] AdjointRun(Make const& make, std::vector<Parameter> const& parameters, MethodOf<I> const& method)
      : make_(make),
        parameters_(parameters),
        full_(make(values_of(parameters)), method),
        sweep_(full_),
        derivatives_(full_.scenario.model) {
    require_plain(full_.scenario.options, "gradient");
    require_still(full_.scenario.options);
    for (Parameter const& p : parameters) out_.parameters.push_back(p.name);
    out_.derivatives = VecX::Zero(Index(parameters.size()));
  }

  GradientResult run(GradientOptions const& options) {
    double const from = full_.scenario.start.t;
    full_.scenario.options.check(from);
    require_assembled_start(full_);
    State x = full_.started(begin_plan(from));
    plan(x);
    out_.value += weight(0) * term(full_.scenario.integrand, full_.scenario.model, full_.full_state(x));
    x = W::start_step(full_, std::move(x), steps_.front().h);
    EquationDerivatives<V> equations(make_, parameters_, full_);
    prepare(x, equations);
    Costate bar(x);
    bool at_end = false;
    out_.snapshot_size = size_of_snapshot(x);
    out_.reversal = reverse_steps(
        x, steps_.size(), snapshots_of(options, out_.snapshot_size), [&](std::size_t k, State& y) { take(k, y); },
        [&](std::size_t k, State const& before, State const& after) {
          if (!at_end) begin_at_end(after, bar);
          at_end = true;
          double const left = sweep_.backward_step({before, after, steps_[k].taken}, bar, equations, out_.derivatives);
          out_.left = std::max(out_.left, require_converged(left, after.t, "gradient"));
          if (k > 0) add_integrand(k, before, bar);
        });
    for (std::size_t j = 0; j < parameters_.size(); ++j) out_.derivatives[Index(j)] += bar.dot(starts_[j]);
    warn_of_zeros(out_);
    return std::move(out_);
  }

 private:
  struct Step {
    double h, taken, end;  ///< requested length, actual length and end time [s]
  };
  static constexpr bool chooses = requires { I::adaptive_step; };

  /// Refuses events and breakpoints, which only the generalised-α family supports.
  static void require_still(RunOptions const& o) {
    if (!o.events.empty() || !o.breakpoints.empty())
      throw InvalidInput(
          "gradient.method",
          {ErrorObject{"gradient"},
           ": runs with events or breakpoints need a method of the generalised-α family. Use `sensitivities`."});
  }
  /// Begins the plan of the run at the time t. Returns the length of the first step [s].
  double begin_plan(double t) {
    RunOptions const& options = full_.scenario.options;
    if (!(t < options.end_time))
      throw InvalidInput("gradient.no_step",
                         {ErrorObject{"gradient"}, ": the run has no step. Give an end time after the start."});
    plan_ = StepPlan(t, options.end_time, options.step, full_.system.layout().breakpoints);
    largest_ = options.max_step.value_or(std::numeric_limits<double>::infinity());
    return plan_.next(t, std::min<double>(options.step, largest_)).h;
  }
  /// Plans all steps from x. If the integrator chooses their lengths, the steps are computed.
  void plan(State x) {
    RunOptions const& options = full_.scenario.options;
    double h = std::min<double>(options.step, largest_);
    StepRow row;
    while (x.t < options.end_time) {
      StepPlan::Next const next = plan_.next(x.t, h);
      if (next.jumps)
        throw InvalidInput(
            "gradient.breakpoint",
            {ErrorObject{"gradient"}, ": a drive or load has a breakpoint at t = ", ErrorTime{next.target},
             " s, which only methods of the generalised-α family support. Use smooth functions of time, end the run "
             "before the breakpoint, or use `sensitivities`."});
      Step step{next.h, next.h, 0.0};
      double const from = x.t;
      if constexpr (chooses) {
        StepReport const report = W::step(full_, x, next.h);
        step.taken = report.taken;
        bool const reached = next.lands && report.taken == next.h;
        h = std::min(reached ? std::max(report.next, h) : report.next, largest_);
      }
      x.t = step.end = next.lands && step.taken == next.h ? next.target : row.after(from, step.taken);
      if (W::asks_for_equal_steps(full_) && !steps_.empty() && std::abs(step.h - steps_.back().h) > 1e-9 * step.h)
        throw InvalidInput("gradient.step_length",
                           {ErrorObject{"gradient"}, ": the length of the step to t = ", ErrorTime{step.end},
                            " s differs from the other steps. Set a step that divides the duration of the run, or set "
                            "start_correction to false."});
      steps_.push_back(step);
    }
  }
  /// Weight of a state in the trapezoidal rule of the integral [s].
  double weight(std::size_t state) const {
    double const before = state > 0 ? steps_[state - 1].taken : 0.0;
    return 0.5 * (before + (state < steps_.size() ? steps_[state].taken : 0.0));
  }

  void take(std::size_t k, State& x) {
    StepReport const report = W::step(full_, x, steps_[k].h);
    x.t = steps_[k].end;
    if (k == furthest_) {
      out_.run.add(report);
      ++furthest_;
    }
  }

  void begin_at_end(State const& last, Costate& bar) {
    out_.value += term(full_.scenario.end, full_.scenario.model, full_.full_state(last));
    derivatives_.add(full_.scenario.end, full_.scenario.model, last, 1.0, bar);
    add_to_derivatives(
        [&](ParameterDifferences& b) { return term(b.scenario.end, b.scenario.model, b.full_state(last)); });
    add_integrand(steps_.size(), last, bar);
  }
  /// Adds the weighted integrand at state number k, x, to J, and its derivatives to `bar` and dJ/dp.
  void add_integrand(std::size_t k, State const& x, Costate& bar) {
    if constexpr (std::same_as<decltype(full_.scenario.integrand), NoTerm>) return;
    double const w = weight(k);
    out_.value += w * term(full_.scenario.integrand, full_.scenario.model, full_.full_state(x));
    derivatives_.add(full_.scenario.integrand, full_.scenario.model, x, w, bar);
    add_to_derivatives(
        [&](ParameterDifferences& b) { return w * term(b.scenario.integrand, b.scenario.model, b.full_state(x)); });
  }
  /// Computes the derivatives of the initial state and stores the perturbed scenarios. \param x start of the first step
  void prepare(State const& x, EquationDerivatives<V> const& equations) {
    double const h = steps_.front().h;
    for (std::size_t j = 0; j < parameters_.size(); ++j) {
      Parameter const& p = parameters_[j];
      State dx = zeros_like(x);
      double of_integrand = 0.0;
      for (std::size_t k = 0; k < FourPoints::places.size(); ++k) {
        std::vector<double> values = values_of(parameters_);
        values[j] += FourPoints::places[k] * p.distance();
        V v(make_(values), full_.method);
        require_alike(full_, v, p, "gradient");
        if (k == 0) equations.require_named(j, full_, v, x);
        double const by = FourPoints::weights[k] / p.distance();
        State y = v.started(h);
        of_integrand += by * term(v.scenario.integrand, v.scenario.model, v.full_state(y));
        y = W::start_step(v, std::move(y), h);
        if (!W::begin_alike(x, y))
          throw InvalidInput("gradient.start_correction",
                             {ErrorObject{"gradient"}, ": the start correction depends on \"", p.name,
                              "\". Set start_correction to false."});
        add(dx, y, by);
        perturbed_.push_back(std::make_unique<ParameterDifferences>(std::move(v.scenario)));
      }
      out_.derivatives[Index(j)] += weight(0) * of_integrand;
      starts_.push_back(std::move(dx));
    }
  }
  /// Adds the derivative of f(perturbed scenario) with respect to each parameter to dJ/dp.
  template <class F>
  void add_to_derivatives(F&& f) {
    for (std::size_t j = 0; j < parameters_.size(); ++j) {
      double slope = 0.0;
      for (std::size_t k = 0; k < FourPoints::places.size(); ++k)
        slope += FourPoints::weights[k] / parameters_[j].distance() * f(*perturbed_[4 * j + k]);
      out_.derivatives[Index(j)] += slope;
    }
  }

  Make const& make_;
  std::vector<Parameter> parameters_;
  V full_;
  W sweep_;
  std::vector<std::unique_ptr<ParameterDifferences>> perturbed_;  // four for each parameter
  std::vector<State> starts_;  // derivatives of the state before the first step, one for each parameter
  StepPlan plan_;
  double largest_ = 0.0;
  std::vector<Step> steps_;
  std::size_t furthest_ = 0;  // number of steps computed at least once
  ObjectiveDerivatives<M> derivatives_;
  GradientResult out_;
};

}  // namespace detail

/// Runs the scenario that `make` returns for the values of the parameters, and differentiates its objective function
/// with respect to each parameter. Newton's method iterates until corrections are below 1e-12 or at round-off. \param
/// integrator integrator of the generalised-α family, without `stabilised`; with runge_kutta_step_adjoint.hpp also
/// RungeKutta4 and DormandPrince, whose step lengths are constants; with radau_step_adjoint.hpp also Radau. \throws
/// InvalidInput for invalid parameters or options; if the factory makes models of different sizes; if an event only
/// touches zero; if two events coincide, or other times coincide so that the run is not differentiable; if the steps of
/// a run with start correction, but without events, breakpoints and moving times, differ in length; for events,
/// breakpoints or moving times with a Runge–Kutta method. \throws SingularMatrix in a singular configuration;
/// NonFiniteValue; and the exceptions of `simulate`.
template <ObjectiveFactory Make, class I>
GradientResult gradient(Make const& make, std::vector<Parameter> const& parameters, I const& integrator,
                        GradientOptions const& options = {}) {
  if constexpr (detail::AlphaFamilyIntegrator<I>) {
    AlphaMethod const method = detail::method_of_derivatives(parameters, integrator, "gradient");
    auto const scenario = make(detail::values_of(parameters));
    detail::require_plain(scenario.options, "gradient");
    System const system = system_for<I>(scenario.model);
    if (detail::is_interrupted(scenario, detail::breakpoints_of(system, scenario.options)) ||
        detail::has_moving_times(make, parameters, scenario))
      return detail::AdjointEventHandler<Make, I>(make, parameters, method).run(options);
    return detail::AdjointRun<Make, I, detail::AlphaBackwardSweep>(make, parameters, method).run(options);
  } else {
    static_assert(detail::HasStageAdjoints<I>,
                  "gradient supports GeneralisedAlpha, HhtAlpha, Newmark and Trapezoidal; with "
                  "<polybody/gradients/runge_kutta_step_adjoint.hpp> also RungeKutta4 and DormandPrince, with "
                  "<polybody/gradients/radau_step_adjoint.hpp> also Radau.");
    MethodOf<I> const method = detail::method_of_stages(parameters, integrator);
    if (detail::has_moving_times(make, parameters, make(detail::values_of(parameters)), requires { I::adaptive_step; }))
      throw InvalidInput("gradient.method", {ErrorObject{"gradient"},
                                             ": runs whose start, end or steps depend on a parameter need a method of "
                                             "the generalised-α family. Use `sensitivities`."});
    return detail::AdjointRun<Make, I, detail::StageBackwardSweep>(make, parameters, method).run(options);
  }
}

}  // namespace polybody
