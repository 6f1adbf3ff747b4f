#pragma once
/// \file
/// Simulation of a model: a range of states with steps that end at grid points, breakpoints, events and the end time.
/// Member functions are defined outside the class, so that a program that links `polybody::compiled` does not compile
/// them again.

#include <cstddef>
#include <memory>

#include <polybody/math/sequence.hpp>
#include <polybody/run/axial_force_monitor.hpp>
#include <polybody/run/constraint_watches.hpp>
#include <polybody/run/minimum_norm.hpp>
#include <polybody/run/probe.hpp>
#include <polybody/run/run_driver.hpp>
#include <polybody/run/stable_step.hpp>
#include <polybody/run/step_undo.hpp>

namespace polybody {

/// Systems of a run: the integrated one, and the full one if policies eliminate unknowns.
struct RunSystems {
  std::unique_ptr<System> stepped;  ///< integrated system; a pointer, because workspaces refer to it
  std::unique_ptr<System> full;     ///< full system; null if policies eliminate nothing
  SystemSource questions = {};      ///< makes full systems, for evaluations of the states of the run
};

/// Iterator over the states of a simulation, one for each step: `for (auto const& now : simulate(…))`.
/// \tparam Run a Simulation
template <class Run>
class RunIterator {
 public:
  /** End of the range. */ struct Sentinel {};
  using value_type = State;                                       ///< for std::input_iterator
  using difference_type = std::ptrdiff_t;                         ///< for std::input_iterator
  explicit RunIterator(Run* run) : run_(run) {}                   ///< iterator of this run
  ObservedState const& operator*() const { return run_->now(); }  ///< state at the end of the last step
  /** Takes a step, or ends if the run is done. */ RunIterator& operator++() {
    if (run_->done())
      finished_ = true;
    else
      run_->advance();
    return *this;
  }
  void operator++(int) { ++*this; }                      ///< takes a step
  bool operator==(Sentinel) const { return finished_; }  ///< true past the last state of the run

 private:
  Run* run_;
  bool finished_ = false;
};

/// Input range of states: `for (auto const& now : simulate(…))` gives the initial state and the state at the end of
/// each step, each as an `ObservedState`. The run updates the caller's state. Call begin() once.
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

  /// Returns the data for `resume`, and discards other data of earlier steps, such as factorisations. This run and a
  /// resumed run then continue with bitwise identical results, as does a run with snapshots at the same times.
  [[gnu::cold]] RunSnapshot snapshot();

  State const& state() const { return *x_; }             ///< state at the end of the last step
  ObservedState const& now() const { return now_; }      ///< state at the end of the last step, with its evaluation
  RunReport const& report() const& { return report_; }   ///< report so far
  RunReport report() && { return std::move(report_); }   ///< the report so far, moved out
  System& system() { return *system_; }                  ///< integrated system: the model, or its reduced system
  System& full() { return full_ ? *full_ : *system_; }   ///< system of the full model
  bool done() const { return driver_.done(stepped()); }  ///< true at the end of the run

  /// Takes a step to the next grid point, or to an earlier breakpoint or event. After an exception the state is
  /// unchanged. \throws InvalidInput if the model has changed since the construction of the run; the exceptions of a
  /// step (`simulate`).
  void advance() { advance(true); }

  using Iterator = RunIterator<Simulation>;      ///< takes a step at each increment
  using Sentinel = typename Iterator::Sentinel;  ///< end of the range
  Iterator begin() { return Iterator(this); }    ///< iterator that takes steps
  Sentinel end() const { return {}; }            ///< end of the range

  /// Runs to the end. Returns the report, by value if the simulation is a temporary.
  RunReport const& run() &;
  RunReport run() && { return run(), std::move(report_); }  ///< runs to the end

 private:
  friend class RunDriver;
  static constexpr bool adaptive = requires { I::adaptive_step; };
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
        driver_(options_, report_, adaptive),
        workspace_(method_.template workspace<Solver>(*system_)),
        norm_(full()),
        axial_forces_(full(), start, options_.end_time),
        start_(start) {
    options_.check(start);
    if (options_.threads != 1) system_->use_threads(options_.threads);
    keeps_ = eliminates() || system_->rows() > 0 || !options_.events.empty() || bool(options_.progress) ||
             options_.minimum_norm || axial_forces_.asks();
  }
  /// True if a reduced state is integrated, from which `show` computes the user's state.
  bool eliminates() const { return bool(full_); }
  void advance(bool updates);  ///< `updates`: true to update the user's state too

  /// Discards data of earlier steps, and restarts the energy balance. A failure changes nothing.
  [[gnu::cold]] void renew() {
    auto fresh = method_.template workspace<Solver>(*system_);
    State ready = stepped();  // `start` clears its history
    if (system_->rows() > 0) leave_out_redundant(*system_, fresh.forward, ready, &ready.lambda);
    method_.start(*system_, ready, driver_.next(ready).h, fresh);
    (void)workspace_.check.bounds.settle(*system_, step_end());
    fresh.check.bounds = std::move(workspace_.check.bounds);
    workspace_ = std::move(fresh);
    bound();
  }

  /// Applies `RunOptions::limits` to the steps from this state on.
  void bound() { workspace_.check.bounds.begin(*system_, options_.limits, step_end()); }
  StepResult step_end() { return {stepped().q, stepped().v, stepped().lambda, stepped().t, driver_.step_length()}; }
  /// Evaluates the energy balance up to the present state, before a restart or an action and at the end of the run.
  /// \param halved number of halved steps that are not in the report yet
  [[gnu::cold]] void settle(int halved) {
    Unexplained const found = workspace_.check.bounds.settle(*system_, step_end());
    if (done()) report_.warn_of_energy(found, options_.limits.warning, {start_, stepped().t, report_.halved + halved});
  }
  State& stepped() { return eliminates() ? reduced_ : *x_; }
  State const& stepped() const { return eliminates() ? reduced_ : *x_; }
  /// Stores the user's state in `seen_`, computed from the reduced state. \throws NonFiniteValue if a force is not
  /// finite in the computation of reactions. \param seen true if the evaluation of events has already computed `seen_`
  void make_full_state(bool seen) {
    if (!seen) expand(*system_, reduced_, seen_, scratch_);
    require_finite_reactions(*system_, seen_);
  }
  void show() {  // updates the user's state from the reduced state
    if (eliminates()) make_full_state(false), *x_ = seen_;
  }

  /// Reduced initial state: projects the velocities, and makes the checks that require the full model.
  [[gnu::cold]] void reduced_start();
  /// Warns of section matrices that are not in SI units, of a singular initial configuration, and of a step that is too
  /// long for compliant joints.
  [[gnu::cold]] void warn(ForwardDynamics<Solver>& forward, State const& x) {
    warn_of_units(full(), report_.warnings);
    report_.add_warning(warn_of_ambiguous_branch(full(), forward, x));
    if constexpr (HasStabilityLimit<I>) report_.add_warning(warn_of_step<I>(full(), forward, x, driver_.step_length()));
  }

  /// Projects the velocities onto the constraint equations, then computes consistent accelerations, after a start,
  /// breakpoint or event. The start of the integrator may evaluate states up to the end of the next step, but none
  /// beyond a breakpoint.
  [[gnu::cold]] void restart(bool first = false);

  // operations of `RunDriver`
  bool keeps() const { return keeps_; }
  System& stepped_system() { return *system_; }
  State const& full_state(State const& x) {
    if (!eliminates()) return x;
    expand(*system_, x, seen_, scratch_);
    return seen_;
  }
  StepReport step(State& x, double h, int halvings = -1) {
    workspace_.check.bounds.halvings = HasStabilityLimit<I> || !options_.allowed_halvings() ? -1 : halvings;
    return method_.step(*system_, x, h, workspace_);
  }
  void start(State& x, double h) {
    workspace_.forward.project_velocities(*system_, x.q, x.v, x.t);
    method_.start(*system_, x, h, workspace_);
  }
  StepReport take(State& x, double h) {
    auto const halve = [&] { return driver_.halving_step(x, h, options_.allowed_halvings(), *this); };
    StepReport report = redundancy_.step(*system_, workspace_.forward, x, driver_.before(), halve, [&] { restart(); });
    report.add(workspace_.check.failed);
    return report;
  }
  void on_step(RunStep const& s) {
    if (system_->rows() > 0)
      branches_.look(*system_, workspace_.forward, s.report, driver_.before().v, stepped(), report_.warnings);
  }
  void on_end(RunStep const& s) {
    if (s.met) settle(s.report.halved);
    if (s.acts)
      stepped() = after_action<Solver>(driver_.events(), options_.events, full_state(stepped()),
                                       {system_.get(), full_.get()}, options_.assembly_tolerance);
  }
  bool requires_restart() { return redundancy_.changes(*system_, workspace_.forward, stepped()); }
  void on_next(RunStep const& s) {
    if (!s.met && (done() || s.restarts)) settle(s.report.halved);
    if (s.restarts) restart();
  }
  /// Updates minimum-norm multipliers, axial forces and the user's state, and reports progress.
  void on_done(RunStep const& s);
  [[gnu::cold]] void on_failure() {
    if (undo_.has_user) *x_ = undo_.user;
    undo_.put_back(report_, axial_forces_);
  }
  [[gnu::cold]] void tell_progress(StepReport const& report);  // counts the step, then reports progress

  std::unique_ptr<System> system_, full_;  // workspaces contain references to them
  State* x_;
  Probe probe_;  // a separate system, so that evaluations of states do not change the run
  ObservedState now_;
  State reduced_, seen_;  // reduced and full state, if policies eliminate unknowns
  MethodOf<I> method_;
  RunOptions options_;
  RunDriver driver_;
  decltype(std::declval<MethodOf<I> const&>().template workspace<Solver>(std::declval<System&>())) workspace_;
  MinimumNormOf<> norm_;
  AxialForceMonitor axial_forces_;
  VecX scratch_;
  BranchWatch branches_;
  StepUndo undo_;
  RedundancyWatch<> redundancy_;
  bool keeps_ = false;    // every step stores its initial state
  bool updates_ = false;  // the present step updates the user's state
  double start_;          // initial time [s]
  RunReport report_;
};

template <Integrator I, class Solver>
Simulation<I, Solver>::Simulation(RunSystems systems, State& x, I const& integrator, RunOptions options)
    : Simulation(Prepared{}, std::move(systems), x, integrator, std::move(options), x.t) {
  require_fitting(full(), x);
  require_places(full(), x);
  require_computable(full(), x);
  driver_.plan_run(x.t, system_->layout().breakpoints);
  require_assembled(full(), x, options_.assembly_tolerance);
  if (eliminates()) reduced_start();
  stepped().t = driver_.pass(stepped().t);
  restart(true);
  driver_.start_events(stepped(), *this);
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
  driver_.plan_run(x.t, system_->layout().breakpoints);
  driver_.resume(from);
  report_ = from.report;
  branches_.begin(*system_, workspace_.forward, stepped());
  renew();
  undo_.end(stepped());
}

template <Integrator I, class Solver>
Simulation<I, Solver>::~Simulation() = default;

template <Integrator I, class Solver>
RunSnapshot Simulation<I, Solver>::snapshot() {
  system_->layout().watch.require_unchanged();
  renew();
  RunSnapshot now;
  now.model = identity_of(*system_);
  now.integrator = I::name;
  now.state = stepped();
  now.report = report_;
  driver_.store(now);
  return now;
}

template <Integrator I, class Solver>
void Simulation<I, Solver>::advance(bool updates) {
  system_->layout().watch.require_unchanged();
  double const from = stepped().t, h = driver_.plan_step(stepped()).plan.h;
  if (!(from + h > from) || !undo_.fits(stepped())) undo_.refuse_step(stepped(), options_.end_time, h);
  undo_.begin(report_);
  StepTrial trial(workspace_);
  updates_ = updates;
  try {
    driver_.take_step(stepped(), *this);
  } catch (Error& failure) {
    if (std::string const warned = report_.warned(); !warned.empty()) failure.append(warned);
    throw;
  }
  trial.keep();
  undo_.end(stepped());
}

template <Integrator I, class Solver>
void Simulation<I, Solver>::on_done(RunStep const& s) {
  if (!eliminates() && options_.minimum_norm) norm_.apply(*system_, workspace_.forward, *x_);
  if (updates_) {
    if (eliminates()) make_full_state(!options_.events.empty() && !s.restarts);
    if (State const& x = eliminates() ? seen_ : *x_; axial_forces_.is_due(x.t, done())) {
      if (options_.progress) undo_.keep_axial(axial_forces_, report_);
      axial_forces_.look(full(), x, report_.warnings);
    }
  }
  if (options_.progress) return tell_progress(s.report);
  report_.add(s.report);
  if (updates_ && eliminates()) *x_ = seen_;
}

template <Integrator I, class Solver>
void Simulation<I, Solver>::tell_progress(StepReport const& report) {
  undo_.keep_counts(report_);
  report_.add(report);
  if (updates_ && eliminates()) {
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
    throw InvalidInput("run.minimum_norm",
                       {ErrorObject{"simulate"},
                        ": the option minimum_norm requires a model in which no constraint "
                        "equation is eliminated. For single states, call minimum_norm_multipliers."});
  State start = *x_;
  ForwardDynamics<Solver> forward(full());
  forward.project_velocities(full(), start.q, start.v, start.t);
  require_consistent_redundancy(full(), forward, start);
  warn(forward, start);
  reduced_ = reduce(*system_, start);
}

template <Integrator I, class Solver>
void Simulation<I, Solver>::restart(bool first) {
  State fresh = stepped();  // the integrated state is unchanged if the start fails
  workspace_.forward.project_velocities(*system_, fresh.q, fresh.v, fresh.t);
  redundancy_.start(*system_, workspace_.forward, fresh);
  method_.start(*system_, fresh, driver_.next(fresh).h, workspace_);
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
