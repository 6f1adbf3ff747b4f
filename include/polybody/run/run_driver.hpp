#pragma once
/// \file
/// Time stepping of a run: ends of steps, halved steps, events, breakpoints, restarts, and the restoration of the run
/// after a failed step. Simulations and differentiated runs use the same driver.

#include <algorithm>
#include <limits>

#include <polybody/run/event_action.hpp>
#include <polybody/run/run_snapshot.hpp>

namespace polybody {

/// Step of a run.
struct RunStep {
  StepPlan::Next plan{};     ///< planned end of the step
  StepReport report;         ///< length and cost of the step, up to its planned end
  Sequence<double> lengths;  ///< lengths of the parts of the step [s]; several parts only before an event
  bool remainder = false;    ///< true for a step below 1 % of the requested length, up to a breakpoint or the end time
  bool reached = false;      ///< true if the integrator reached `plan.target`
  bool met = false;          ///< true if an event ends the step
  bool acts = false;         ///< true if an event that ends the step changes the state
  bool at_breakpoint = false;  ///< true if the step ends at a breakpoint
  bool restarts = false;       ///< true if the integrator must start again at the end of the step
};

/// Driver of a run. The class of a run has this driver as a friend, and these member functions:
///
///     StepReport step(State& x, double h)         // one step of at most h; the search for events repeats steps
///     StepReport step(State&, double h, int n)    // step that can be halved n times; only for `halving_step`
///     StepReport take(State& x, double h)         // the step of the run, for example `halving_step`
///     void start(State& x, double h)              // new start at x for steps of h; only for `halving_step`
///     State const& full_state(State const& x)     // full state of an integrated state, for the values of events
///     System& stepped_system()                    // integrated system
///     bool keeps() const                          // true if x must be stored, since operations after a step may fail
///     void on_step(RunStep& s)                    // after a step, before the search for events
///     void on_end(RunStep& s)                     // at the event or at the planned end: actions of events
///     bool requires_restart()                     // true if the integrator must start again for another reason
///     void on_next(RunStep& s)                    // after breakpoints are passed: restart if `restarts` is true
///     void on_done(RunStep& s)                    // after all operations of the step that change the state
///     void on_failure()                           // restores the other data of the run after a failed step
class RunDriver {
 public:
  /// \param options options, must outlive the driver \param report report of the run, must outlive the driver
  /// \param adaptive true if the integrator chooses the lengths of its steps
  [[gnu::cold]] RunDriver(RunOptions const& options, RunReport& report, bool adaptive)
      : options_(&options), report_(&report), adaptive_(adaptive), h_(requested_step()) {}

  /// Plans the run from the time `start`. \param of_system breakpoints of driving constraints and loads [s]
  [[gnu::cold]] void plan_run(double start, Sequence<double> const& of_system) {
    Sequence<double> all = of_system;
    all.append(options_->breakpoints.begin(), options_->breakpoints.end());
    plan_ = StepPlan(start, options_->end_time, options_->step, std::move(all));
  }
  /// Passes the breakpoints at the start time t. Returns t, or a breakpoint or end time that follows t by round-off
  /// only.
  double pass(double t) { return plan_.pass(t); }
  /// Evaluates the events at the start x of the run.
  template <class Run>
  [[gnu::cold]] void start_events(State const& x, Run& run) {
    if (!options_->events.empty()) events_.start(options_->events, x, motion(run));
  }

  double requested_step() const { return std::min<double>(options_->step, max_step()); }  ///< requested step length [s]
  double step_length() const { return h_; }                ///< length of the next step, if no breakpoint is near [s]
  State const& before() const { return before_; }          ///< state before the present step, if it is stored
  EventDetector const& events() const { return events_; }  ///< events of the last step
  /// True at the end of the run.
  bool done(State const& x) const { return report_->stopped || x.t >= options_->end_time; }
  /// Plan of the step from x. At the end of the run the step has the length `step_length()`.
  StepPlan::Next next(State const& x) const {
    return done(x) ? StepPlan::Next{x.t, h_, false, false} : plan_.next(x.t, h_);
  }

  /// Plans the next step, from x.
  RunStep const& plan_step(State const& x) {
    double const length = events_.rests() ? std::min(h_, requested_step()) : h_;
    step_.plan = plan_.next(x.t, length);
    step_.remainder = step_.plan.h < 0.01 * length;
    return step_;
  }
  /// Takes the planned step of `run` from x, and stores the end of the step in x. After an exception x and the driver
  /// are unchanged.
  template <class Run>
  void take_step(State& x, Run& run) {
    RunStep& s = step_;
    bool const keeps = run.keeps() || s.plan.lands || s.remainder;
    if (keeps) before_ = x;
    saved_ = {row_, h_, plan_.passed(), false};
    try {
      advance(x, run);
    } catch (...) {
      if (keeps) {
        x = before_;
        go_back();
        run.on_failure();
      }
      throw;
    }
  }
  /// Takes a step of `run` of length h. If the step fails with `NewtonConvergenceFailure`, takes two steps of h/2 from
  /// a new start, each of which can be halved again. An integrator that controls its step takes only the first half.
  /// A halving with a successful first half does not count: if a law jumps at the end of a step, the second halves
  /// become so short that the jump moves the bodies by less than the round-off. After an exception x is unchanged.
  /// \param halvings largest number of halvings that count \param depth number of halvings so far, at most 30
  template <class Run>
  StepReport halving_step(State& x, double h, int halvings, Run& run, int depth = 0);

  /// Stores step length, row of equal steps (`StepRow`) and signs of events in a snapshot. The run then continues like
  /// a resumed run.
  [[gnu::cold]] void store(RunSnapshot& to) {
    events_.forget();
    to.step = h_;
    to.row = row_;
    to.sides = events_.sides();
  }
  /// Continues from a snapshot.
  [[gnu::cold]] void resume(RunSnapshot const& from) {
    if (adaptive_) h_ = std::min(from.step, max_step());
    row_ = from.row;
    events_ = EventDetector(from.sides);
  }

 private:
  struct Saved {
    StepRow row;
    double h = 0.0;  ///< length of the next step [s]
    std::size_t passed = 0;
    bool searched = false;  // events were evaluated in this step
  };
  /// Parts of one trial step in the search for events, from the start of the step of the run.
  struct Trial {
    double end = 0.0;  ///< time of the end [s]
    Sequence<double> lengths = {};
  };

  double max_step() const { return options_->max_step.value_or(std::numeric_limits<double>::infinity()); }

  template <class Run>
  EventMotion motion(Run& run) {
    return {requested_step(), [&run](State const& x) -> State const& { return run.full_state(x); },
            drift_of(run.stepped_system())};
  }

  template <class Run>
  void advance(State& x, Run& run) {
    RunStep& s = step_;
    double const from = x.t;
    s.report = run.take(x, s.plan.h);
    double const taken = s.report.taken;
    s.reached = s.plan.lands && taken == s.plan.h;
    x.t = s.reached ? s.plan.target : row_.after(from, taken);
    if (adaptive_) h_ = std::min(s.reached ? std::max(s.report.next, h_) : s.report.next, max_step());
    s.lengths.assign(1, taken);
    run.on_step(s);
    double const end = x.t;
    s.met = !options_->events.empty() && meet_events(x, run);
    s.acts = s.met && events_.acts(options_->events);
    run.on_end(s);
    s.at_breakpoint = s.plan.jumps && s.reached && x.t == end;
    if (s.at_breakpoint) x.t = plan_.pass(x.t);
    s.restarts = s.met || s.at_breakpoint || s.remainder || run.requires_restart();
    run.on_next(s);
    if (s.acts) events_.settle(options_->events, x, motion(run));
    run.on_done(s);
  }

  /// Ends the step to x at its first event. Returns true if an event occurred, or if an event value is held at zero.
  template <class Run>
  bool meet_events(State& x, Run& run) {
    saved_.searched = true;
    trials_.clear();
    EventDetector::Step const again = [this, &run](State& y, double h) {  // two pointers: no memory is allocated
      if (y.t == before_.t) trials_.push_back({});
      double const taken = run.step(y, h).taken;
      trials_.back().lengths.push_back(taken);
      trials_.back().end = y.t;
      return taken;
    };
    double const end = x.t;
    bool const met = events_.meet(options_->events, {before_, step_.lengths.front(), again, motion(run)}, x, *report_);
    if (met && x.t != end)
      for (std::size_t i = trials_.size(); i-- > 0;)
        if (trials_[i].end == x.t) step_.lengths = trials_[i].lengths;
    return met;
  }

  [[gnu::cold]] void go_back() {
    row_ = saved_.row;
    h_ = saved_.h;
    plan_.go_back(saved_.passed);
    if (saved_.searched) events_.put_back(*report_);
  }

  RunOptions const* options_;
  RunReport* report_;
  bool adaptive_;
  double h_;
  StepPlan plan_;
  StepRow row_;
  EventDetector events_;
  RunStep step_;
  State before_;
  Saved saved_;
  Sequence<Trial> trials_;
};

template <class Run>
StepReport RunDriver::halving_step(State& x, double h, int halvings, Run& run, int depth) {
  constexpr int deepest = 30;
  int const allowed = options_->allowed_halvings();
  try {
    return run.step(x, h, std::max(0, allowed - depth));
  } catch (NewtonConvergenceFailure& failure) {
    if (halvings == 0 || depth == deepest) {
      if (int const times = depth == deepest ? depth : allowed; times > 0)
        failure.append(sentence_of({"The step of the run was halved ", times, times == 1 ? " time." : " times."}));
      throw;
    }
  }
  State const before = x;
  try {
    run.start(x, 0.5 * h);
    StepReport report = halving_step(x, 0.5 * h, halvings - 1, run, depth + 1);
    ++report.halved;
    ++report.rejected;
    if (!adaptive_) report.append(halving_step(x, h - report.taken, halvings, run, depth + 1));
    return report;
  } catch (...) {
    x = before;
    throw;
  }
}

}  // namespace polybody
