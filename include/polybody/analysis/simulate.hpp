#pragma once
/// \file
/// The run: a range of states, from step to step, that ends steps at corners, events and stop conditions.

#include <algorithm>
#include <functional>
#include <limits>
#include <memory>
#include <optional>

#include <polybody/analysis/minimum_norm.hpp>
#include <polybody/analysis/stable_step.hpp>

namespace polybody {

/// Something that happens when `value` passes through zero (in either direction). The step ends there.
struct Event {
  std::string name;
  std::function<double(State const&)> value;
  bool stops = false;        ///< ends the run
  double tolerance = 1e-10;  ///< in time [s]
};

struct RunOptions {
  Required<double> until;             ///< [s]
  Required<double> step;              ///< [s]; the first one for an integrator that controls its step
  std::optional<double> largest_step = {};  ///< [s], for an integrator that controls its step
  std::vector<double> corners = {};   ///< times at which a step must end, beside those of the drives and loads
  std::vector<Event> events = {};
  double assembly_tolerance = 1e-8;   ///< of the start
  bool minimum_norm = false;          ///< every state gets the multipliers of `MinimumNorm`, for a factorisation each
  int threads = 1;                    ///< that share the loops of an evaluation; for large models, results stay the same bits
};

/// What a run has cost so far, and which events it met.
struct RunReport {
  long steps = 0;
  long iterations = 0;
  long factorisations = 0;
  long evaluations = 0;
  long rejected = 0;
  StepReport last = {};
  struct Met {
    std::string name;
    double time;
  };
  std::vector<Met> events = {};
  bool stopped = false;  ///< by an event before `until`
  /// Joints with rows that repeat those of others at the last start: the motion is right, but how the reactions share the
  /// load is not determined.
  std::vector<std::string> redundant = {};
  std::vector<std::string> warnings = {};  ///< of the start, in sentences: a step beyond the limit of an explicit integrator
};

/// An input range of states: `for (State const& now : simulate(…))` yields the start and every step's end.
/// The state given by the caller is moved along. Not copyable; begin() once.
template <class M, class I, class Solver = DefaultSolver>
class Simulation {
  using Stepped = SteppedModel<M>;
  static_assert(I::accepts_rows || !M::may_have_rows,
                "This explicit integrator has no stabilisation, but joints with the Constraint policy add rows. Use "
                "it with Projection, such as RungeKutta4<Projection>, or use an implicit integrator.");

 public:
  Simulation(M const& model, State& x, I integrator, RunOptions options)
      : system_(std::make_unique<System<Stepped>>(model)), x_(&x), integrator_(std::move(integrator)),
        options_(std::move(options)), workspace_(integrator_.template workspace<Solver>(*system_)), norm_(whole()) {
    integrator_.check();
    check_options();
    if (options_.threads != 1) system_->use_threads(options_.threads);
    require_fitting(model, x);
    collect_corners();
    require_assembled(whole(), x, options_.assembly_tolerance);
    h_ = std::min<double>(options_.step, largest_step());
    if constexpr (M::eliminates) narrow_start();
    pass_corners();
    for (Event const& event : options_.events) sides_.push_back(side(event, stepped()));
    restart(true);
    if constexpr (!M::eliminates) {
      if (options_.minimum_norm) norm_.apply(*system_, workspace_.forward, x);
      warn(workspace_.forward, x);
    }
    show();
  }

  State const& state() const { return *x_; }
  RunReport const& report() const { return report_; }
  /// What is stepped: the model, or what its policies leave of it.
  System<Stepped>& system() { return *system_; }
  bool done() const { return report_.stopped || x_->t >= options_.until; }

  /// Takes one step: to the next grid point, or to a corner or event before it. When it throws, the state is as
  /// it was before.
  void advance() {
    auto const [target, h, lands, jumps] = plan();
    bool const crumb = h < 0.01 * h_;  // one is left all the same: after a corner or an event
    State before;
    if (jumps || crumb || options_.minimum_norm || !options_.events.empty()) before = stepped();
    StepReport const report = integrator_.step(*system_, stepped(), h, workspace_);
    bool const reached = lands && report.taken == h;
    if (reached) stepped().t = target;
    account(report, reached);
    try {
      bool const met = !options_.events.empty() && meet_events(before, report.taken);
      bool const at_corner = jumps && stepped().t == target;
      if (at_corner) pass_corners();
      if (met || at_corner || crumb) restart();
      if constexpr (!M::eliminates)
        if (options_.minimum_norm) norm_.apply(*system_, workspace_.forward, *x_);
      show();
    } catch (...) {
      stepped() = before;
      show();
      throw;
    }
  }

  struct Sentinel {};
  class Iterator {
   public:
    using value_type = State;
    using difference_type = std::ptrdiff_t;
    explicit Iterator(Simulation* run) : run_(run) {}
    State const& operator*() const { return run_->state(); }
    Iterator& operator++() {
      if (run_->done())
        finished_ = true;
      else
        run_->advance();
      return *this;
    }
    void operator++(int) { ++*this; }
    bool operator==(Sentinel) const { return finished_; }

   private:
    Simulation* run_;
    bool finished_ = false;
  };
  Iterator begin() { return Iterator(this); }
  Sentinel end() const { return {}; }

  /// Runs to the end. Returns the report.
  RunReport const& run() {
    while (!done()) advance();
    return report_;
  }

 private:
  /// The state that is stepped: the user's, or the narrow one of which `show` makes the user's.
  State& stepped() {
    if constexpr (M::eliminates)
      return narrow_;
    else
      return *x_;
  }
  State const& stepped() const { return const_cast<Simulation*>(this)->stepped(); }
  void show() {
    if constexpr (M::eliminates) system_->widen(narrow_, *x_);
  }
  System<M>& whole() {
    if constexpr (M::eliminates)
      return system_->whole();
    else
      return *system_;
  }

  /// The narrow start, with the questions that only the whole model answers: joint speeds are read off speeds that keep to the joints.
  void narrow_start() {
    if (options_.minimum_norm)
      throw InvalidInput("simulate: minimum_norm is for models whose joints all keep their rows. Ask minimum_norm_multipliers for single "
                         "states.");
    State start = *x_;
    ForwardDynamics<M, Solver> forward(whole());
    forward.project_velocities(whole(), start.q, start.v, start.t);
    require_consistent_rows(whole(), forward, start);
    warn(forward, start);
    narrow_ = system_->narrow(start);
  }
  /// Of a step that is too long for compliant joints.
  void warn(ForwardDynamics<M, Solver>& forward, State const& x) {
    if constexpr (NamesStableStep<I>) {
      std::string const warning = warn_of_step<I>(whole(), forward, x, h_);
      if (!warning.empty()) report_.warnings.push_back(warning);
    }
  }

  double largest_step() const { return options_.largest_step.value_or(std::numeric_limits<double>::infinity()); }

  void check_options() const {
    require_positive(options_.step, "simulate: the step");
    if (options_.largest_step) require_positive(*options_.largest_step, "simulate: the largest step");
    if (!(options_.until >= x_->t) || !std::isfinite(options_.until))
      throw InvalidInput("simulate: the end " + number(options_.until) + " s lies before the start " +
                         number(x_->t) + " s.");
    for (Event const& event : options_.events) {
      if (!event.value) throw InvalidInput("simulate: the event \"" + event.name + "\" has no value.");
      require_positive(event.tolerance, "simulate: the tolerance of the event \"" + event.name + "\"");
    }
  }

  void collect_corners() {
    corners_ = options_.corners;
    auto const take = [&](auto const& law) {
      if constexpr (HasCorners<std::decay_t<decltype(law)>>)
        for (double t : law.corners()) corners_.push_back(t);
    };
    system_->model().for_each_joint([&](auto const& e) { take(e.joint.geometry); });
    system_->model().for_each_force([&](auto const& e) {
      if constexpr (requires { e.force.law; }) take(e.force.law);
    });
    std::erase_if(corners_, [&](double t) { return !(t > x_->t) || !(t <= options_.until); });
    std::sort(corners_.begin(), corners_.end());
  }

  /// Leaves behind the corners up to now and those that only rounding sets apart from it (0.3 and 0.1 + 0.2 are
  /// one); the clock goes with them.
  void pass_corners() {
    double const crumb = 1e-9 * options_.step + 4.0 * std::numeric_limits<double>::epsilon() * std::abs(stepped().t);
    while (next_corner_ < corners_.size() && corners_[next_corner_] <= stepped().t + crumb)
      stepped().t = std::max(stepped().t, corners_[next_corner_++]);
    if (options_.until - stepped().t <= crumb) stepped().t = options_.until;
  }

  /// The next step: where it may at most go, its length, whether it goes there, and whether a corner is there.
  struct Plan {
    double target, h;
    bool lands, jumps;
  };
  Plan plan() const {
    bool const corner = next_corner_ < corners_.size();
    double const target = corner ? corners_[next_corner_] : double(options_.until), left = target - stepped().t;
    // rather a longer step than a crumb left over: over its square, rows would be rounding errors
    bool const lands = 1.01 * h_ >= left;
    return {target, !lands ? h_ : corner ? until_just_before(target) : left, lands, lands && corner};
  }

  /// A law that changes at a corner still holds its old value just before it: the length of a step that ends there.
  double until_just_before(double corner) const {
    double h = std::nextafter(corner, stepped().t) - stepped().t;
    while (stepped().t + h >= corner) h = std::nextafter(h, 0.0);
    return h;
  }

  /// After a start, corner or event: speeds onto the rows, then consistent accelerations. The integrator may look
  /// ahead as far as the next step goes, not across a corner.
  void restart(bool first = false) {
    State fresh = stepped();  // which stays as it is when the start fails
    workspace_.forward.project_velocities(*system_, fresh.q, fresh.v, fresh.t);
    integrator_.start(*system_, fresh, done() ? h_ : plan().h, workspace_);
    if constexpr (!M::eliminates)
      if (first) require_consistent_rows(*system_, workspace_.forward, fresh);
    stepped() = std::move(fresh);
    report_.redundant = workspace_.forward.redundant(*system_);
    if constexpr (M::eliminates) system_->add_redundant(report_.redundant);
  }

  void account(StepReport const& r, bool shortened) {
    ++report_.steps;
    report_.iterations += r.iterations;
    report_.factorisations += r.factorisations;
    report_.evaluations += r.evaluations;
    report_.rejected += r.rejected;
    report_.last = r;
    if constexpr (requires { I::controls_step; })
      h_ = std::min(shortened ? std::max(r.next, h_) : r.next, largest_step());
  }

  /// The user's state of a stepped one.
  State const& seen(State const& x) {
    if constexpr (M::eliminates) {
      seen_ = *x_;
      system_->widen(x, seen_);
      return seen_;
    } else {
      return x;
    }
  }

  /// The sign of the event's value. \throws NonFinite.
  int side(Event const& event, State const& x) {
    double const y = event.value(seen(x));
    if (!std::isfinite(y))
      throw NonFinite("The event \"" + event.name + "\" is not finite at t = " + number(x.t) + " s.");
    return (y > 0.0) - (y < 0.0);
  }

  /// Ends the step at the first event within it, by bisection on the step's length from `before`.
  bool meet_events(State const& before, double taken) {
    auto const after = [&](double h) {
      State trial = before;
      while (trial.t < before.t + h) {
        double const left = before.t + h - trial.t;
        if (integrator_.step(*system_, trial, left, workspace_).taken == left) break;
      }
      return trial;
    };
    auto const passed = [&](std::size_t i, State const& x) {
      return sides_[i] != 0 && side(options_.events[i], x) != sides_[i];
    };
    State first = stepped();
    bool met = false;
    for (std::size_t i = 0; i < sides_.size(); ++i) {
      if (!passed(i, stepped())) continue;
      met = true;
      double lo = 0.0, hi = taken;
      while (hi - lo > options_.events[i].tolerance) {
        double const mid = 0.5 * (lo + hi);
        if (mid <= lo || mid >= hi) break;
        State trial = after(mid);
        if (!passed(i, trial)) {
          lo = mid;
          continue;
        }
        hi = mid;
        if (trial.t < first.t) first = std::move(trial);
      }
    }
    if (met) stepped() = std::move(first);
    for (std::size_t i = 0; i < sides_.size(); ++i) {
      Event const& event = options_.events[i];
      if (met && passed(i, stepped())) {
        report_.events.push_back({event.name, stepped().t});
        report_.stopped = report_.stopped || event.stops;
      }
      sides_[i] = side(event, stepped());
    }
    return met;
  }

  std::unique_ptr<System<Stepped>> system_;  // workspaces refer to it
  State* x_;
  State narrow_, seen_;  // of models with eliminating policies
  I integrator_;
  RunOptions options_;
  decltype(std::declval<I const&>().template workspace<Solver>(std::declval<System<Stepped>&>())) workspace_;
  MinimumNorm<M> norm_;
  std::vector<double> corners_;
  std::size_t next_corner_ = 0;
  std::vector<int> sides_;  // of the events at the end of the last step: each is met once, however a restart rounds
  double h_ = 0.0;
  RunReport report_;
};

/// Runs `model` from x: a range of states. x is moved along and holds the last state afterwards.
/// \throws InconsistentStart, InvalidInput at once; NewtonStalled, NonFinite, … from the step that fails.
template <LinearSolver Solver = DefaultSolver, class M, class I>
Simulation<M, I, Solver> simulate(M const& model, State& x, I integrator, RunOptions options) {
  return Simulation<M, I, Solver>(model, x, std::move(integrator), std::move(options));
}

}  // namespace polybody
