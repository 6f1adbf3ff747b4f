#pragma once
/// \file
/// Run with forward sensitivities, integrated step by step.
/// Theory: Eqs. 8.27, 8.28.

#include <polybody/gradients/perturbed_models.hpp>
#include <polybody/gradients/recorded_run.hpp>

namespace polybody {

// Result of `sensitivities`: outputs of a run and their derivatives.

/// Outputs of a run and their derivatives.
struct SensitivityResult {
  std::vector<std::string> parameters, outputs;  ///< names, with units
  std::vector<double> times;                     ///< (n) start, and end of every step [s]
  std::vector<VecX> values;                      ///< (n) outputs
  /// (n) Derivatives (outputs × parameters) of `values` at `times`, which may change with the parameters.
  std::vector<MatX> derivatives;
  /// (n) Derivatives (parameters) of `times` [s / unit of the parameter]. They are nonzero if the start, a step length,
  /// a breakpoint, an event or the end time depends on a parameter. If a terminal event ends the run, the last
  /// derivative is that of the event time.
  std::vector<VecX> time_derivatives;
  double left = 0.0;  ///< largest relative change in the last correction of a step
  RunReport run;      ///< report of the run itself
};

namespace detail {

/// Direction of differentiation of a step: number j of the parameter, derivative `tangent` of the run, derivative dh of
/// the step length.
struct TangentColumn {
  std::size_t j;
  RunSensitivity* tangent;
  double dh;
};

/// Completed step of a run.
struct SensitivityStep {
  State& before;       ///< state at the start of the step
  State const& after;  ///< state at the end of the step
  double h;            ///< length of the step [s]
  bool searched;       ///< true if an event search computed other steps after this one
};

/// Adds a warning for each parameter without effect. \param affected for each parameter: nonzero if it has an effect
template <class = void>
void warn_of_unused(std::vector<Parameter> const& parameters, std::vector<char> const& affected, RunReport& run) {
  for (std::size_t j = 0; j < parameters.size(); ++j)
    if (!affected[j])
      run.add_warning("Nothing in the run depends on the parameter \"" + parameters[j].name +
                      "\". Remove it, or use it in the model.");
}

/// Run with forward sensitivities; the steps are those of `Simulation`. A step length that the method chooses from its
/// error estimate is a constant in the derivatives. The length of a step to a breakpoint, an event or the end of the
/// run depends on the parameters. \tparam Propagator propagates sensitivities over steps
template <class Make, class I, template <class, class> class Propagator>
class ForwardSensitivities {
  using S = std::remove_cvref_t<decltype(std::declval<Make const&>()(std::declval<std::span<double const>>()))>;
  using V = typename Propagator<S, I>::V;
  using Variants = PerturbedModels<V>;

 public:
  [[gnu::cold]] ForwardSensitivities(Make const& make, std::vector<Parameter> const& parameters,
                                     MethodOf<I> const& method)
      : parameters_(parameters),
        perturbed_(make, parameters, method, "sensitivities"),
        full_(perturbed_.itself().shared, method),
        driver_(full_.scenario.options, out_.run, chooses),
        propagator_(full_) {
    require_plain(full_.scenario.options, "sensitivities");
  }

  SensitivityResult run() {
    options().check(full_.scenario.start.t);
    require_assembled_start(full_);
    x_ = full_.first();
    driver_.plan_run(x_.t, full_.system.layout().breakpoints);
    x_.t = driver_.pass(x_.t);
    begin();
    perturbed_.require_named(x_);
    note();
    while (!driver_.done(x_)) {
      driver_.plan_step(x_);
      driver_.take_step(x_, *this);
    }
    perturbed_.require_named(x_);
    warn_of_unused(parameters_, affected_, out_.run);
    return std::move(out_);
  }

 private:
  friend class polybody::RunDriver;
  static constexpr bool chooses = requires { I::adaptive_step; };

  RunOptions const& options() const { return full_.scenario.options; }

  void begin() {
    affected_.assign(parameters_.size(), 0);
    for (Parameter const& p : parameters_) out_.parameters.push_back(p.name);
    for (auto const& o : full_.scenario.outputs) out_.outputs.push_back(o.name);
    for (std::size_t j = 0; j < parameters_.size(); ++j) {
      tangents_.push_back({zeros_like(x_), perturbed_.of_number(j, [](V const& v) { return v.scenario.start.t; }), {}});
      step_slope_.push_back(chooses ? 0.0 : perturbed_.of_number(j, [](V const& v) { return v.length(); }));
      end_time_slope_.push_back(
          perturbed_.of_number(j, [](V const& v) { return double(v.scenario.options.end_time); }));
    }
    start([&](std::size_t j, double h, double dh, auto const& f) { return perturbed_.of_start(j, h, dh, f); }, {});
    driver_.start_events(x_, *this);
  }
  /// Starts the run and all sensitivities at x_, after the actions of the events `acting`. \param differenced
  /// differenced(parameter, length of the next step, derivative of this length, map) returns the derivative of the map
  template <class Differenced>
  void start(Differenced const& differenced, std::vector<std::size_t> const& acting) {
    StepPlan::Next const next = driver_.next(x_);
    State fresh = x_;
    if (!acting.empty()) {
      fresh = full_.full_state(x_);
      fresh = acted_state(full_, driver_.events(), std::move(fresh));
    }
    full_.start(fresh, next.h);
    auto const map = [&](V& v, State& y, double h) {
      if (!acting.empty()) y = after_actions(v, acting, y);
      v.start_like(fresh, y, h);
    };
    for (std::size_t j = 0; j < parameters_.size(); ++j) {
      RunSensitivity& tangent = tangents_[j];
      tangent.dx = differenced(j, next.h, length_slope(j, next, tangent), map);
      tangent.lengths = StepHistory::lengths_of(tangent.dx);
      StepHistory::lengths_of(tangent.dx) = StepHistory::lengths_of(fresh);
    }
    x_ = std::move(fresh);
  }
  /// Derivative of the length of the next step with respect to parameter j.
  double length_slope(std::size_t j, StepPlan::Next const& next, RunSensitivity const& from) const {
    if (!next.lands) return step_slope_[j];
    return (next.jumps ? perturbed_.times(j).slope(next.target) : end_time_slope_[j]) - from.dt;
  }

  // operations of `RunDriver`
  bool keeps() const { return true; }
  System& stepped_system() { return full_.system; }
  State const& full_state(State const& x) { return full_.full_state(x); }
  StepReport step(State& x, double h) { return full_.step(x, h); }
  StepReport take(State& x, double h) { return full_.step(x, h); }
  void on_step(RunStep const&) {
    if (!options().events.empty()) far_ = x_;
  }
  /// Propagates the sensitivities to the end of the step.
  void on_end(RunStep const& s) {
    require_moving(options().events, driver_.events(), x_.t, "sensitivities");
    double const end = x_.t;
    if (s.met && s.reached && end == s.plan.target) refuse_event_at_breakpoint(end, "sensitivities");
    before_ = driver_.before();
    RunSensitivity step_length_derivative;
    differentiate(s, step_length_derivative);
    if (s.met) move_to_event(step_length_derivative);
    x_.t = end;
  }
  bool requires_restart() const { return false; }
  void on_next(RunStep const& s) {
    if (s.at_breakpoint) require_one_end();
    if (!s.restarts) return;
    State const x = x_;
    auto const acting = s.met ? acting_events(options().events, driver_.events()) : std::vector<std::size_t>();
    start([&](std::size_t j, double h, double dh,
              auto const& f) { return perturbed_.of_map(j, x, tangents_[j], {h, dh}, f); },
          acting);
  }
  void on_done(RunStep const& s) {
    out_.run.add(s.report);
    note();
  }
  void on_failure() {}
  /// Refuses a breakpoint at the end of the run if its time and the end time have different derivatives.
  void require_one_end() const {
    if (x_.t < options().end_time) return;
    for (std::size_t j = 0; j < parameters_.size(); ++j)
      if (std::abs(tangents_[j].dt - end_time_slope_[j]) * parameters_[j].size() > 1e-9 * driver_.step_length())
        refuse_breakpoint_at_end(x_.t, parameters_[j].name, "sensitivities");
  }

  /// Propagates the sensitivities over the parts of the step to x_. The length of the last part varies with the time of
  /// its target. At an event, this length is constant, and `step_length_derivative` receives the derivative with
  /// respect to it.
  void differentiate(RunStep const& s, RunSensitivity& step_length_derivative) {
    for (std::size_t i = 0; i + 1 < s.lengths.size();
         ++i) {  // parts before the last, if error control divided the step
      State part = before_;
      (void)full_.step(part, s.lengths[i]);
      set_columns([](std::size_t) { return 0.0; });
      advance({before_, part, s.lengths[i], true});
      before_ = std::move(part);
    }
    double const h = s.lengths.back();
    StepPlan::Next plan = s.plan;
    plan.lands = s.reached;
    x_.t = before_.t + h;  // just before a breakpoint
    set_columns([&](std::size_t j) { return s.met ? 0.0 : length_slope(j, plan, tangents_[j]); });
    if (s.met) {
      step_length_derivative = {zeros_like(before_), 0.0, VecX::Zero(StepHistory::lengths_of(before_).size())};
      StepHistory::lengths_of(step_length_derivative.dx) = StepHistory::lengths_of(before_);
      columns_.push_back({Variants::along_motion, &step_length_derivative, 1.0});
    }
    advance({before_, x_, h, s.met});
  }
  template <class F>
  void set_columns(F const& dh_of) {
    columns_.clear();
    for (std::size_t j = 0; j < parameters_.size(); ++j) columns_.push_back({j, &tangents_[j], dh_of(j)});
  }
  void advance(SensitivityStep const& step) {
    double const left = propagator_.advance(step, columns_, perturbed_);
    out_.left = std::max(out_.left, require_converged(left, x_.t, "sensitivities"));
  }
  /// Adds the effect of the event time, at which the event value is zero, to the derivatives after a step of fixed
  /// length.
  void move_to_event(RunSensitivity const& step_length_derivative) {
    double const h = driver_.step_length();
    std::vector<double> dh(parameters_.size());
    std::string const* first = nullptr;
    perturbed_.set_state(x_);
    for (std::size_t i = 0; i < options().events.size(); ++i) {
      if (!driver_.events().met(i)) continue;
      Event const& event = options().events[i];
      auto const value = [i](V& v, State const& x) {
        return VecX::Constant(1, v.scenario.options.events[i].value(v.full_state(x))).eval();
      };
      double const rate = perturbed_.of_values(Variants::along_motion, x_, step_length_derivative, h, value)[0],
                   most = std::max(std::abs(event.value(full_.full_state(before_))),
                                   std::abs(event.value(full_.full_state(far_))));
      if (!(std::abs(rate) * (far_.t - before_.t) > 1e-6 * most)) refuse_touch(event.name, x_.t, "sensitivities");
      for (std::size_t j = 0; j < parameters_.size(); ++j) {
        double const own = -perturbed_.of_values(j, x_, tangents_[j], h, value)[0] / rate;
        if (first && std::abs(own - dh[j]) > 1e-6 * (std::abs(own) + h / parameters_[j].size()))
          throw InvalidInput("derivative.coincident_times",
                             {"sensitivities: events \"", ErrorObject{*first}, "\" and \"", event.name,
                              "\" coincide at t = ", ErrorTime{x_.t}, " s, but a change of \"", parameters_[j].name,
                              "\" separates them; the run is not differentiable there. Remove one of the events."});
        if (!first) dh[j] = own;
      }
      first = &event.name;
    }
    for (std::size_t j = 0; j < parameters_.size(); ++j) {
      add(tangents_[j].dx, step_length_derivative.dx, dh[j]);
      tangents_[j].dt += dh[j];
    }
  }

  /// Stores the values and derivatives of the outputs at x_.
  void note() {
    perturbed_.set_state(x_);
    MatX derivatives = MatX::Zero(Index(out_.outputs.size()), Index(parameters_.size()));
    VecX of_time(Index(parameters_.size()));
    auto const outputs = [](V& v, State const& x) { return v.outputs(x); };
    for (std::size_t j = 0; j < parameters_.size(); ++j) {
      RunSensitivity const& tangent = tangents_[j];
      State const& dx = tangent.dx;
      of_time[Index(j)] = tangent.dt;
      derivatives.col(Index(j)) = perturbed_.of_values(j, x_, tangent, driver_.step_length(), outputs);
      if (!affected_[j])
        affected_[j] = std::abs(tangent.dt) > 0.0 || !derivatives.col(Index(j)).isZero(0.0) ||
                       dx.q.squaredNorm() + dx.v.squaredNorm() + dx.a.squaredNorm() > 0.0;
    }
    out_.times.push_back(x_.t);
    out_.values.push_back(full_.outputs(x_));
    out_.derivatives.push_back(std::move(derivatives));
    out_.time_derivatives.push_back(std::move(of_time));
  }

  std::vector<Parameter> parameters_;
  Variants perturbed_;
  V full_;
  RunDriver driver_;
  Propagator<S, I> propagator_;
  State x_, before_, far_;  // present state; state before the last part of the step; end before the search for events
  std::vector<TangentColumn> columns_;
  std::vector<RunSensitivity> tangents_;  // one for each parameter
  std::vector<double> step_slope_, end_time_slope_;
  std::vector<char> affected_;
  SensitivityResult out_;
};

}  // namespace detail
}  // namespace polybody
