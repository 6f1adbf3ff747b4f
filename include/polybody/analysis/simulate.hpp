#pragma once
/// \file
/// The run: a range of states, from step to step, that ends steps at corners, events and stop conditions.

#include <functional>
#include <memory>
#include <optional>

#include <polybody/analysis/initial_conditions.hpp>
#include <polybody/integrators/integrator.hpp>

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
};

/// An input range of states: `for (State const& now : simulate(…))` yields the start and every step's end.
/// The state given by the caller is moved along. Not copyable; begin() once.
template <class M, class I, class Solver = AutoLu>
class Simulation {
  static_assert(I::accepts_rows || !M::may_have_rows,
                "This explicit integrator has no stabilisation, but joints with the Constraint policy add rows. Use "
                "it with Projection, such as RungeKutta4<Projection>, or use an implicit integrator.");

 public:
  Simulation(M const& model, State& x, I integrator, RunOptions options)
      : system_(std::make_unique<System<M>>(model)), x_(&x), integrator_(std::move(integrator)),
        options_(std::move(options)), workspace_(integrator_.template workspace<Solver>(*system_)) {
    integrator_.check();
    require_positive(options_.step, "simulate: the step");
    if (!(options_.until >= x.t) || !std::isfinite(options_.until))
      throw InvalidInput("simulate: the end " + std::to_string(options_.until) + " s lies before the start " +
                         std::to_string(x.t) + " s.");
    require_sizes(x);
    collect_corners();
    require_assembled(*system_, x, options_.assembly_tolerance);
    h_ = options_.step;
    restart();
  }

  State const& state() const { return *x_; }
  RunReport const& report() const { return report_; }
  System<M>& system() { return *system_; }
  bool done() const { return report_.stopped || x_->t >= options_.until; }

  /// Takes one step: to the next grid point, or to a corner or event before it.
  void advance() {
    double target = options_.until;
    bool const corner = next_corner_ < corners_.size() && corners_[next_corner_] <= target;
    if (corner) target = corners_[next_corner_];
    double h = h_;
    double const left = target - x_->t;
    bool const lands = h >= left * (1.0 - 1e-9);
    // A law that changes at a corner still holds its old value just before it: end the step there.
    if (lands) h = corner ? std::nextafter(target, x_->t) - x_->t : left;
    State before;
    if (!options_.events.empty()) before = *x_;
    StepReport const report = integrator_.step(*system_, *x_, h, workspace_);
    bool const reached = lands && report.taken == h;
    if (reached) x_->t = target;
    account(report);
    if (!options_.events.empty() && meet_event(before, report)) return;
    if (reached && corner) {
      while (next_corner_ < corners_.size() && corners_[next_corner_] <= target) ++next_corner_;
      restart();
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
  void require_sizes(State const& x) const {
    M const& m = system_->model();
    if (x.q.size() != m.coordinates() || x.v.size() != m.speeds() || x.lambda.size() != m.rows() ||
        x.a.size() != m.speeds())
      throw InvalidInput("simulate: the state does not fit the model; take it from reference_state() after the "
                         "last body and joint were added.");
    require_finite(x.q, "simulate: the coordinates at the start");
    require_finite(x.v, "simulate: the speeds at the start");
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
    std::erase_if(corners_, [&](double t) { return !(t > x_->t) || !std::isfinite(t); });
    std::sort(corners_.begin(), corners_.end());
    corners_.erase(std::unique(corners_.begin(), corners_.end()), corners_.end());
  }

  /// After a start, corner or event: speeds onto the rows, then consistent accelerations.
  void restart() {
    ForwardDynamics<M, Solver>& forward = workspace_.forward;
    forward.project_velocities(*system_, x_->q, x_->v, x_->t);
    integrator_.start(*system_, *x_, h_, workspace_);
  }

  void account(StepReport const& r) {
    ++report_.steps;
    report_.iterations += r.iterations;
    report_.factorisations += r.factorisations;
    report_.evaluations += r.evaluations;
    report_.rejected += r.rejected;
    report_.last = r;
    if constexpr (requires { I::controls_step; })
      h_ = std::min(r.next, options_.largest_step.value_or(std::numeric_limits<double>::infinity()));
  }

  /// Ends the step at the first event within it, by bisection on the step's length from `before`.
  bool meet_event(State const& before, StepReport const& taken) {
    Event const* first = nullptr;
    double first_h = taken.taken;
    for (Event const& event : options_.events) {
      double const at_start = event.value(before);
      auto const passed = [&](State const& s) {
        double const value = event.value(s);
        return value == 0.0 || (value > 0.0) != (at_start > 0.0);
      };
      if (at_start == 0.0 || !passed(*x_)) continue;
      double lo = 0.0, hi = taken.taken;
      State trial;
      while (hi - lo > event.tolerance) {
        double const mid = 0.5 * (lo + hi);
        trial = before;
        integrator_.step(*system_, trial, mid, workspace_);
        (passed(trial) ? hi : lo) = mid;
      }
      if (hi <= first_h) {
        first_h = hi;
        first = &event;
      }
    }
    if (first == nullptr) return false;
    if (first_h < taken.taken) {
      *x_ = before;
      integrator_.step(*system_, *x_, first_h, workspace_);
    }
    report_.events.push_back({first->name, x_->t});
    report_.stopped = first->stops;
    if (!report_.stopped) restart();
    return true;
  }

  std::unique_ptr<System<M>> system_;  // workspaces refer to it
  State* x_;
  I integrator_;
  RunOptions options_;
  decltype(std::declval<I const&>().template workspace<Solver>(std::declval<System<M>&>())) workspace_;
  std::vector<double> corners_;
  std::size_t next_corner_ = 0;
  double h_ = 0.0;
  RunReport report_;
};

/// Runs `model` from x: a range of states. x is moved along and holds the last state afterwards.
/// \throws InconsistentStart, InvalidInput at once; NewtonStalled, NonFinite, … from the step that fails.
template <LinearSolver Solver = AutoLu, class M, class I>
Simulation<M, I, Solver> simulate(M const& model, State& x, I integrator, RunOptions options) {
  return Simulation<M, I, Solver>(model, x, std::move(integrator), std::move(options));
}

}  // namespace polybody
