#pragma once
/// \file
/// Run with forward sensitivities, integrated step by step.
///
/// Not in polybody.hpp: few programs need derivatives of whole runs.

#include <polybody/gradients/nondifferentiable_times.hpp>
#include <polybody/gradients/perturbed_models.hpp>
#include <polybody/gradients/sensitivity_result.hpp>
#include <polybody/gradients/sensitivity_step.hpp>

namespace polybody {

namespace detail {

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
        full_(make(values_of(parameters)), method),
        propagator_(full_),
        perturbed_(make, parameters, method, "sensitivities") {
    require_plain(full_.scenario.options, "sensitivities");
  }

  SensitivityResult run() {
    options().check(full_.scenario.start.t);
    require_assembled_start(full_);
    x_ = full_.first();
    h_ = full_.length();
    std::vector<double> const breakpoints = full_.breakpoints();
    plan_ =
        StepPlan(x_.t, options().end_time, options().step, Sequence<double>(breakpoints.begin(), breakpoints.end()));
    x_.t = plan_.pass(x_.t);
    begin();
    perturbed_.require_named(x_);
    note();
    while (!done()) {
      step();
      note();
    }
    perturbed_.require_named(x_);
    warn_of_unused(parameters_, affected_, out_.run);
    return std::move(out_);
  }

 private:
  static constexpr bool chooses = requires { I::adaptive_step; };

  RunOptions const& options() const { return full_.scenario.options; }
  bool done() const { return out_.run.stopped || x_.t >= options().end_time; }

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
    if (!options().events.empty()) watch_.start(options().events, x_, motion());
  }
  /// Starts the run and all sensitivities at x_, after the actions of the events `acting`. \param differenced
  /// differenced(parameter, length of the next step, derivative of this length, map) returns the derivative of the map
  template <class Differenced>
  void start(Differenced const& differenced, std::vector<std::size_t> const& acting) {
    StepPlan::Next const next = done() ? StepPlan::Next{x_.t, h_, false, false} : plan_.next(x_.t, h_);
    State fresh = x_;
    if (!acting.empty()) {
      fresh = full_.full_state(x_);
      fresh = acted_state(full_, watch_, std::move(fresh));
    }
    full_.start(fresh, next.h);
    auto const map = [&](V& v, State& y, double h) {
      if (!acting.empty()) y = after(v, acting, y);
      v.start_like(fresh, y, h);
    };
    for (std::size_t j = 0; j < parameters_.size(); ++j) {
      RunSensitivity& tangent = tangents_[j];
      tangent.dx = differenced(j, next.h, length_slope(j, next, tangent), map);
      tangent.lengths = lengths_of(tangent.dx);
      lengths_of(tangent.dx) = lengths_of(fresh);
    }
    x_ = std::move(fresh);
  }
  /// State of the model v after the actions of the events `acting` in the state x.
  static State after(V& v, std::vector<std::size_t> const& acting, State const& x) {
    State y = v.full_state(x);
    for (std::size_t const i : acting) v.scenario.options.events[i].action(y);
    y.t = x.t;
    return stepped_state(v, std::move(y));
  }
  /// Derivative of the length of the next step with respect to parameter j.
  double length_slope(std::size_t j, StepPlan::Next const& next, RunSensitivity const& from) const {
    if (!next.lands) return step_slope_[j];
    return (next.jumps ? perturbed_.times(j).slope(next.target) : end_time_slope_[j]) - from.dt;
  }

  /// Takes a step to the next time of the plan, or to an event before it.
  void step() {
    before_ = x_;
    StepPlan::Next next = plan_.next(x_.t, h_);
    bool const remainder_step = next.h < 0.01 * h_;
    StepReport const report = full_.step(x_, next.h);
    next.lands = next.lands && report.taken == next.h;
    x_.t = next.lands ? next.target : row_.after(before_.t, report.taken);
    choose_step(report, next.lands);
    lengths_.assign(1, report.taken);
    State far;
    if (!options().events.empty()) far = x_;
    bool const met = !options().events.empty() && meet();
    double const end = x_.t;
    if (met && next.lands && end == next.target) refuse_event_at_breakpoint(x_.t, "sensitivities");
    RunSensitivity step_length_derivative;
    differentiate(next, met, step_length_derivative);
    if (met) move_to_event(step_length_derivative, before_, far);
    x_.t = end;
    bool const at_breakpoint = next.jumps && end == next.target;
    if (at_breakpoint) x_.t = plan_.pass(end);
    if (at_breakpoint) require_one_end();
    if (met || at_breakpoint || remainder_step) restart(met);
    out_.run.add(report);
  }
  void restart(bool met) {
    State const x = x_;
    std::vector<std::size_t> acting;
    for (std::size_t i = 0; met && i < options().events.size(); ++i)
      if (watch_.met(i) && options().events[i].action) acting.push_back(i);
    start([&](std::size_t j, double h, double dh,
              auto const& f) { return perturbed_.of_map(j, x, tangents_[j], {h, dh}, f); },
          acting);
    if (!acting.empty()) watch_.settle(options().events, x_, motion());
  }
  /// Refuses a breakpoint at the end of the run if its time and the end time have different derivatives.
  void require_one_end() const {
    if (x_.t < options().end_time) return;
    for (std::size_t j = 0; j < parameters_.size(); ++j)
      if (std::abs(tangents_[j].dt - end_time_slope_[j]) * parameters_[j].size() > 1e-9 * h_)
        refuse_breakpoint_at_end(x_.t, parameters_[j].name, "sensitivities");
  }

  EventMotion motion() {
    return {full_.length(), [this](State const& x) -> State const& { return full_.full_state(x); },
            drift_of(full_.system)};
  }
  void choose_step(StepReport const& report, bool landed) {
    if constexpr (chooses)
      h_ = std::min<double>(landed ? std::max(report.next, h_) : report.next,
                            options().max_step.value_or(std::numeric_limits<double>::infinity()));
  }
  /// Ends the step to x_ at the first event within it. `lengths_` then contains the steps up to the event.
  bool meet() {
    struct Trial {
      double end;
      std::vector<double> lengths;
    };
    std::vector<Trial> trials;
    EventDetector::Step const again = [&](State& x, double part) {
      if (x.t == before_.t) trials.emplace_back();
      double const taken = full_.step(x, part).taken;
      trials.back().lengths.push_back(taken);
      trials.back().end = x.t;
      return taken;
    };
    double const far = x_.t;
    bool const met = watch_.meet(options().events, {before_, lengths_.front(), again, motion()}, x_, out_.run);
    require_moving(options().events, watch_, x_.t, "sensitivities");
    if (met && x_.t != far)
      lengths_ =
          std::find_if(trials.begin(), trials.end(), [&](Trial const& trial) { return trial.end == x_.t; })->lengths;
    return met;
  }

  /// Propagates the sensitivities over the steps of `lengths_` to x_. The length of the last step varies with the time
  /// of its target, `next`. At an event, this length is constant, and `step_length_derivative` receives the derivative
  /// with respect to it.
  void differentiate(StepPlan::Next const& next, bool met, RunSensitivity& step_length_derivative) {
    for (std::size_t i = 0; i + 1 < lengths_.size(); ++i) {  // parts before the last, if error control divided the step
      State part = before_;
      (void)full_.step(part, lengths_[i]);
      set_columns([](std::size_t) { return 0.0; });
      advance({before_, part, lengths_[i], true});
      before_ = std::move(part);
    }
    x_.t = before_.t + lengths_.back();  // just before a breakpoint
    set_columns([&](std::size_t j) { return met ? 0.0 : length_slope(j, next, tangents_[j]); });
    if (met) {
      step_length_derivative = {zeros_like(before_), 0.0, VecX::Zero(lengths_of(before_).size())};
      lengths_of(step_length_derivative.dx) = lengths_of(before_);
      columns_.push_back({Variants::along_motion, &step_length_derivative, 1.0});
    }
    advance({before_, x_, lengths_.back(), met});
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
  void move_to_event(RunSensitivity const& step_length_derivative, State const& before, State const& far) {
    std::vector<double> dh(parameters_.size());
    std::string const* first = nullptr;
    perturbed_.set_state(x_);
    for (std::size_t i = 0; i < options().events.size(); ++i) {
      if (!watch_.met(i)) continue;
      Event const& event = options().events[i];
      auto const value = [i](V& v, State const& x) {
        return VecX::Constant(1, v.scenario.options.events[i].value(v.full_state(x))).eval();
      };
      double const rate = perturbed_.of_values(Variants::along_motion, x_, step_length_derivative, h_, value)[0],
                   most = std::max(std::abs(event.value(full_.full_state(before))),
                                   std::abs(event.value(full_.full_state(far))));
      if (!(std::abs(rate) * (far.t - before.t) > 1e-6 * most)) refuse_touch(event.name, x_.t, "sensitivities");
      for (std::size_t j = 0; j < parameters_.size(); ++j) {
        double const own = -perturbed_.of_values(j, x_, tangents_[j], h_, value)[0] / rate;
        if (first && std::abs(own - dh[j]) > 1e-6 * (std::abs(own) + h_ / parameters_[j].size()))
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
      derivatives.col(Index(j)) = perturbed_.of_values(j, x_, tangent, h_, outputs);
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
  V full_;
  Propagator<S, I> propagator_;
  Variants perturbed_;
  State x_, before_;             // present state, and state before the step
  std::vector<double> lengths_;  // lengths of the steps between these states
  std::vector<TangentColumn> columns_;
  std::vector<RunSensitivity> tangents_;  // one for each parameter
  std::vector<double> step_slope_, end_time_slope_;
  StepPlan plan_;
  StepRow row_;
  EventDetector watch_;
  double h_ = 0.0;
  std::vector<char> affected_;
  SensitivityResult out_;
};

}  // namespace detail
}  // namespace polybody
