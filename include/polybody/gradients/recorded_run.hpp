#pragma once
/// \file
/// Record of a run with breakpoints and events, from which each step can be repeated with bitwise identical results.

#include <polybody/gradients/run_sensitivity.hpp>
#include <polybody/run/run_driver.hpp>

namespace polybody::detail {

// Exceptions for times at which a run is not differentiable. Messages begin with `who`, the name of the calling
// function.

/// \throws InvalidInput always: an event coincides with a breakpoint or the end of the run at t [s].
template <class = void>
[[noreturn, gnu::cold]] void refuse_event_at_breakpoint(double t, char const* who) {
  throw InvalidInput(
      "derivative.coincident_times",
      {ErrorObject{who}, ": an event coincides with a breakpoint or with the end of the run at t = ", ErrorTime{t},
       " s; the run is not differentiable there. Move the breakpoint or the end of the run by at least one step."});
}
/// \throws InvalidInput always: the run ends at t [s] at a breakpoint that moves with the parameter `name`.
template <class = void>
[[noreturn, gnu::cold]] void refuse_breakpoint_at_end(double t, std::string const& name, char const* who) {
  throw InvalidInput(
      "derivative.coincident_times",
      {ErrorObject{who}, ": a breakpoint at the end of the run, t = ", ErrorTime{t}, " s, moves with \"", name,
       "\", but the end does not; the run is not differentiable there. End the run at least one step before or after "
       "the breakpoint."});
}
/// \throws InvalidInput always: the value of the event `name` touches zero at t [s] and does not pass through it.
template <class = void>
[[noreturn, gnu::cold]] void refuse_touch(std::string const& name, double t, char const* who) {
  throw InvalidInput("derivative.event",
                     {ErrorObject{who}, ": the event \"", name, "\" only touches zero at t = ", ErrorTime{t},
                      " s, so its time has no derivative. Use an event value that passes through zero with a "
                      "nonzero rate."});
}

/// \throws InvalidInput if the value of one of the `events` remains at zero from t [s] on.
template <class = void>
[[gnu::cold]] void require_moving(std::vector<Event> const& events, EventDetector const& watch, double t,
                                  char const* who) {
  std::size_t const i = watch.first_held();
  if (i < events.size())
    throw InvalidInput(
        "derivative.event",
        {ErrorObject{who}, ": the value of the event \"", events[i].name, "\" remains zero from t = ", ErrorTime{t},
         " s on, after accumulating impacts. The run is not differentiable there. End the run before "
         "this time."});
}

/// Step of a run, with the events and the breakpoint that end it.
struct RecordedStep {
  StepPlan::Next plan;              ///< planned end of the step
  double h = 0.0;                   ///< length with which the step is repeated [s]
  double taken = 0.0;               ///< actual length of the step, at most `h` [s]
  double end = 0.0;                 ///< time after the step [s]
  double far = 0.0, largest = 0.0;  ///< if an event ends the step: length before the search [s], largest |event value|
  std::vector<std::size_t> met, acting;  ///< indices of the events that end the step, and of those with an action
  bool at_breakpoint = false;            ///< true if the step ends at a breakpoint
  bool restarts = false;                 ///< true if the integrator starts again after the step
  StepPlan::Next next;                   ///< plan of the next step, if the integrator starts again
};

/// Reduced state of the model v after the actions of the events `acting` in the reduced state x.
template <class V>
State after_actions(V& v, std::vector<std::size_t> const& acting, State const& x) {
  State y = v.full_state(x);
  for (std::size_t const i : acting) v.scenario.options.events[i].action(y);
  y.t = x.t;
  return stepped_state(v, std::move(y));
}
/// Indices of the events that end the last step and have an action.
template <class = void>
std::vector<std::size_t> acting_events(std::vector<Event> const& events, EventDetector const& watch) {
  std::vector<std::size_t> acting;
  for (std::size_t i = 0; i < events.size(); ++i)
    if (watch.met(i) && events[i].action) acting.push_back(i);
  return acting;
}

/// Treatment of events and breakpoints in a recorded run.
enum class Interruptions {
  handled,  ///< events and breakpoints end steps of a constant length early; the integrator starts again there
  refused   ///< breakpoints are refused; steps of known length are planned but not computed
};

/// Steps of a run. \tparam V a PerturbedModel or PerturbedStageModel
template <class V>
class RecordedRun {
 public:
  /// \param full model of the run \param report report of the run; both must outlive this object \param adaptive true
  /// if the integrator chooses the lengths of its steps
  RecordedRun(V& full, RunReport& report, Interruptions interruptions, bool adaptive = false)
      : full_(&full),
        report_(&report),
        interrupted_(interruptions == Interruptions::handled),
        computes_(interrupted_ || adaptive),
        driver_(full.scenario.options, report, adaptive) {}

  /// Records the run. \throws InvalidInput if the run has no step; if an event coincides with a breakpoint, the end of
  /// the run or another event; if an event value remains zero; if the run has a breakpoint and breakpoints are refused;
  /// and the exceptions of `simulate`.
  void record() {
    x_ = full_->first();
    driver_.plan_run(x_.t, full_->system.layout().breakpoints);
    x_.t = driver_.pass(x_.t);
    if (!(x_.t < options().end_time))
      throw InvalidInput("gradient.no_step",
                         {ErrorObject{"gradient"}, ": the run has no step. Give an end time after the start."});
    next_ = driver_.next(x_);
    full_->start(x_, next_.h);
    driver_.start_events(x_, *this);
    first_ = x_;
    while (!driver_.done(x_)) {
      StepPlan::Next const& plan = driver_.plan_step(x_).plan;
      if (plan.jumps && !interrupted_) refuse_breakpoint(plan.target);
      driver_.take_step(x_, *this);
    }
  }

  State const& first() const { return first_; }                    ///< state before the first step
  StepPlan::Next const& next() const { return next_; }             ///< plan of the first step
  std::vector<RecordedStep> const& steps() const { return all_; }  ///< all steps
  double length() const { return driver_.requested_step(); }       ///< requested step length [s]
  /// True if step k begins at a breakpoint or at the start of the run.
  bool begins_at_breakpoint(std::size_t k) const { return k == 0 || all_[k - 1].at_breakpoint; }

  /// Repeats step k from x, with the event actions and the restart after it.
  StepReport repeat(std::size_t k, State& x) {
    RecordedStep const& s = all_[k];
    StepReport const report = full_->step(x, s.h);
    x.t = s.end;
    if (s.restarts) restart(s, x);
    return report;
  }
  /// State at the end of step k from x, before event actions and a restart.
  State end(std::size_t k, State x) {
    double const end = x.t + all_[k].h;
    (void)full_->step(x, all_[k].h);
    x.t = end;
    return x;
  }
  /// Applies the event actions after a step, and the restart for a step of length h, to a state y of a perturbed model.
  /// The restart uses the start correction if the restarted state `fresh` of this run has it.
  static void act_and_restart(RecordedStep const& s, V& v, State const& fresh, State& y, double h) {
    if (!s.acting.empty()) y = after_actions(v, s.acting, y);
    v.start_like(fresh, y, h);
  }
  /// True if the event actions at the state x depend on its accelerations or multipliers.
  bool reads_forces(RecordedStep const& s, State const& x) {
    if (s.acting.empty()) return false;
    State others = x;
    others.a.array() = 1.5 * others.a.array() + 1.0;
    others.lambda.array() = 1.5 * others.lambda.array() + 1.0;
    State const one = after_actions(*full_, s.acting, x), other = after_actions(*full_, s.acting, others);
    return one.q != other.q || one.v != other.v;
  }

 private:
  friend class polybody::RunDriver;

  RunOptions const& options() const { return full_->scenario.options; }

  [[noreturn, gnu::cold]] static void refuse_breakpoint(double t) {
    throw InvalidInput(
        "gradient.breakpoint",
        {ErrorObject{"gradient"}, ": a drive or load has a breakpoint at t = ", ErrorTime{t},
         " s, which only methods of the generalised-α family support. Use smooth functions of time, end the run "
         "before the breakpoint, or use `sensitivities`."});
  }

  // operations of `RunDriver`
  bool keeps() const { return interrupted_; }
  System& stepped_system() { return full_->system; }
  State const& full_state(State const& x) { return full_->full_state(x); }
  StepReport step(State& x, double h) { return full_->step(x, h); }
  StepReport take(State& x, double h) {
    if (computes_) return step(x, h);
    StepReport planned;
    planned.taken = h;
    return planned;
  }
  void on_step(RunStep const&) {
    if (!options().events.empty()) far_ = x_;
  }
  void on_end(RunStep const& s) {
    all_.emplace_back();
    RecordedStep& now = all_.back();
    now.plan = s.plan;
    now.taken = s.lengths.back();
    now.h = s.met ? now.taken : s.plan.h;
    if (!s.met) return;
    require_moving(options().events, driver_.events(), x_.t, "gradient");
    now.far = s.report.taken;
    record_events(now);
    if (s.reached && x_.t == s.plan.target) refuse_event_at_breakpoint(x_.t, "gradient");
  }
  bool requires_restart() const { return false; }
  void on_next(RunStep const& s) {
    RecordedStep& now = all_.back();
    now.at_breakpoint = s.at_breakpoint;
    now.end = x_.t;
    now.restarts = s.restarts && interrupted_;
    if (!now.restarts) return;
    now.next = driver_.next(x_);
    if (!now.acting.empty())
      (void)acted_state(*full_, driver_.events(), State(full_->full_state(x_)));  // throws for an invalid action
    restart(now, x_);
  }
  void on_done(RunStep const& s) {
    if (interrupted_) report_->add(s.report);
  }
  void on_failure() {}

  /// Records the event that ends a step at x_. \throws InvalidInput for two events.
  void record_events(RecordedStep& s) {
    std::vector<Event> const& events = options().events;
    for (std::size_t i = 0; i < events.size(); ++i) {
      if (!driver_.events().met(i)) continue;
      Event const& event = events[i];
      if (!s.met.empty())
        throw InvalidInput("derivative.coincident_times",
                           {"gradient: events \"", ErrorObject{events[s.met.front()].name}, "\" and \"", event.name,
                            "\" coincide at t = ", ErrorTime{x_.t},
                            " s. Remove one of the events, or use `sensitivities`, which checks if a parameter "
                            "separates them."});
      s.met.push_back(i);
      s.largest = std::max(std::abs(event.value(full_->full_state(driver_.before()))),
                           std::abs(event.value(full_->full_state(far_))));
    }
    s.acting = acting_events(events, driver_.events());
  }
  void restart(RecordedStep const& s, State& x) {
    if (!s.acting.empty()) x = after_actions(*full_, s.acting, x);
    full_->start(x, s.next.h);
  }

  V* full_;
  RunReport* report_;
  bool interrupted_, computes_;  // true if events and breakpoints are handled; true if steps are computed
  RunDriver driver_;
  State first_, x_, far_;  // state before the first step; present state; end of a step before the search for events
  StepPlan::Next next_{};
  std::vector<RecordedStep> all_;
};

}  // namespace polybody::detail
