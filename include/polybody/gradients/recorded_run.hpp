#pragma once
/// \file
/// A run through corners and events that is taken once and written down, so that each of its steps can be taken again
/// with the same bits.
///
/// Not in polybody.hpp: few programs ask for derivatives of whole runs.

#include <polybody/gradients/full_states.hpp>
#include <polybody/gradients/nondifferentiable_times.hpp>
#include <polybody/gradients/run_sensitivity.hpp>
#include <polybody/run/event_action.hpp>
#include <polybody/run/step_plan.hpp>

namespace polybody::detail {

/// A step of a run, and what ends it.
struct RecordedStep {
  StepPlan::Next plan;                   ///< where it was to go
  double h = 0.0;                        ///< its length [s]
  double end = 0.0;                      ///< time of the run after it [s]
  double far = 0.0, largest = 0.0;       ///< where events are met: length before they were looked for [s], |value|
  std::vector<std::size_t> met, acting;  ///< numbers of the events that end it, and of those that change the state
  bool at_corner = false;                ///< it ends at a corner
  bool restarts = false;                 ///< the run begins anew after it
  StepPlan::Next next;                   ///< what the step after a new beginning was to be
};

/// The steps of a run under a method of fixed steps. \tparam V a Variant
template <class V>
class RecordedRun {
 public:
  /// Takes the run of this scenario, which must outlive it.
  explicit RecordedRun(V& full) : full_(&full) {}

  /// Takes the run once. \throws InvalidInput where it has no step, or an event and a corner at once; as `simulate`.
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

  State const& first() const { return first_; }                    ///< from which the first step sets out
  StepPlan::Next const& next() const { return next_; }             ///< what that step was to be
  std::vector<RecordedStep> const& steps() const { return all_; }  ///< all of them
  double length() const { return h_; }                             ///< that is asked for [s]
  /// The time of the state before step k is that of a corner, or of the start.
  bool begins_at_corner(std::size_t k) const { return k == 0 || all_[k - 1].at_corner; }

  /// Takes step k from x, with what comes after it.
  StepReport take(std::size_t k, State& x) {
    RecordedStep const& s = all_[k];
    StepReport const report = full_->step(x, s.h);
    x.t = s.end;
    if (s.restarts) restart(s, x);
    return report;
  }
  /// The end of step k from x, before what an event does and a new beginning.
  State end(std::size_t k, State x) {
    double const end = x.t + all_[k].h;
    (void)full_->step(x, all_[k].h);
    x.t = end;
    return x;
  }
  /// What the events that act after a step, and the new beginning for a step of h, make of the state y of a variant; as
  /// they made `fresh` in this run.
  static void begin_anew(RecordedStep const& s, V& v, State const& fresh, State& y, double h) {
    if (!s.acting.empty()) y = after(v, s.acting, y);
    v.start_like(fresh, y, h);
  }
  /// What events make of the state x depends on its accelerations or multipliers.
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
    return {h_, [this](State const& x) -> State const& { return full_->shown(x); }, drift_of(full_->system)};
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
    if (met && s.plan.lands && end == s.plan.target) refuse_event_at_corner(end, "gradient");
    s.at_corner = s.plan.jumps && end == s.plan.target;
    if (s.at_corner) x.t = plan_.pass(end);
    s.end = x.t;
    s.restarts = met || s.at_corner || s.plan.h < 0.01 * h_;
    if (s.restarts) {
      bool const done = report.stopped || x.t >= options().end_time;
      s.next = done ? StepPlan::Next{x.t, h_, false, false} : plan_.next(x.t, h_);
      if (!s.acting.empty()) (void)acted_state(*full_, watch_, State(full_->shown(x)));  // refuses what cannot be
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
                            " s. Remove one of the events, or use `sensitivities`, which finds out if they separate "
                            "with a parameter."});
      s.met.push_back(i);
      if (event.action) s.acting.push_back(i);
      s.largest = std::max(std::abs(event.value(full_->shown(before))), std::abs(event.value(full_->shown(far))));
    }
    return true;
  }
  void restart(RecordedStep const& s, State& x) {
    if (!s.acting.empty()) x = after(*full_, s.acting, x);
    full_->start(x, s.next.h);
  }
  /// What acting events make of a state of a variant.
  static State after(V& v, std::vector<std::size_t> const& acting, State const& x) {
    State y = v.shown(x);
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
