#pragma once
/// \file
/// Record of a run with breakpoints and events, from which each step can be repeated with bitwise identical results.
///
/// Not in polybody.hpp: few programs need derivatives of whole runs.

#include <polybody/gradients/full_states.hpp>
#include <polybody/gradients/nondifferentiable_times.hpp>
#include <polybody/gradients/run_sensitivity.hpp>
#include <polybody/run/event_action.hpp>
#include <polybody/run/step_plan.hpp>

namespace polybody::detail {

/// Step of a run, with the events and the breakpoint that end it.
struct RecordedStep {
  StepPlan::Next plan;                   ///< planned end of the step
  double h = 0.0;                        ///< length of the step [s]
  double end = 0.0;                      ///< time after the step [s]
  double far = 0.0, largest = 0.0;       ///< with events: length of the full step [s], largest |event value|
  std::vector<std::size_t> met, acting;  ///< indices of the events that end the step, and of those with an action
  bool at_breakpoint = false;            ///< true if the step ends at a breakpoint
  bool restarts = false;                 ///< true if the integrator starts again after the step
  StepPlan::Next next;                   ///< plan of the next step, if the integrator starts again
};

/// Steps of a run with a method of constant step length. \tparam V a PerturbedModel
template <class V>
class RecordedRun {
 public:
  /// \param full model of the run; must outlive this object
  explicit RecordedRun(V& full) : full_(&full) {}

  /// Computes and records the run. \throws InvalidInput if the run has no step, or if an event coincides with a
  /// breakpoint or another event; and the exceptions of `simulate`.
  void take(RunReport& report) {
    h_ = full_->length();
    std::vector<double> const breakpoints = full_->breakpoints();
    State x = full_->first();
    plan_ = StepPlan(x.t, options().end_time, options().step, Sequence<double>(breakpoints.begin(), breakpoints.end()));
    x.t = plan_.pass(x.t);
    if (!(x.t < options().end_time))
      throw InvalidInput("gradient.no_step",
                         {ErrorObject{"gradient"}, ": the run has no step. Give an end time after the start."});
    next_ = plan_.next(x.t, h_);
    full_->start(x, next_.h);
    if (!options().events.empty()) watch_.start(options().events, x, motion());
    first_ = x;
    while (!report.stopped && x.t < options().end_time) step(x, report);
  }

  State const& first() const { return first_; }                    ///< state before the first step
  StepPlan::Next const& next() const { return next_; }             ///< plan of the first step
  std::vector<RecordedStep> const& steps() const { return all_; }  ///< all steps
  double length() const { return h_; }                             ///< requested step length [s]
  /// True if step k begins at a breakpoint or at the start of the run.
  bool begins_at_breakpoint(std::size_t k) const { return k == 0 || all_[k - 1].at_breakpoint; }

  /// Repeats step k from x, with the event actions and the restart after it.
  StepReport take(std::size_t k, State& x) {
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
    if (!s.acting.empty()) y = after(v, s.acting, y);
    v.start_like(fresh, y, h);
  }
  /// True if the event actions at the state x depend on its accelerations or multipliers.
  bool reads_forces(RecordedStep const& s, State const& x) {
    if (s.acting.empty()) return false;
    State others = x;
    others.a.array() = 1.5 * others.a.array() + 1.0;
    others.lambda.array() = 1.5 * others.lambda.array() + 1.0;
    State const one = after(*full_, s.acting, x), other = after(*full_, s.acting, others);
    return one.q != other.q || one.v != other.v;
  }

 private:
  RunOptions const& options() const { return full_->scenario.options; }
  EventMotion motion() {
    return {h_, [this](State const& x) -> State const& { return full_->full_state(x); }, drift_of(full_->system)};
  }

  void step(State& x, RunReport& report) {
    State const before = x;
    RecordedStep s;
    s.plan = plan_.next(x.t, h_);
    StepReport const taken = full_->step(x, s.plan.h);
    s.h = taken.taken;
    x.t = s.plan.lands ? s.plan.target : row_.after(before.t, s.h);
    bool const met = !options().events.empty() && meet(before, x, s, report);
    double const end = x.t;
    if (met && s.plan.lands && end == s.plan.target) refuse_event_at_breakpoint(end, "gradient");
    s.at_breakpoint = s.plan.jumps && end == s.plan.target;
    if (s.at_breakpoint) x.t = plan_.pass(end);
    s.end = x.t;
    s.restarts = met || s.at_breakpoint || s.plan.h < 0.01 * h_;
    if (s.restarts) {
      bool const done = report.stopped || x.t >= options().end_time;
      s.next = done ? StepPlan::Next{x.t, h_, false, false} : plan_.next(x.t, h_);
      if (!s.acting.empty())
        (void)acted_state(*full_, watch_, State(full_->full_state(x)));  // throws for an invalid action
      restart(s, x);
      if (!s.acting.empty()) watch_.settle(options().events, x, motion());
    }
    report.add(taken);
    all_.push_back(std::move(s));
  }
  /// Ends the step to x at the first event within it.
  bool meet(State const& before, State& x, RecordedStep& s, RunReport& report) {
    struct Trial {
      double end, length;
    };
    std::vector<Trial> trials;
    EventDetector::Step const again = [&](State& y, double part) {
      double const taken = full_->step(y, part).taken;
      trials.push_back({y.t, taken});
      return taken;
    };
    State const far = x;
    if (!watch_.meet(options().events, {before, s.h, again, motion()}, x, report)) return false;
    require_moving(options().events, watch_, x.t, "gradient");
    s.far = s.h;
    if (x.t != far.t)
      s.h = std::find_if(trials.begin(), trials.end(), [&](Trial const& trial) { return trial.end == x.t; })->length;
    for (std::size_t i = 0; i < options().events.size(); ++i) {
      if (!watch_.met(i)) continue;
      Event const& event = options().events[i];
      if (!s.met.empty())
        throw InvalidInput("derivative.coincident_times",
                           {"gradient: events \"", ErrorObject{options().events[s.met.front()].name}, "\" and \"",
                            event.name, "\" coincide at t = ", ErrorTime{x.t},
                            " s. Remove one of the events, or use `sensitivities`, which checks if a parameter "
                            "separates them."});
      s.met.push_back(i);
      if (event.action) s.acting.push_back(i);
      s.largest =
          std::max(std::abs(event.value(full_->full_state(before))), std::abs(event.value(full_->full_state(far))));
    }
    return true;
  }
  void restart(RecordedStep const& s, State& x) {
    if (!s.acting.empty()) x = after(*full_, s.acting, x);
    full_->start(x, s.next.h);
  }
  /// State of a perturbed model after the actions of some events.
  static State after(V& v, std::vector<std::size_t> const& acting, State const& x) {
    State y = v.full_state(x);
    for (std::size_t const i : acting) v.scenario.options.events[i].action(y);
    y.t = x.t;
    return stepped_state(v, std::move(y));
  }

  V* full_;
  State first_;
  StepPlan plan_;
  StepPlan::Next next_{};
  StepRow row_;
  EventDetector watch_;
  double h_ = 0.0;
  std::vector<RecordedStep> all_;
};

}  // namespace polybody::detail
