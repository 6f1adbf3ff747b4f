#pragma once
/// \file
/// Simulation of a model: a range of states with steps that end at breakpoints, events and stop conditions. Member
/// functions are defined outside the class: a program that links `polybody::compiled` does not compile them again.

#include <polybody/math/sequence.hpp>
#include <polybody/run/axial_force_monitor.hpp>
#include <polybody/run/branch_watch.hpp>
#include <polybody/run/event_action.hpp>
#include <polybody/run/minimum_norm.hpp>
#include <polybody/run/redundancy_watch.hpp>
#include <polybody/run/run_iterator.hpp>
#include <polybody/run/run_snapshot.hpp>
#include <polybody/run/stable_step.hpp>
#include <polybody/run/step_plan.hpp>
#include <polybody/run/step_undo.hpp>

namespace polybody {

/// Input range of states: `for (auto const& now : simulate(…))` gives the initial state and the state at the end of
/// each step, with answers to questions. The run updates the caller's state. Call begin() once.
template <Integrator I, class Solver = DefaultSolver>
class Simulation {
 public:
  /// New run by `integrator`.
  [[gnu::cold]] Simulation(RunSystems systems, State& x, I const& integrator, RunOptions options);

  /// Continues from a snapshot. \throws InvalidInput for a snapshot of another model, integrator or number of events.
  [[gnu::cold]] Simulation(RunSystems systems, State& x, I const& integrator, RunOptions options,
                           RunSnapshot const& from);
  ~Simulation();
  Simulation(Simulation const&) = delete;
  Simulation& operator=(Simulation const&) = delete;

  /// Returns the data for `resume` from the current state. This run discards its other data of earlier steps, such as
  /// factorisations, so that it and a resumed run continue with bitwise identical results. The results of an
  /// uninterrupted run are identical if it takes snapshots at the same times.
  [[gnu::cold]] RunSnapshot snapshot();

  State const& state() const { return *x_; }            ///< state at the end of the last step
  ObservedState const& now() const { return now_; }     ///< this state with answers to questions
  RunReport const& report() const& { return report_; }  ///< report so far
  RunReport report() && { return std::move(report_); }  ///< the report so far, moved out
  System& system() { return *system_; }                 ///< integrated system: the model, or its reduced system
  System& full() { return full_ ? *full_ : *system_; }  ///< system of the full model
  bool done() const { return report_.stopped || stepped().t >= options_.end_time; }  ///< true at the end of the run

  /// Takes a step to the next grid point, or to an earlier breakpoint or event. After an exception the state is
  /// unchanged. \throws InvalidInput if the model has changed since the construction of the run.
  void advance() { advance(true); }

  using Iterator = RunIterator<Simulation>;      ///< takes a step at each increment
  using Sentinel = typename Iterator::Sentinel;  ///< end of the range
  Iterator begin() { return Iterator(this); }    ///< iterator that takes steps
  Sentinel end() const { return {}; }            ///< end of the range

  /// Runs to the end. Returns the report, by value if the simulation is a temporary.
  RunReport const& run() &;
  RunReport run() && { return run(), std::move(report_); }  ///< runs to the end

 private:
  struct Prepared {};
  [[gnu::cold]] Simulation(Prepared, RunSystems systems, State& x, I const& integrator, RunOptions options,
                           double start)
      : system_(std::move(systems.stepped)),
        full_(std::move(systems.full)),
        x_(&x),
        probe_(systems.questions, full()),
        now_(x, probe_),
        method_(method_of(integrator)),
        options_(std::move(options)),
        workspace_(method_.template workspace<Solver>(*system_)),
        norm_(full()),
        axial_forces_(full(), start, options_.end_time),
        start_(start) {
    options_.check(start);
    if (options_.threads != 1) system_->use_threads(options_.threads);
    h_ = requested_step();
    keeps_ = eliminates() || system_->rows() > 0 || !options_.events.empty() || bool(options_.progress) ||
             options_.minimum_norm || axial_forces_.asks();
  }
  /// True if a reduced state is integrated, from which `show` computes the user's state.
  bool eliminates() const { return bool(full_); }
  void advance(bool updates);  ///< `updates`: true to update the user's state too

  /// Replaces the workspace by one without data of earlier steps, ready for the next step. If this fails, nothing
  /// changes.
  [[gnu::cold]] void renew() {
    auto fresh = method_.template workspace<Solver>(*system_);
    State ready = stepped();  // `start` clears its history
    if (system_->rows() > 0) leave_out_redundant(*system_, fresh.forward, ready, &ready.lambda);
    method_.start(*system_, ready, done() ? h_ : plan_.next(ready.t, h_).h, fresh);
    fresh.check.bounds = std::move(workspace_.check.bounds);
    workspace_ = std::move(fresh);
  }

  /// Applies `RunOptions::limits` to the steps from this state on.
  void bound() { workspace_.check.bounds.begin(*system_, options_.limits, step_end()); }
  StepResult step_end() { return {stepped().q, stepped().v, stepped().lambda, stepped().t, h_}; }
  /// Evaluates the energy balance up to the present state, before a restart or an action and at the end of the run.
  /// \param halved number of halved steps that are not in the report yet
  [[gnu::cold]] void settle(int halved) {
    Unexplained const found = workspace_.check.bounds.settle(*system_, step_end());
    if (done()) report_.warn_of_energy(found, options_.limits.warning, {start_, stepped().t, report_.halved + halved});
  }
  State& stepped() { return eliminates() ? reduced_ : *x_; }
  State const& stepped() const { return eliminates() ? reduced_ : *x_; }
  /// Computes the user's state from the reduced state, in `seen_`. \throws NonFiniteValue if a force is not finite in
  /// the computation of reactions. \param seen true if the evaluation of events has already computed `seen_`
  void make_full_state(bool seen) {
    if (!seen) expand(*system_, reduced_, seen_, scratch_);
    require_finite_reactions(*system_, seen_);
  }
  void show() {  // updates the user's state from the reduced state
    if (eliminates()) make_full_state(false), *x_ = seen_;
  }

  /// Reduced initial state: projects the velocities, and makes the checks that require the full model.
  [[gnu::cold]] void reduced_start();
  /// Adds warnings to the report: of an initial state at a branching point, and of a step that is too long for
  /// compliant joints.
  [[gnu::cold]] void warn(ForwardDynamics<Solver>& forward, State const& x) {
    report_.add_warning(warn_of_ambiguous_branch(full(), forward, x));
    if constexpr (HasStabilityLimit<I>) report_.add_warning(warn_of_step<I>(full(), forward, x, h_));
  }

  /// Takes a step of length h. If the step fails with `NewtonConvergenceFailure`, takes two steps of h/2 from a new
  /// start, each of which can be halved again. An integrator that controls its step takes only the first half. After an
  /// exception the state is unchanged.
  StepReport step(double h, int max_step_halvings);

  double max_step() const { return options_.max_step.value_or(std::numeric_limits<double>::infinity()); }
  double requested_step() const { return std::min<double>(options_.step, max_step()); }  // [s]

  /// Breakpoints of the options, driving constraints and loads.
  Sequence<double> breakpoints() const {
    Sequence<double> all = system_->layout().breakpoints;
    all.append(options_.breakpoints.begin(), options_.breakpoints.end());
    return all;
  }

  /// After a start, breakpoint or event: projects the velocities onto the constraint equations, then computes
  /// consistent accelerations. The integrator may look ahead to the end of the next step, but not across a breakpoint.
  [[gnu::cold]] void restart(bool first = false);

  void choose_step(StepReport const& r, bool shortened) {
    if constexpr (requires { I::adaptive_step; }) h_ = std::min(shortened ? std::max(r.next, h_) : r.next, max_step());
  }

  EventMotion motion() {
    auto const seen = [this](State const& x) -> State const& {
      if (!eliminates()) return x;
      expand(*system_, x, seen_, scratch_);
      return seen_;
    };
    return {requested_step(), seen, drift_of(*system_)};
  }
  /// Ends the step of the length `taken` at the first event. Returns true if the run restarts there.
  bool meet_events(double taken) {
    undo_.events = true;
    EventDetector::Step const again = [this](State& x, double h) {
      return method_.step(*system_, x, h, workspace_).taken;
    };
    return watch_.meet(options_.events, {before_, taken, again, motion()}, stepped(), report_);
  }
  /// Operations after the end of a step that may fail: events and their actions, restarts, axial forces and progress.
  void follow(StepReport const& report, bool at_breakpoint, bool remainder_step, bool updates);
  [[gnu::cold]] void undo();  // restores the run after a failure in `follow`
  [[gnu::cold]] void tell_progress(StepReport const& report, bool updates);  // counts the step, then reports progress

  std::unique_ptr<System> system_, full_;  // workspaces contain references to them
  State* x_;
  Probe probe_;  // a separate system, so that questions do not change the run
  ObservedState now_;
  State reduced_, seen_, before_;  // reduced and full state with eliminating policies; state before the step
  MethodOf<I> method_;
  RunOptions options_;
  decltype(std::declval<MethodOf<I> const&>().template workspace<Solver>(std::declval<System&>())) workspace_;
  MinimumNormOf<> norm_;
  AxialForceMonitor axial_forces_;
  VecX scratch_;
  BranchWatch branches_;
  StepUndo undo_;
  StepPlan plan_;
  StepRow row_;
  EventDetector watch_;
  RedundancyWatch<> redundancy_;
  bool keeps_ = false;      // every step stores its initial state
  double h_ = 0.0, start_;  // step length and initial time [s]
  RunReport report_;
};

template <Integrator I, class Solver>
Simulation<I, Solver>::Simulation(RunSystems systems, State& x, I const& integrator, RunOptions options)
    : Simulation(Prepared{}, std::move(systems), x, integrator, std::move(options), x.t) {
  require_fitting(full(), x);
  require_places(full(), x);
  require_computable(full(), x);
  plan_ = StepPlan(x.t, options_.end_time, options_.step, breakpoints());
  require_assembled(full(), x, options_.assembly_tolerance);
  if (eliminates()) reduced_start();
  stepped().t = plan_.pass(stepped().t);
  restart(true);
  if (!options_.events.empty()) watch_.start(options_.events, stepped(), motion());
  if (!eliminates()) {
    if (options_.minimum_norm) norm_.apply(*system_, workspace_.forward, x);
    warn(workspace_.forward, x);
  }
  show();
  undo_.end(stepped());
}

template <Integrator I, class Solver>
Simulation<I, Solver>::Simulation(RunSystems systems, State& x, I const& integrator, RunOptions options,
                                  RunSnapshot const& from)
    : Simulation(Prepared{}, std::move(systems), x, integrator, std::move(options), from.state.t) {
  from.require(identity_of(*system_), I::name, options_.events.size());
  from.require_finite_state();
  if (eliminates()) x = {};
  stepped() = from.state;
  show();
  plan_ = StepPlan(x.t, options_.end_time, options_.step, breakpoints());
  if constexpr (requires { I::adaptive_step; }) h_ = std::min(from.step, max_step());
  row_ = from.row;
  watch_ = EventDetector(from.sides);
  report_ = from.report;
  branches_.begin(*system_, workspace_.forward, stepped());
  renew();
  bound();
  undo_.end(stepped());
}

template <Integrator I, class Solver>
Simulation<I, Solver>::~Simulation() = default;

template <Integrator I, class Solver>
RunSnapshot Simulation<I, Solver>::snapshot() {
  system_->layout().watch.require_unchanged();
  renew();
  watch_.forget();
  return {identity_of(*system_), I::name, stepped(), h_, row_, watch_.sides(), report_};
}

template <Integrator I, class Solver>
void Simulation<I, Solver>::advance(bool updates) {
  system_->layout().watch.require_unchanged();
  double const from = stepped().t, length = watch_.rests() ? std::min(h_, requested_step()) : h_;
  auto const [target, h, lands, jumps] = plan_.next(from, length);
  if (!(from + h > from) || !undo_.fits(stepped())) undo_.refuse_step(stepped(), options_.end_time, h);
  bool const remainder_step = h < 0.01 * length;  // a short step to the grid after a breakpoint or an event
  bool const keeps = keeps_ || lands || remainder_step;
  if (keeps) before_ = stepped();
  undo_.begin(row_, h_, plan_, report_);
  StepTrial trial(workspace_);
  auto const take = [&] { return step(h, options_.allowed_halvings()); };
  try {
    StepReport report = redundancy_.step(*system_, workspace_.forward, stepped(), before_, take, [&] { restart(); });
    report.add(workspace_.check.failed);
    bool const reached = lands && report.taken == h;
    stepped().t = reached ? target : row_.after(from, report.taken);
    choose_step(report, reached);
    follow(report, jumps && reached, remainder_step, updates);
  } catch (Error& failure) {
    if (keeps) undo();
    if (std::string const warned = report_.warned(); !warned.empty()) failure.append(warned);
    throw;
  } catch (...) {
    if (keeps) undo();
    throw;
  }
  trial.keep();
  undo_.end(stepped());
}

template <Integrator I, class Solver>
void Simulation<I, Solver>::follow(StepReport const& report, bool at_breakpoint, bool remainder_step, bool updates) {
  double const end = stepped().t;
  if (system_->rows() > 0) branches_.look(*system_, workspace_.forward, report, before_.v, stepped(), report_.warnings);
  bool const met = !options_.events.empty() && meet_events(report.taken);
  if (met) settle(report.halved);
  bool const acts = met && watch_.acts(options_.events);
  if (acts)
    stepped() = after_action<Solver>(watch_, options_.events, motion().seen(stepped()), {system_.get(), full_.get()},
                                     options_.assembly_tolerance);
  at_breakpoint = at_breakpoint && stepped().t == end;
  if (at_breakpoint) stepped().t = plan_.pass(stepped().t);
  bool const restarts =
      met || at_breakpoint || remainder_step || redundancy_.changes(*system_, workspace_.forward, stepped());
  if (!met && (done() || restarts)) settle(report.halved);
  if (restarts) restart();
  if (acts) watch_.settle(options_.events, stepped(), motion());
  if (!eliminates() && options_.minimum_norm) norm_.apply(*system_, workspace_.forward, *x_);
  if (updates) {
    if (eliminates()) make_full_state(!options_.events.empty() && !restarts);
    if (State const& x = eliminates() ? seen_ : *x_; axial_forces_.is_due(x.t, done())) {
      if (options_.progress) undo_.keep_axial(axial_forces_, report_);
      axial_forces_.look(full(), x, report_.warnings);
    }
  }
  if (options_.progress) return tell_progress(report, updates);
  report_.add(report);
  if (updates && eliminates()) *x_ = seen_;
}

template <Integrator I, class Solver>
void Simulation<I, Solver>::undo() {
  if (undo_.has_user) *x_ = undo_.user;
  stepped() = before_;
  if (undo_.events) watch_.put_back(report_);
  undo_.put_back(row_, h_, plan_, report_, axial_forces_);
}

template <Integrator I, class Solver>
void Simulation<I, Solver>::tell_progress(StepReport const& report, bool updates) {
  undo_.keep_counts(report_);
  report_.add(report);
  if (updates && eliminates()) {
    undo_.keep_user(*x_);
    *x_ = seen_;
  }
  options_.progress({start_, options_.end_time, stepped().t, done()});
}

template <Integrator I, class Solver>
RunReport const& Simulation<I, Solver>::run() & {
  bool const updates = !eliminates() || axial_forces_.asks();  // otherwise the user's state is updated at the end
  try {
    while (!done()) advance(updates);
  } catch (...) {
    try {
      if (!updates) show();
    } catch (...) {  // NOLINT(bugprone-empty-catch): the first exception is thrown again
    }
    throw;
  }
  if (!updates) show();
  return report_;
}

template <Integrator I, class Solver>
void Simulation<I, Solver>::reduced_start() {
  if (options_.minimum_norm)
    throw InvalidInput("run.minimum_norm", {ErrorObject{"simulate"},
                                            ": minimum_norm needs a model in which no constraint equation is "
                                            "eliminated. Use minimum_norm_multipliers for single states."});
  State start = *x_;
  ForwardDynamics<Solver> forward(full());
  forward.project_velocities(full(), start.q, start.v, start.t);
  require_consistent_redundancy(full(), forward, start);
  warn(forward, start);
  reduced_ = reduce(*system_, start);
}

template <Integrator I, class Solver>
StepReport Simulation<I, Solver>::step(double h, int max_step_halvings) {
  try {
    return method_.step(*system_, stepped(), h, workspace_);
  } catch (NewtonConvergenceFailure& failure) {
    if (max_step_halvings == 0) {
      if (int const times = options_.allowed_halvings(); times > 0)
        failure.append(sentence_of({"The step of the run was halved ", times, times == 1 ? " time." : " times."}));
      throw;
    }
  }
  State const before = stepped();
  try {
    workspace_.forward.project_velocities(*system_, stepped().q, stepped().v, stepped().t);
    method_.start(*system_, stepped(), 0.5 * h, workspace_);
    StepReport report = step(0.5 * h, max_step_halvings - 1);
    ++report.halved;
    ++report.rejected;
    if constexpr (!requires { I::adaptive_step; }) report.append(step(h - report.taken, max_step_halvings - 1));
    return report;
  } catch (...) {
    stepped() = before;
    throw;
  }
}

template <Integrator I, class Solver>
void Simulation<I, Solver>::restart(bool first) {
  State fresh = stepped();  // the integrated state is unchanged if the start fails
  workspace_.forward.project_velocities(*system_, fresh.q, fresh.v, fresh.t);
  redundancy_.start(*system_, workspace_.forward, fresh);
  method_.start(*system_, fresh, done() ? h_ : plan_.next(fresh.t, h_).h, workspace_);
  if (first && !eliminates()) require_consistent_redundancy(*system_, workspace_.forward, fresh);
  stepped() = std::move(fresh);
  bound();
  if (first)
    branches_.begin(*system_, workspace_.forward, stepped());
  else
    undo_.keep_redundant(report_);
  redundancy_.name(workspace_.forward.redundant(*system_), workspace_.forward.leaves_out(), report_.redundant);
  if (eliminates())
    for (std::string const& name : system_->step_coordinates().reduced->redundant)
      if (report_.redundant.empty() || report_.redundant.back() != name) report_.redundant.push_back(name);
}

}  // namespace polybody
