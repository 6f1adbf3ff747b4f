#pragma once
/// \file
/// Steps in which each island of a model has its own iterations, factorisation and halvings.
/// Theory: Eq. 6.45.

#include <memory>
#include <vector>

#include <polybody/integrators/newton_failure.hpp>
#include <polybody/integrators/step_history.hpp>

namespace polybody {

/// Solution of a step, island by island (`ModelIsland`), for a method with a workspace of each island. One Newton
/// solve for all islands needs the most iterations that an island needs, and it fails if one island fails. The islands
/// are separated when such a solve fails or is expensive, and they then stay separated for 16 steps. If the next solve
/// of all islands is also expensive, the next period is twice as long. Memory is allocated at the first separation. The
/// results equal those of a single solve to the tolerance of Newton's method.
template <class Method, class Solver>
class IslandSteps {
 public:
  /// True if the next step solves the islands apart.
  bool active() const { return left_ > 0; }
  /// Number of islands; zero before the first separation, and for a model with one island.
  std::size_t count() const { return islands_.size(); }
  /// Discards the data of earlier steps, at a start of the integrator. \param redundant true if constraint equations
  /// are redundant, which ends the period
  void forget(bool redundant) {
    if (redundant) left_ = 0;
    for (Island& island : islands_) island.hard = island.work->reused_factorisation.usable = false;
  }

  /// Counts a step that solved all islands together. Returns true if its iterations and factorisations amount to at
  /// least twelve iterations. \param report cost of the step \param options cost of a factorisation
  bool pays(NewtonReport const& report, NewtonOptions const& options) {
    ++since_;
    return !single_ && report.iterations + options.factorisation_cost * report.factorisations >= 12.0;
  }
  /// Begins a period of steps of `method`, with the workspace `w`, that solve the islands apart. Returns false for a
  /// model with one island, with eliminated unknowns or with redundant constraint equations.
  template <class Workspace>
  [[gnu::cold]] bool begin(Method const& method, System& system, Workspace& w) {
    if (!single_ && islands_.empty()) separate(method, system);
    if (single_ || w.forward.leaves_out()) return false;
    stay_ = since_ <= stay_ ? std::min(2 * stay_, longest_stay) : shortest_stay;
    left_ = stay_;
    since_ = 0;
    forget(false);
    return true;
  }

  /// Solves a step of `method` with the length h [s] from x. w contains v₀ and a₀ of the step; w.q, w.v, w.vd, w.a and
  /// w.lambda receive its end, at which `system` is evaluated. The report contains the largest numbers of an island.
  /// \throws the exceptions of a step
  template <class Workspace>
  StepReport step(Method const& method, System& system, State const& x, double h, Workspace& w) {
    StepReport most;
    for (Island& island : islands_) {
      take(island, x, w);
      StepReport of_island;
      try {
        of_island = advance(method, island, h, std::max(0, w.check.bounds.halvings));
      } catch (...) {
        add_cost(w.check.failed, island.work->check.failed);
        throw;
      }
      of_island.add(island.work->check.failed);
      give(island, w);
      keep_most(most, of_island);
    }
    most.taken = most.next = h;
    system.evaluate(w.q, w.v, x.t + h);
    system.residual(w.vd, w.lambda, w.r);  // for the checks of the step
    --left_;
    return most;
  }

 private:
  using Range = IslandPlaces::Range;
  struct Island {
    std::unique_ptr<System> system;
    IslandPlaces places;
    State x;
    std::unique_ptr<typename Method::template Workspace<Solver>> work;
    bool hard = false;  ///< true if the last step needed the full Newton method
  };
  static constexpr long shortest_stay = 16, longest_stay = 1L << 20;
  static constexpr int deepest = 30;

  [[gnu::cold]] void separate(Method const& method, System& system) {
    single_ = true;
    if (system.step_coordinates()) return;
    Sequence<ModelIsland> made = system.operations().islands();
    single_ = made.empty();
    islands_.reserve(made.size());
    for (ModelIsland& from : made) {
      if (Workers* const workers = system.data().workers) from.operations->share_loops(from.data, *workers);
      Island island{std::make_unique<System>(std::move(from.operations), std::move(from.layout), std::move(from.data),
                                             CoordinatesOf<double>{}),
                    std::move(from.places),
                    {},
                    {},
                    false};
      System& s = *island.system;
      island.work = std::make_unique<typename Method::template Workspace<Solver>>(s);
      method.analyse(s, *island.work);
      island.work->islands.single_ = true;
      island.x = {VecX::Zero(s.coordinates()),
                  VecX::Zero(s.velocities()),
                  VecX::Zero(s.velocities()),
                  VecX::Zero(s.rows()),
                  0.0,
                  {}};
      StepHistory::reset(island.x);
      islands_.push_back(std::move(island));
    }
  }

  static void copy_in(Sequence<Range> const& places, double const* from, double* to) {
    for (Range const& r : places) std::copy_n(from + r.model, r.count, to + r.own);
  }
  static void copy_out(Sequence<Range> const& places, VecX const& from, VecX& to) {
    for (Range const& r : places) std::copy_n(from.data() + r.own, r.count, to.data() + r.model);
  }
  /// Copies the state, its history, v₀ and a₀ of an island.
  template <class Workspace>
  static void take(Island& island, State const& x, Workspace const& w) {
    IslandPlaces const& at = island.places;
    State& own = island.x;
    copy_in(at.q, x.q.data(), own.q.data());
    copy_in(at.v, x.v.data(), own.v.data());
    copy_in(at.v, x.a.data(), own.a.data());
    copy_in(at.rows, x.lambda.data(), own.lambda.data());
    own.t = x.t;
    double const* from = x.history.data();
    double* to = own.history.data();
    for (int k = 0; k < StepHistory::of_velocities; ++k, from += x.v.size(), to += own.v.size())
      copy_in(at.v, from, to);
    for (int k = 0; k < StepHistory::of_multipliers; ++k, from += x.lambda.size(), to += own.lambda.size())
      copy_in(at.rows, from, to);
    std::copy_n(from, StepHistory::lengths, to);
    copy_in(at.v, w.v0.data(), island.work->v0.data());
    copy_in(at.v, w.a0.data(), island.work->a0.data());
    island.work->check.failed = {};
  }
  /// Copies the end of the step of an island to w.
  template <class Workspace>
  static void give(Island const& island, Workspace& w) {
    copy_out(island.places.q, island.x.q, w.q);
    copy_out(island.places.v, island.x.v, w.v);
    copy_out(island.places.v, island.x.a, w.vd);
    copy_out(island.places.rows, island.x.lambda, w.lambda);
    for (Range const& r : island.places.v) std::copy_n(island.x.history.data() + r.own, r.count, w.a.data() + r.model);
  }

  /// Performs a step of an island. If the last step of the island needed the full Newton method, the step begins with
  /// it.
  static StepReport attempt(Method const& method, Island& island, double h) {
    if (std::exchange(island.hard, false)) {
      try {
        StepReport const report = method.advance(*island.system, island.x, h, *island.work, 1);
        island.hard = report.iterations > 4;
        return report;
      } catch (NewtonConvergenceFailure const&) {  // all attempts follow
      }
    }
    StepReport const report = method.advance(*island.system, island.x, h, *island.work);
    island.hard = report.factorisations > 3;
    return report;
  }
  /// Performs a step of an island. A step that does not converge is repeated as two halves from a new start, each of
  /// which can be halved again, as in `RunDriver::halving_step`.
  static StepReport advance(Method const& method, Island& island, double h, int halvings, int depth = 0) {
    System& system = *island.system;
    State& x = island.x;
    auto& w = *island.work;
    try {
      return attempt(method, island, h);
    } catch (NewtonConvergenceFailure const&) {
      if (halvings == 0 || depth == deepest) throw;
    }
    w.forward.project_velocities(system, x.q, x.v, x.t);
    method.start(system, x, 0.5 * h, w);
    (void)method.start_step(system, x, 0.5 * h, w);
    StepReport report = advance(method, island, 0.5 * h, halvings - 1, depth + 1);
    ++report.halved;
    ++report.rejected;
    (void)method.start_step(system, x, h - report.taken, w);
    report.append(advance(method, island, h - report.taken, halvings, depth + 1));
    return report;
  }

  static void add_cost(AttemptCost& to, AttemptCost const& of) {
    to.iterations += of.iterations;
    to.factorisations += of.factorisations;
    to.evaluations += of.evaluations;
  }
  static void keep_most(StepReport& most, StepReport const& of) {
    for (int StepReport::* const n : {&StepReport::iterations, &StepReport::factorisations, &StepReport::evaluations,
                                      &StepReport::rejected, &StepReport::halved})
      most.*n = std::max(most.*n, of.*n);
    most.contraction = std::max(most.contraction, of.contraction);
    most.left = std::max(most.left, of.left);
  }

  std::vector<Island> islands_;
  bool single_ = false;        ///< true if the model cannot be separated
  long stay_ = shortest_stay;  ///< length of a period of separate islands, in steps
  long left_ = 0;              ///< remaining steps of the period
  long since_ = longest_stay;  ///< number of steps that solved all islands together, since the last period
};

}  // namespace polybody
