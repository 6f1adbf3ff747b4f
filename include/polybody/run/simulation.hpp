#pragma once
/// \file
/// A run: a range of states that ends steps at corners, events and stop conditions. What its functions do stands
/// outside the class so that a program that links `polybody::compiled` does not compile it again.

#include <polybody/math/sequence.hpp>
#include <polybody/run/axial_watch.hpp>
#include <polybody/run/event_action.hpp>
#include <polybody/run/minimum_norm.hpp>
#include <polybody/run/run_snapshot.hpp>
#include <polybody/run/run_systems.hpp>
#include <polybody/run/stable_step.hpp>
#include <polybody/run/step_plan.hpp>

namespace polybody {

/// An input range of states: `for (State const& now : simulate(…))` yields the start and every step's end. The state
/// given by the caller is moved along. begin() once.
template <Integrator I, class Solver = DefaultSolver>
class Simulation {
 public:
  [[gnu::cold]] Simulation(RunSystems systems, State& x, I const& integrator, RunOptions options);  ///< by integrator

  /// Goes on from a snapshot. \throws InvalidInput for one of another model, integrator or count of events.
  [[gnu::cold]] Simulation(RunSystems systems, State& x, I const& integrator, RunOptions options,
                           RunSnapshot const& from);
  ~Simulation();
  Simulation(Simulation const&) = delete;
  Simulation& operator=(Simulation const&) = delete;

  /// What `resume` needs to go on from here. This run drops what else it keeps from step to step, such as
  /// factorisations, so that it and a resumed run go on with the same bits; a run that is not interrupted has them when
  /// it takes snapshots at the same times.
  [[gnu::cold]] RunSnapshot snapshot();

  State const& state() const { return *x_; }            ///< as the last step left it
  RunReport const& report() const& { return report_; }  ///< so far
  RunReport report() && { return std::move(report_); }  ///< the report so far, moved out
  /// What is stepped: the model, or what its policies leave of it.
  System& system() { return *system_; }
  System& whole() { return whole_ ? *whole_ : *system_; }                         ///< the whole mechanism
  bool done() const { return report_.stopped || stepped().t >= options_.until; }  ///< the end, or a stop by an event

  /// Takes a step to the next grid point, or to a corner or event before it. When it throws, the state stays as it was.
  /// \throws InvalidInput where the model has changed since the run was made.
  void advance() { advance(true); }

  struct Sentinel {};
  /// Runs through the states of a simulation, one a step: `for (State const& now : simulate(…))`.
  class Iterator {
   public:
    using value_type = State;                                 ///< for std::input_iterator
    using difference_type = std::ptrdiff_t;                   ///< for std::input_iterator
    explicit Iterator(Simulation* run) : run_(run) {}         ///< of this run
    State const& operator*() const { return run_->state(); }  ///< as the last step left it
    /** Takes a step, or ends where the run is done. */ Iterator& operator++() {
      if (run_->done())
        finished_ = true;
      else
        run_->advance();
      return *this;
    }
    void operator++(int) { ++*this; }                      ///< a step further
    bool operator==(Sentinel) const { return finished_; }  ///< the run is done

   private:
    Simulation* run_;
    bool finished_ = false;
  };
  Iterator begin() { return Iterator(this); }  ///< takes steps as it goes on
  Sentinel end() const { return {}; }          ///< where the run is done

  /// To the end. Returns the report, as a copy of its own from a simulation that ends with the statement.
  RunReport const& run() &;
  RunReport run() && { return run(), std::move(report_); }  ///< to the end

 private:
  struct Prepared {};
  [[gnu::cold]] Simulation(Prepared, RunSystems systems, State& x, I const& integrator, RunOptions options,
                           double start)
      : system_(std::move(systems.stepped)),
        whole_(std::move(systems.whole)),
        x_(&x),
        method_(method_of(integrator)),
        options_(std::move(options)),
        workspace_(method_.template workspace<Solver>(*system_)),
        norm_(whole()),
        axial_forces_(whole(), start, options_.until),
        speeds_before_(VecX::Zero(system_->speeds())),
        start_(start) {
    options_.check(start);
    if (options_.threads != 1) system_->use_threads(options_.threads);
    h_ = std::min<double>(options_.step, largest_step());
  }
  /// A narrow state is stepped, of which `show` makes the user's; else that itself.
  bool eliminates() const { return bool(whole_); }
  void advance(bool shown);  ///< shown: the user's state follows

  /// A workspace that knows no earlier step, and is ready for the next one.
  [[gnu::cold]] void renew() {
    StepBounds bounds = std::move(workspace_.forward.bounds);
    workspace_ = method_.template workspace<Solver>(*system_);
    workspace_.forward.bounds = std::move(bounds);
    State ready = stepped();  // whose memory `start` clears
    method_.start(*system_, ready, done() ? h_ : plan_.next(ready.t, h_).h, workspace_);
  }

  /// The limits of steps hold from this state on.
  void bound() { workspace_.forward.bounds.begin(*system_, options_.limits, step_end()); }
  StepEnd step_end() { return {stepped().q, stepped().v, stepped().lambda, stepped().t, h_}; }
  /// Makes the balance of the energy up to here: before a restart or an action, and at the end.
  [[gnu::cold]] void settle() {
    Unexplained const found = workspace_.forward.bounds.settle(*system_, step_end());
    if (done()) report_.warn_of_energy(found, options_.limits.warning, {start_, stepped().t, halved_});
  }
  State& stepped() { return eliminates() ? narrow_ : *x_; }
  State const& stepped() const { return eliminates() ? narrow_ : *x_; }
  /// The user's state follows the narrow one, but where a force fails as reactions are worked out. \param seen events
  /// have been shown this one
  void show(bool seen = false) {
    if (!eliminates()) return;
    if (!seen) expand(*system_, narrow_, seen_, scratch_);
    if (Index const i = first_not_finite(seen_.lambda); i >= 0)
      throw NonFinite{"The reaction of ",
                      system_->layout().name_of(system_->layout().speeds + i),
                      how_not_finite(seen_.lambda[i]),
                      " at t = ",
                      seen_.t,
                      " s. Look at the forces on the bodies that it carries."};
    *x_ = seen_;
  }

  /// The narrow start, of speeds that keep to the joints, with the questions that only the whole model answers.
  [[gnu::cold]] void narrow_start();
  /// Adds warnings to the report: of a start between branches, and where the step is too long for compliant joints.
  [[gnu::cold]] void warn(ForwardDynamics<Solver>& forward, State const& x) {
    report_.add_warning(warn_of_start_between_branches(whole(), forward, x));
    if constexpr (NamesStableStep<I>) report_.add_warning(warn_of_step<I>(whole(), forward, x, h_));
  }

  /// The rows of x repeat each other far more nearly than those of the start.
  [[gnu::cold]] bool is_singular(State const& x) {
    try {
      return workspace_.forward.row_gain(*system_, x.q, x.v, x.t).far_above(usual_gain_);
    } catch (LinearSolverSingular const&) {  // of a solver that drops no rows
      return true;
    }
  }
  /// Tells the first step, of those in which the speeds turned by more than a tenth and a matrix was factored anew,
  /// that ends next to a singular position: there the motion may have gone over to another branch.
  void warn_of_branch(StepReport const& taken) {
    if (taken.factorisations == 0 || system_->rows() == 0) return;
    State const& x = stepped();
    PackSum change;
    for_packs(x.v.size(), [&](auto at) {
      auto const by = at(x.v) - at(speeds_before_);
      change.add(by * by);
    });
    if (!(change.total() > 0.01 * squares(speeds_before_))) return;
    char const* const what = "The joints' rows lose rank next to t = ";
    if (report_.warns(what) || !is_singular(x)) return;
    report_.warnings.push_back(what + number(x.t) +
                               " s, and the speeds jump in the step that ends there: at this singular position the "
                               "motion can go over to another branch, and on which one it goes on is up to the step "
                               "and the integrator. Compare the run with one of another step.");
  }

  /// One step of h, or where it stalls two of h/2 from a fresh start, and so on. When it throws, the state is as it
  /// was.
  StepReport step(double h, int halvings);

  double largest_step() const { return options_.largest_step.value_or(std::numeric_limits<double>::infinity()); }

  /// Times at which the user, a drive or a load wants a step to end.
  Sequence<double> corners() const {
    Sequence<double> all = system_->layout().corners;
    all.append(options_.corners.begin(), options_.corners.end());
    return all;
  }

  /// After a start, corner or event: speeds onto the rows, then consistent accelerations. The integrator may look
  /// ahead as far as the next step goes, not across a corner.
  [[gnu::cold]] void restart(bool first = false);

  void choose_step(StepReport const& r, bool shortened) {
    if constexpr (requires { I::controls_step; })
      h_ = std::min(shortened ? std::max(r.next, h_) : r.next, largest_step());
  }

  /// The state that events are shown.
  EventWatch::Seen seen() {
    return [this](State const& x) -> State const& {
      if (!eliminates()) return x;
      expand(*system_, x, seen_, scratch_);
      return seen_;
    };
  }
  bool meet_events(double taken) {
    EventWatch::Step const again = [this](State& x, double h) {
      return method_.step(*system_, x, h, workspace_).taken;
    };
    bool const met = watch_.meet(options_.events, {before_, taken, seen(), again}, stepped(), report_);
    if (met) settle();
    if (met && watch_.acts(options_.events))
      stepped() = after_action<Solver>(watch_, options_.events, seen()(stepped()), {system_.get(), whole_.get()});
    return met;
  }

  std::unique_ptr<System> system_, whole_;  // workspaces refer to it
  State* x_;
  State narrow_, seen_, before_;  // two of models with eliminating policies; of a step after which something may fail
  MethodOf<I> method_;
  RunOptions options_;
  decltype(std::declval<MethodOf<I> const&>().template workspace<Solver>(std::declval<System&>())) workspace_;
  MinimumNormOf<> norm_;
  AxialWatch axial_forces_;
  long halved_ = 0;               // steps
  VecX speeds_before_, scratch_;  // the first of a step
  RowGain usual_gain_;            // at the start
  StepPlan plan_;
  StepRow row_;
  EventWatch watch_;
  double h_ = 0.0, start_;  // [s]
  RunReport report_;
};

template <Integrator I, class Solver>
Simulation<I, Solver>::Simulation(RunSystems systems, State& x, I const& integrator, RunOptions options)
    : Simulation(Prepared{}, std::move(systems), x, integrator, std::move(options), x.t) {
  require_fitting(whole(), x);
  require_places(whole(), x);
  require_computable(whole(), x);
  plan_ = StepPlan(x.t, options_.until, options_.step, corners());
  require_assembled(whole(), x, options_.assembly_tolerance);
  if (eliminates()) narrow_start();
  stepped().t = plan_.pass(stepped().t);
  if (!options_.events.empty()) watch_.start(options_.events, stepped(), seen());
  restart(true);
  if (!eliminates()) {
    if (options_.minimum_norm) norm_.apply(*system_, workspace_.forward, x);
    warn(workspace_.forward, x);
  }
  show();
}

template <Integrator I, class Solver>
Simulation<I, Solver>::Simulation(RunSystems systems, State& x, I const& integrator, RunOptions options,
                                  RunSnapshot const& from)
    : Simulation(Prepared{}, std::move(systems), x, integrator, std::move(options), from.state.t) {
  from.require(identity_of(*system_), I::name, options_.events.size());
  if (eliminates()) x = {};
  stepped() = from.state;
  show();
  plan_ = StepPlan(x.t, options_.until, options_.step, corners());
  if constexpr (requires { I::controls_step; }) h_ = std::min(from.step, largest_step());
  row_ = from.row;
  watch_ = EventWatch(from.sides);
  report_ = from.report;
  if (system_->rows() > 0) usual_gain_ = workspace_.forward.row_gain(*system_, stepped().q, stepped().v, stepped().t);
  renew();
  bound();
}

template <Integrator I, class Solver>
Simulation<I, Solver>::~Simulation() = default;

template <Integrator I, class Solver>
RunSnapshot Simulation<I, Solver>::snapshot() {
  system_->layout().watch.require_unchanged();
  renew();
  return {identity_of(*system_), I::name, stepped(), h_, row_, watch_.sides(), report_};
}

template <Integrator I, class Solver>
void Simulation<I, Solver>::advance(bool shown) {
  system_->layout().watch.require_unchanged();
  auto const [target, h, lands, jumps] = plan_.next(stepped().t, h_);
  bool const crumb = h < 0.01 * h_;  // a tiny step, left over after a corner or an event
  if (eliminates() || jumps || crumb || options_.minimum_norm || !options_.events.empty()) before_ = stepped();
  double const from = stepped().t, h_before = h_;
  StepRow const row_before = row_;
  auto trial = workspace_.forward.attempt();
  speeds_before_ = stepped().v;
  StepReport const report = step(h, options_.halvings);
  bool const reached = lands && report.taken == h;
  stepped().t = reached ? target : row_.after(from, report.taken);
  choose_step(report, reached);
  try {
    warn_of_branch(report);
    bool const met = !options_.events.empty() && meet_events(report.taken);
    bool const at_corner = jumps && stepped().t == target;
    if (at_corner) stepped().t = plan_.pass(stepped().t);
    bool const anew = met || at_corner || crumb;
    if (!met && (done() || anew)) settle();
    if (anew) restart();
    if (!eliminates() && options_.minimum_norm) norm_.apply(*system_, workspace_.forward, *x_);
    if (shown) {
      show(!options_.events.empty() && !anew);
      axial_forces_.look(whole(), *x_, done(), report_.warnings);
    }
  } catch (...) {
    stepped() = before_;
    row_ = row_before;
    h_ = h_before;
    throw;
  }
  trial.keep();
  report_.add(report);
  if (options_.progress) options_.progress({start_, options_.until, stepped().t, done()});
}

template <Integrator I, class Solver>
RunReport const& Simulation<I, Solver>::run() & {
  bool const asked = !eliminates() || axial_forces_.asks();  // else nobody looks before the end
  try {
    while (!done()) advance(asked);
  } catch (...) {
    try {
      if (!asked) show();
    } catch (...) {  // NOLINT(bugprone-empty-catch): what stopped the run is told
    }
    throw;
  }
  if (!asked) show();
  return report_;
}

template <Integrator I, class Solver>
void Simulation<I, Solver>::narrow_start() {
  if (options_.minimum_norm)
    throw InvalidInput(
        "simulate: minimum_norm is for models whose joints all keep their rows. Ask minimum_norm_multipliers for "
        "single states.");
  State start = *x_;
  ForwardDynamics<Solver> forward(whole());
  forward.project_velocities(whole(), start.q, start.v, start.t);
  require_consistent_rows(whole(), forward, start);
  warn(forward, start);
  narrow_ = reduce(*system_, start);
}

template <Integrator I, class Solver>
StepReport Simulation<I, Solver>::step(double h, int halvings) {
  try {
    return method_.step(*system_, stepped(), h, workspace_);
  } catch (NewtonStalled const&) {
    if (halvings == 0) throw;
  }
  State const before = stepped();
  try {
    workspace_.forward.project_velocities(*system_, stepped().q, stepped().v, stepped().t);
    method_.start(*system_, stepped(), 0.5 * h, workspace_);
    StepReport report = step(0.5 * h, halvings - 1);
    StepReport const second = step(h - report.taken, halvings - 1);
    report.append(second);
    ++halved_;
    return report;
  } catch (...) {
    stepped() = before;
    throw;
  }
}

template <Integrator I, class Solver>
void Simulation<I, Solver>::restart(bool first) {
  State fresh = stepped();  // which stays as it is when the start fails
  workspace_.forward.project_velocities(*system_, fresh.q, fresh.v, fresh.t);
  method_.start(*system_, fresh, done() ? h_ : plan_.next(fresh.t, h_).h, workspace_);
  if (first && !eliminates()) require_consistent_rows(*system_, workspace_.forward, fresh);
  stepped() = std::move(fresh);
  bound();
  if (first && system_->rows() > 0)
    usual_gain_ = workspace_.forward.row_gain(*system_, stepped().q, stepped().v, stepped().t);
  report_.redundant = workspace_.forward.redundant(*system_);
  if (eliminates())
    for (std::string const& name : system_->step_coordinates().narrow->redundant)
      if (report_.redundant.empty() || report_.redundant.back() != name) report_.redundant.push_back(name);
}

}  // namespace polybody
