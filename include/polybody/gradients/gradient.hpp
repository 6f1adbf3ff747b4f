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
/// A forward run is followed by a backward sweep from its end, with the adjoint of each step (`AlphaStepAdjoint` for
/// the generalised-α family). `AdjointEventHandler` performs the sweep over breakpoints and events. The states of the
/// run are stored in snapshots or computed again (`reverse_steps`). A factory makes models from parameters. The
/// equations of these models are differenced at fixed unknowns, as in `sensitivities`. Parameters that affect no common
/// equation share these differences (`Parameter::affects`). All other costs of a step are independent of the number of
/// parameters. Each step begins with a new factorisation, so that repeated steps are bitwise identical.
/// Theory: Eqs. 8.23, 8.24.

#include <span>

#include <polybody/gradients/adjoint_through_events.hpp>
#include <polybody/gradients/alpha_step_adjoint.hpp>
#include <polybody/gradients/gradient_result.hpp>
#include <polybody/gradients/objective.hpp>
#include <polybody/gradients/radau_derivatives.hpp>
#include <polybody/gradients/requirements.hpp>
#include <polybody/gradients/runge_kutta_derivatives.hpp>

namespace polybody::detail {

// Backward sweeps over the steps of a run, one class for each family of integrators.

/// Backward sweep for the generalised-α family.
template <class S, class I>
class AlphaBackwardSweep {
 public:
  using V = PerturbedModel<S, I>;

  explicit AlphaBackwardSweep(V& v) : adjoint_(v.scenario.model, v.system, v.method) {}

  /// State at the start of the first step, of length h, with corrected velocities and algorithmic accelerations.
  static State start_step(V& v, State started, double h) {
    (void)v.start_step(started, h);
    return started;
  }
  /// Returns true if both states have a start correction or both have none.
  static bool begin_alike(State const& x, State const& y) {
    return StepHistory::lengths_of(x) == StepHistory::lengths_of(y);
  }
  /// Returns true if all steps must have the same length.
  static bool asks_for_equal_steps(V const& v) { return v.method.start_correction; }

  /// Converts the adjoint variables after a step to adjoint variables before the step, and adds the effect of the
  /// parameters to `derivatives`. Returns the relative size of the last correction.
  double backward_step(StepTaken const& step, Costate& bar, PerturbedModels<V>& models, VecX& derivatives) {
    VecX const own_before = StepHistory::own_of(step.before), own_after = StepHistory::own_of(step.after);
    double const left = adjoint_.backward_step({step.before, step.after, own_before, own_after, step.h}, bar, mu_);
    models.take_from(derivatives, step.after, step.h, mu_);
    return left;
  }

 private:
  AlphaStepAdjoint<> adjoint_;
  VecX mu_;
};

/// Backward sweep for Runge–Kutta methods.
template <class S, class I>
class StageBackwardSweep {
 public:
  using V = PerturbedStageModel<S, I>;

  explicit StageBackwardSweep(V& v) : adjoint_(v.scenario.model, v.system, v.method) {}

  static State start_step(V&, State started, double) { return started; }
  static bool begin_alike(State const&, State const&) { return true; }
  static bool asks_for_equal_steps(V const&) { return false; }

  double backward_step(StepTaken const& step, Costate& bar, PerturbedModels<V>& models, VecX& derivatives) {
    return adjoint_.backward_step(step, bar, [&](EvaluationPoint<> const& place, VecX const& mu) {
      models.take_from(derivatives, place, step.h, mu);
    });
  }

 private:
  typename I::Derivatives::template StepAdjoint<I> adjoint_;
};

}  // namespace polybody::detail

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
template <class S, class I, template <class, class> class Sweep>
class AdjointRun {
  using W = Sweep<S, I>;
  using V = typename W::V;
  using M = typename V::Model;

 public:
  /// \param models must outlive this object
  [[gnu::cold]] AdjointRun(PerturbedModels<V>& models, std::vector<Parameter> const& parameters,
                           MethodOf<I> const& method)
      : parameters_(parameters),
        models_(models),
        full_(models.itself().shared, method),
        run_(full_, out_.run, Interruptions::refused, chooses),
        sweep_(full_),
        derivatives_(full_.scenario.model) {
    require_plain(full_.scenario.options, "gradient");
    require_still(full_.scenario.options);
    for (Parameter const& p : parameters) out_.parameters.push_back(p.name);
    out_.derivatives = VecX::Zero(Index(parameters.size()));
  }

  GradientResult run(GradientOptions const& options) {
    full_.scenario.options.check(full_.scenario.start.t);
    require_assembled_start(full_);
    run_.record();
    std::vector<RecordedStep> const& steps = run_.steps();
    require_equal_steps();
    State x = run_.first();
    out_.value += weight(0) * term(full_.scenario.integrand, full_.scenario.model, full_.full_state(x));
    x = W::start_step(full_, std::move(x), steps.front().h);
    prepare(x);
    Costate bar(x);
    bool at_end = false;
    out_.snapshot_size = size_of_snapshot(x);
    out_.reversal = reverse_steps(
        x, steps.size(), snapshots_of(options, out_.snapshot_size), [&](std::size_t k, State& y) { take(k, y); },
        [&](std::size_t k, State const& before, State const& after) {
          if (!at_end) begin_at_end(after, bar);
          at_end = true;
          double const left = sweep_.backward_step({before, after, steps[k].taken}, bar, models_, out_.derivatives);
          out_.left = std::max(out_.left, require_converged(left, after.t, "gradient"));
          if (k > 0) add_integrand(k, before, bar);
        });
    for (std::size_t j = 0; j < parameters_.size(); ++j) out_.derivatives[Index(j)] += bar.dot(starts_[j]);
    warn_of_zeros(out_);
    return std::move(out_);
  }

 private:
  static constexpr bool chooses = requires { I::adaptive_step; };

  /// Refuses events and breakpoints, which only the generalised-α family supports.
  static void require_still(RunOptions const& o) {
    if (!o.events.empty() || !o.breakpoints.empty())
      throw InvalidInput(
          "gradient.method",
          {ErrorObject{"gradient"},
           ": runs with events or breakpoints need a method of the generalised-α family. Use such a method, or "
           "`sensitivities`."});
  }
  /// Refuses steps of different lengths if the integrator has a start correction, which depends on the length.
  void require_equal_steps() const {
    if (!W::asks_for_equal_steps(full_)) return;
    std::vector<RecordedStep> const& steps = run_.steps();
    for (std::size_t k = 1; k < steps.size(); ++k)
      if (std::abs(steps[k].h - steps[k - 1].h) > 1e-9 * steps[k].h)
        throw InvalidInput(
            "gradient.step_length",
            {ErrorObject{"gradient"}, ": the length of the step to t = ", ErrorTime{steps[k].end},
             " s differs from that of the step before. Set a step that divides the duration of the run, or set "
             "start_correction to false."});
  }
  /// Weight of a state in the trapezoidal rule of the integral [s].
  double weight(std::size_t state) const {
    std::vector<RecordedStep> const& steps = run_.steps();
    double const before = state > 0 ? steps[state - 1].taken : 0.0;
    return 0.5 * (before + (state < steps.size() ? steps[state].taken : 0.0));
  }

  void take(std::size_t k, State& x) {
    StepReport const report = run_.repeat(k, x);
    if (k == furthest_) {
      out_.run.add(report);
      ++furthest_;
    }
  }

  void begin_at_end(State const& last, Costate& bar) {
    out_.value += term(full_.scenario.end, full_.scenario.model, full_.full_state(last));
    derivatives_.add(full_.scenario.end, full_.scenario.model, last, 1.0, bar);
    add_to_derivatives([&](V& v) { return term(v.scenario.end, v.scenario.model, v.full_state(last)); });
    add_integrand(run_.steps().size(), last, bar);
  }
  /// Adds the weighted integrand at x, which is state number k, to J, and its derivatives to `bar` and dJ/dp.
  void add_integrand(std::size_t k, State const& x, Costate& bar) {
    if constexpr (std::same_as<decltype(full_.scenario.integrand), NoTerm>) return;
    double const w = weight(k);
    out_.value += w * term(full_.scenario.integrand, full_.scenario.model, full_.full_state(x));
    derivatives_.add(full_.scenario.integrand, full_.scenario.model, x, w, bar);
    add_to_derivatives([&](V& v) { return w * term(v.scenario.integrand, v.scenario.model, v.full_state(x)); });
  }
  /// Computes the derivatives of x, the start of the first step. Adds the derivatives of the integrand at the start to
  /// dJ/dp. Checks the `affects` of the parameters.
  void prepare(State const& x) {
    models_.require_named(x);
    double const h = run_.steps().front().h;
    for (std::size_t j = 0; j < parameters_.size(); ++j) {
      Parameter const& p = parameters_[j];
      State dx = zeros_like(x);
      double of_integrand = 0.0;
      for (std::size_t k = 0; k < FourPoints::places.size(); ++k) {
        V& v = models_.perturbed(j, k);
        double const by = FourPoints::weights[k] / p.distance();
        State y = v.started(h);
        of_integrand += by * term(v.scenario.integrand, v.scenario.model, v.full_state(y));
        y = W::start_step(v, std::move(y), h);
        if (!W::begin_alike(x, y))
          throw InvalidInput("gradient.start_correction",
                             {ErrorObject{"gradient"}, ": the start correction depends on \"", p.name,
                              "\". Set start_correction to false."});
        add(dx, y, by);
      }
      out_.derivatives[Index(j)] += weight(0) * of_integrand;
      starts_.push_back(std::move(dx));
    }
  }
  /// Adds the derivative of f(perturbed model) with respect to each parameter to dJ/dp.
  template <class F>
  void add_to_derivatives(F&& f) {
    for (std::size_t j = 0; j < parameters_.size(); ++j) {
      double slope = 0.0;
      for (std::size_t k = 0; k < FourPoints::places.size(); ++k)
        slope += FourPoints::weights[k] / parameters_[j].distance() * f(models_.perturbed(j, k));
      out_.derivatives[Index(j)] += slope;
    }
  }

  std::vector<Parameter> parameters_;
  PerturbedModels<V>& models_;
  V full_;
  RecordedRun<V> run_;
  W sweep_;
  std::vector<State> starts_;  // derivatives of the state before the first step, one for each parameter
  std::size_t furthest_ = 0;   // number of steps computed at least once
  ObjectiveDerivatives<M> derivatives_;
  GradientResult out_;
};

}  // namespace detail

/// Runs the scenario that `make` returns for the values of the parameters, and differentiates its objective function
/// with respect to each parameter. Newton's method iterates until corrections are below 1e-12 or at round-off. \param
/// integrator integrator of the generalised-α family, without `stabilised`; RungeKutta4; DormandPrince, whose step
/// lengths are constants; or Radau. \throws InvalidInput for invalid parameters or options; if the factory makes models
/// of different sizes; if a parameter changes equations of an object outside its `affects`; if the run has no step; if
/// an event only touches zero or remains zero; if two events coincide, or other times coincide so that the run is not
/// differentiable. With a Runge–Kutta method, InvalidInput is also thrown for events, breakpoints, and times that
/// depend on a parameter. A run without events, breakpoints and such times can have a start correction. InvalidInput is
/// then also thrown if the correction depends on a parameter or if the steps have different lengths. \throws
/// SingularMatrix in a singular configuration; NonFiniteValue; and the exceptions of `simulate`.
template <ObjectiveFactory Make, class I>
GradientResult gradient(Make const& make, std::vector<Parameter> const& parameters, I const& integrator,
                        GradientOptions const& options = {}) {
  using S = std::remove_cvref_t<decltype(make(std::span<double const>()))>;
  if constexpr (detail::AlphaFamilyIntegrator<I>) {
    AlphaMethod const method = detail::method_of_derivatives(parameters, integrator, "gradient");
    detail::PerturbedModels<detail::PerturbedModel<S, I>> models(make, parameters, method, "gradient");
    detail::require_plain(models.itself().scenario.options, "gradient");
    if (detail::is_interrupted(models.itself()) || models.has_moving_times(false))
      return detail::AdjointEventHandler<S, I>(models, parameters, method).run(options);
    return detail::AdjointRun<S, I, detail::AlphaBackwardSweep>(models, parameters, method).run(options);
  } else {
    static_assert(detail::HasStageDerivatives<I>,
                  "gradient supports GeneralisedAlpha, HhtAlpha, Newmark, Trapezoidal, RungeKutta4, DormandPrince and "
                  "Radau.");
    MethodOf<I> const method = detail::method_of_stages(parameters, integrator);
    detail::PerturbedModels<detail::PerturbedStageModel<S, I>> models(make, parameters, method, "gradient");
    if (models.has_moving_times(requires { I::adaptive_step; }))
      throw InvalidInput("gradient.method", {ErrorObject{"gradient"},
                                             ": runs whose start, end or steps depend on a parameter need a method of "
                                             "the generalised-α family. Use such a method, or `sensitivities`."});
    return detail::AdjointRun<S, I, detail::StageBackwardSweep>(models, parameters, method).run(options);
  }
}

}  // namespace polybody
