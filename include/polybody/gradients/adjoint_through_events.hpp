#pragma once
/// \file
/// Discrete adjoint of a run with breakpoints and events, for integrators of the generalised-α family. The times of
/// breakpoints and events may depend on the parameters.
///
/// A step has the length h and the start time t₀. With the derivatives x̄ and t̄ of a result J with respect to the
/// state x and the time at the end of the step,
///   ∂J/∂h = x̄ᵀ ∂x/∂h + t̄.
/// If the step ends at a breakpoint or at the end of the run, at time T, then dh = dT − dt₀. If the step ends at an
/// event g = 0, then
///   dh = −(∂g/∂p dp + ∂g/∂x₀ dx₀ + ∂g/∂t₀ dt₀)/ġ,
/// with the state x₀ at the start of the step, and derivatives of g at fixed h. Any other step has the requested
/// length, and dh is the change of this length with the parameters.
///
/// The backward sweep over such a step therefore also computes the adjoint variables of g, with ∂g/∂h = ġ. The sweep
/// adds −(∂J/∂h)/ġ times the adjoint variables and the parameter derivatives of g to those of J. This is the transposed
/// saltation relation of the discrete run. The adjoint of a restart is computed by differences of the map from the
/// state before the restart to the state after it.
/// Theory: Eqs. 8.27 to 8.29.

#include <polybody/gradients/gradient_result.hpp>
#include <polybody/gradients/objective.hpp>
#include <polybody/gradients/perturbed_models.hpp>
#include <polybody/gradients/recorded_run.hpp>
#include <polybody/gradients/run_costate.hpp>

namespace polybody::detail {

// Adjoint of the start correction of a step of the generalised-α family (`AlphaMethod::start_step`). The correction
// changes velocities and algorithmic accelerations. Its derivatives are computed by differences.

/// Start correction of velocities and algorithmic accelerations for a step of length h from x, with its adjoint.
/// \tparam V a PerturbedModel
template <class V>
class StartCorrectionAdjoint {
 public:
  /// \param spare model of the run itself; spare and x must outlive this object; \param corrects true if the step has a
  /// start correction
  StartCorrectionAdjoint(V& spare, State const& x, double h, bool corrects)
      : spare_(&spare), x_(&x), h_(h), corrects_(corrects), decided_(V::decided(x, h, corrects)) {}

  /// Step length whose start correction is included in x [s]; zero after a start.
  double shifted() const { return StepHistory::shifted_of(*x_); }

  /// Replaces velocities and algorithmic accelerations of a state y of model v by their changes due to the start
  /// correction.
  void add(V& v, State& y, double length) const { v.set_out_change(y, length, decided_); }

  /// Converts, in place, the adjoint variables `bar` of the corrected velocities and algorithmic accelerations to
  /// adjoint variables of x. Returns the derivative of J with respect to the step length. \param by_time true to
  /// include the time of x; false at a breakpoint
  double pull(RunCostate& bar, bool by_time) const {
    VecX const v = bar.at.v, own = bar.at.own;
    auto const result = [&](State& y, double length) {
      add(*spare_, y, length);
      return v.dot(y.v) + own.dot(StepHistory::own_of(y));
    };
    State const& x = *x_;
    Index const nv = v.size(), nq = x.q.size();
    double const e = 4e-3 * h_;
    if (corrects_) {
      double const of_a = x.a.template lpNorm<Eigen::Infinity>(),
                   of_v = std::max(x.v.template lpNorm<Eigen::Infinity>(), h_ * of_a);
      add_derivatives_by({&State::q, 0, nq, x.q.template lpNorm<Eigen::Infinity>()}, x, h_, result, bar.at.q);
      add_derivatives_by({&State::v, 0, nv, of_v}, x, h_, result, bar.at.v);
      add_derivatives_by({&State::a, 0, nv, of_a}, x, h_, result, bar.at.a);
      auto const [first, count] = StepHistory::points_of_jerk(nv);
      add_derivatives_by({&State::history, first, count, of_a}, x, h_, result, bar.history);
      if (by_time) bar.t += slope_along(x, h_, e, [](State& y, double&, double by) { y.t += by; }, result);
    }
    auto const [first, count] = StepHistory::lengths_of_correction(x.history.size());
    for (Index i = first; i < first + count; ++i)
      if (x.history[i] > 0.0)
        bar.history[i] += slope_along(x, h_, e, [i](State& y, double&, double by) { y.history[i] += by; }, result);
    return slope_along(x, h_, e, [](State&, double& length, double by) { length += by; }, result);
  }

 private:
  V* spare_;
  State const* x_;
  double h_;
  bool corrects_;
  std::optional<bool> decided_;
};

/// Forward run and backward sweep of a run with breakpoints, events, or times that depend on parameters. \tparam I
/// integrator of the generalised-α family
template <class S, class I>
class AdjointEventHandler {
  using V = PerturbedModel<S, I>;
  using M = typename V::Model;
  using Variants = PerturbedModels<V>;

 public:
  /// \param models must outlive this object
  [[gnu::cold]] AdjointEventHandler(Variants& models, std::vector<Parameter> const& parameters,
                                    AlphaMethod const& method)
      : parameters_(parameters),
        perturbed_(models),
        full_(models.itself().shared, method),
        run_(full_, out_.run, Interruptions::handled),
        adjoint_(full_.scenario.model, full_.system, method),
        objective_(full_.scenario.model) {
    for (Parameter const& p : parameters) out_.parameters.push_back(p.name);
    out_.derivatives = VecX::Zero(Index(parameters.size()));
  }

  GradientResult run(GradientOptions const& options) {
    full_.scenario.options.check(full_.scenario.start.t);
    require_assembled_start(full_);
    run_.record();
    State const& first = run_.first();
    perturbed_.require_named(first);
    begin(first);
    require_one_end();
    RunCostate bar(first);
    out_.snapshot_size = size_of_snapshot(first);
    out_.reversal = reverse_steps(
        first, run_.steps().size(), snapshots_of(options, out_.snapshot_size),
        [&](std::size_t k, State& x) { (void)run_.repeat(k, x); },
        [&](std::size_t k, State const& before, State const& after) { back(k, before, after, bar); });
    auto const start = [&](V& v, State& y, double h) { v.start_like(first, y, h); };
    for (std::size_t j = 0; j < parameters_.size(); ++j)
      out_.derivatives[Index(j)] +=
          bar.dot(perturbed_.of_start(j, run_.next().h, length_slope(j, run_.next(), time_slope(j, first)), start));
    warn_of_zeros(out_);
    return std::move(out_);
  }

 private:
  void begin(State const& first) {
    still_ = {zeros_like(first), 0.0, VecX::Zero(StepHistory::lengths_of(first).size())};
    for (std::size_t j = 0; j < parameters_.size(); ++j) {
      step_slope_.push_back(perturbed_.of_number(j, [](V const& v) { return v.length(); }));
      end_time_slope_.push_back(
          perturbed_.of_number(j, [](V const& v) { return double(v.scenario.options.end_time); }));
    }
  }
  /// Derivative of the time of x with respect to parameter j. This time is that of a breakpoint or of the start.
  double time_slope(std::size_t j, State const& x) const { return perturbed_.times(j).slope(x.t); }
  double target_slope(std::size_t j, StepPlan::Next const& plan) const {
    return plan.jumps ? perturbed_.times(j).slope(plan.target) : end_time_slope_[j];
  }
  /// Derivative of the length of a planned step with respect to parameter j. \param dt derivative of the start time
  double length_slope(std::size_t j, StepPlan::Next const& plan, double dt) const {
    return plan.lands ? target_slope(j, plan) - dt : step_slope_[j];
  }
  /// Sensitivity of a run in which only the time changes, with the derivative dt.
  RunSensitivity const& still(double dt) {
    still_.dt = dt;
    return still_;
  }
  /// Refuses a breakpoint at the end of the run if its time and the end time have different derivatives.
  void require_one_end() const {
    RecordedStep const& last = run_.steps().back();
    if (!last.at_breakpoint || last.end < full_.scenario.options.end_time) return;
    for (std::size_t j = 0; j < parameters_.size(); ++j)
      if (std::abs(target_slope(j, last.plan) - end_time_slope_[j]) * parameters_[j].size() > 1e-9 * run_.length())
        refuse_breakpoint_at_end(last.end, parameters_[j].name, "gradient");
  }

  /// Converts the adjoint variables after step k, and after a restart at its end, to adjoint variables before step k.
  void back(std::size_t k, State before, State const& after, RunCostate& bar) {
    RecordedStep const& s = run_.steps()[k];
    bool const last = k + 1 == run_.steps().size(), from_breakpoint = run_.begins_at_breakpoint(k);
    auto const end = [](S const& scenario) -> auto const& { return scenario.end; };
    auto const integrand = [](S const& scenario) -> auto const& { return scenario.integrand; };
    double const half = 0.5 * s.h;
    if (last) {
      perturbed_.require_named(after);
      out_.value += add_term(end, after, {1.0, s.at_breakpoint}, bar);
    }
    State parted;
    if (s.restarts) {
      parted = run_.end(k, before);
      pull_beginning(s, parted, after, bar);
    }
    State const& x = s.restarts ? parted : after;
    if (s.restarts || last) out_.value += add_term(integrand, x, {half, s.at_breakpoint}, bar);
    double of_length = backward_step(k, before, x, bar, out_.derivatives);
    of_length += 0.5 * (rate_of_integral(before) + rate_of_integral(x));
    if (s.met.empty())
      spread_length(s.plan, of_length, bar);
    else
      add_event(k, before, x, of_length, bar);
    double const joined = k > 0 && !run_.steps()[k - 1].restarts ? 0.5 * run_.steps()[k - 1].h : 0.0;
    out_.value += add_term(integrand, before, {half + joined, from_breakpoint}, bar);
    if (from_breakpoint) spread_time(before.t, bar);
  }
  /// Adds the effect of ∂J/∂h of a step, `of_length`, to the derivatives with respect to the parameters and to the
  /// start time of the step.
  void spread_length(StepPlan::Next const& plan, double of_length, RunCostate& bar) {
    for (std::size_t j = 0; j < parameters_.size(); ++j)
      out_.derivatives[Index(j)] += of_length * length_slope(j, plan, 0.0);
    if (plan.lands) bar.t -= of_length;
  }
  /// Adds the effect of the time t of a breakpoint to the derivatives with respect to the parameters.
  void spread_time(double t, RunCostate& bar) {
    for (std::size_t j = 0; j < parameters_.size(); ++j)
      out_.derivatives[Index(j)] += bar.t * perturbed_.times(j).slope(t);
    bar.t = 0.0;
  }

  /// Converts the adjoint variables at the end x of step k to adjoint variables before the step, at fixed step length.
  /// Adds the effect of the parameters to `derivatives`. Returns the derivative of J with respect to the step length.
  double backward_step(std::size_t k, State& before, State const& x, RunCostate& bar, VecX& derivatives) {
    RecordedStep const& s = run_.steps()[k];
    V& spare = perturbed_.itself();
    bool const corrects = spare.method.start_step(spare.system, before, s.h, spare.work);
    State corrected;
    if (corrects) {
      corrected = before;
      corrected.v = spare.work.v0;
    }
    VecX const own_before = spare.work.a0, own_after = StepHistory::own_of(x);
    double const left =
        adjoint_.backward_step({corrects ? corrected : before, x, own_before, own_after, s.h}, bar.at, mu_);
    out_.left = std::max(out_.left, require_converged(left, x.t, "gradient"));
    double of_length = adjoint_.step_length_derivative();
    perturbed_.begin_step();
    typename Variants::template PointInStep<State> const end{x, s.h, 0.0, 0}, later{x, s.h, 1.0, 0};
    for (std::size_t j = 0; j < parameters_.size(); ++j) derivatives[Index(j)] -= perturbed_.product(j, end, mu_);
    bar.t -= perturbed_.product(Variants::along_motion, later, mu_);
    of_length += bar.t + bar.pull_push(before);
    StartCorrectionAdjoint<V> const sets_out(spare, before, s.h, corrects);
    bool const free = (s.plan.lands || !s.met.empty()) && sets_out.shifted() > 0.0;  // h depends on parameters
    if (!corrects && !free) return of_length;
    bool const from_breakpoint = run_.begins_at_breakpoint(k);
    if (corrects) {
      VecX const v = bar.at.v, own = bar.at.own;
      for (std::size_t j = 0; j < parameters_.size(); ++j) {
        State const change =
            perturbed_.of_map(j, before, still(from_breakpoint ? time_slope(j, before) : 0.0), {s.h, 0.0},
                              [&](V& of, State& y, double length) { sets_out.add(of, y, length); });
        derivatives[Index(j)] += v.dot(change.v) + own.dot(StepHistory::own_of(change));
      }
    }
    return of_length + sets_out.pull(bar, !from_breakpoint);
  }
  /// Adds the effect on J of the time of the event that ends step k at x.
  void add_event(std::size_t k, State& before, State const& x, double of_length, RunCostate& bar) {
    RecordedStep const& s = run_.steps()[k];
    std::size_t const i = s.met.front();
    Event const& event = full_.scenario.options.events[i];
    RunCostate of(x);
    VecX derivatives = VecX::Zero(out_.derivatives.size());
    objective_.add([&](M const&, State const& full) { return event.value(full); }, full_.scenario.model, x, 1.0, of.at);
    auto const value = [i](V& v, State const& y) { return v.scenario.options.events[i].value(v.full_state(y)); };
    add_derivatives_of_value(value, x, {1.0, false}, of, derivatives);
    double const rate = backward_step(k, before, x, of, derivatives);
    if (!(std::abs(rate) * s.far > 1e-6 * s.largest)) refuse_touch(event.name, x.t, "gradient");
    bar.add(of, -of_length / rate);
    out_.derivatives -= of_length / rate * derivatives;
  }

  /// Converts the adjoint variables `bar` of the state `after` a restart to adjoint variables of the state x before the
  /// restart.
  void pull_beginning(RecordedStep const& s, State& x, State const& after, RunCostate& bar) {
    double const before_it = x.t, h = s.next.h;
    x.t = s.end;  // at a breakpoint: the time after it
    RunCostate const of = bar;
    bar = RunCostate(x);
    bar.t = of.t;
    auto const begin = [&](V& v, State& y, double length) { RecordedRun<V>::act_and_restart(s, v, after, y, length); };
    auto const result = [&](State& y, double length) {
      begin(perturbed_.itself(), y, length);
      return of.dot(y, after);
    };
    auto const size = [](VecX const& part) { return part.size() > 0 ? part.template lpNorm<Eigen::Infinity>() : 0.0; };
    double const of_a = size(x.a), of_v = std::max(size(x.v), run_.length() * of_a);
    add_derivatives_by({&State::q, 0, x.q.size(), size(x.q)}, x, h, result, bar.at.q);
    add_derivatives_by({&State::v, 0, x.v.size(), of_v}, x, h, result, bar.at.v);
    if (run_.reads_forces(s, x)) {
      add_derivatives_by({&State::a, 0, x.a.size(), of_a}, x, h, result, bar.at.a);
      add_derivatives_by({&State::lambda, 0, x.lambda.size(), size(x.lambda)}, x, h, result, bar.at.lambda);
    }
    double const longer = s.next.lands ? -1.0 : 0.0;
    auto const later = [longer](State& y, double& length, double by) {
      y.t += by;
      length += longer * by;
    };
    if (!s.at_breakpoint) bar.t += slope_along(x, h, 4e-3 * h, later, result);
    for (std::size_t j = 0; j < parameters_.size(); ++j) {
      double const dt = s.at_breakpoint ? time_slope(j, x) : 0.0;
      out_.derivatives[Index(j)] += of.dot(perturbed_.of_map(j, x, still(dt), {h, length_slope(j, s.next, dt)}, begin));
    }
    x.t = before_it;
  }

  struct Weight {
    double by;
    bool at_breakpoint;  // the time of the state is that of a breakpoint
  };
  /// Adds the derivatives of one term of the objective function at x. Returns the contribution of this term to J.
  /// \param pick returns the term of a scenario
  template <class Pick>
  double add_term(Pick const& pick, State const& x, Weight weight, RunCostate& bar) {
    if constexpr (std::same_as<std::remove_cvref_t<decltype(pick(full_.scenario))>, NoTerm>) {
      return 0.0;
    } else {
      auto const value = [&](V& v, State const& y) {
        return term(pick(v.scenario), v.scenario.model, v.full_state(y));
      };
      objective_.add(pick(full_.scenario), full_.scenario.model, x, weight.by, bar.at);
      add_derivatives_of_value(value, x, weight, bar, out_.derivatives);
      return weight.by * value(full_, x);
    }
  }
  double rate_of_integral(State const& x) {
    return term(full_.scenario.integrand, full_.scenario.model, full_.full_state(x));
  }
  /// Adds the derivatives of value(model, state) at x with respect to the parameters and to the time.
  template <class F>
  void add_derivatives_of_value(F const& value, State const& x, Weight weight, RunCostate& bar, VecX& derivatives) {
    auto const values = [&](V& v, State const& y) { return VecX::Constant(1, value(v, y)).eval(); };
    double const h = run_.length();
    perturbed_.set_state(x);
    for (std::size_t j = 0; j < parameters_.size(); ++j) {
      RunSensitivity const& tangent = still(weight.at_breakpoint ? time_slope(j, x) : 0.0);
      derivatives[Index(j)] += weight.by * perturbed_.of_values(j, x, tangent, h, values)[0];
    }
    if (weight.at_breakpoint) return;
    auto const later = [](State& y, double&, double by) { y.t += by; };
    bar.t += weight.by *
             slope_along(x, h, 4e-3 * h, later, [&](State const& y, double) { return value(perturbed_.itself(), y); });
  }

  std::vector<Parameter> parameters_;
  Variants& perturbed_;
  V full_;
  RecordedRun<V> run_;
  AlphaStepAdjoint<> adjoint_;
  ObjectiveDerivatives<M> objective_;
  RunSensitivity still_;
  std::vector<double> step_slope_, end_time_slope_;
  VecX mu_;
  GradientResult out_;
};

/// Returns true if events or breakpoints may end steps of the run of a model.
template <class V>
bool is_interrupted(V const& model) {
  RunOptions const& o = model.scenario.options;
  std::vector<double> const all = model.breakpoints();
  return !o.events.empty() ||
         std::any_of(all.begin(), all.end(), [&](double t) { return t > model.scenario.start.t && t <= o.end_time; });
}

}  // namespace polybody::detail
