#pragma once
/// \file
/// Checks of constraint equations at the ends of steps: choice of the redundant equations, and warnings of singular
/// configurations.

#include <string>
#include <vector>

#include <polybody/integrators/forward_dynamics.hpp>
#include <polybody/integrators/integrator.hpp>
#include <polybody/run/redundant_rows.hpp>

namespace polybody {

/// Choice of the redundant constraint equations that a run drops, updated from step to step.
template <class = void>
class RedundancyWatch {
 public:
  /// Chooses the redundant equations to drop at a start x, at which `forward` has been factorised.
  template <class Solver>
  void start(System& system, ForwardDynamics<Solver>& forward, State const& x) {
    if (!forward.redundant_rows().empty() && !keeps_all_) leave_out_redundant(system, forward, x);
  }
  /// Replaces the choice after a step to x if the choice is invalid at x. Returns true if the choice has changed.
  template <class Solver>
  bool changes(System& system, ForwardDynamics<Solver>& forward, State const& x) {
    return forward.leaves_out() && forward.is_doubtful() && leave_out_redundant(system, forward, x);
  }
  /// Sets `names` to the redundant joints `now` of the last start. If `keeps_earlier` is true, the joints of earlier
  /// choices remain.
  static void name(std::vector<std::string> now, bool keeps_earlier, std::vector<std::string>& names) {
    if (keeps_earlier)
      for (std::string& earlier : names)
        if (std::find(now.begin(), now.end(), earlier) == now.end()) now.push_back(std::move(earlier));
    names = std::move(now);
  }
  /// Takes a step of a run from x by step(). If the step fails or violates dropped equations, repeats the step with all
  /// equations.
  /// \param before state before the step; used only if equations are dropped \param restart restarts the run
  template <class Solver, class Step, class Restart>
  StepReport step(System& system, ForwardDynamics<Solver>& forward, State& x, State const& before, Step&& step,
                  Restart&& restart) {
    return forward.leaves_out() ? watched(system, forward, x, before, step, restart) : step();
  }

 private:
  /// Takes a step with dropped equations. If the step fails or violates a dropped equation, the step is repeated with
  /// all equations, and later steps drop none. A violated equation was redundant only at a singular configuration.
  template <class Solver, class Step, class Restart>
  [[gnu::cold]] StepReport watched(System& system, ForwardDynamics<Solver>& forward, State& x, State const& before,
                                   Step& step, Restart& restart) {
    AttemptCost tried;
    try {
      StepReport const report = step();
      if (!is_open(system, forward.left_out(), x)) return report;
      tried = {report.iterations, report.factorisations, report.evaluations};
      x = before;
    } catch (NewtonConvergenceFailure const&) {  // a second attempt with the same failure reports it
    }
    try {
      keeps_all_ = true;
      forward.mark_redundant({});
      restart();
      StepReport repeated = step();
      repeated.add(tried);
      return repeated;
    } catch (...) {
      x = before;
      throw;
    }
  }
  /// True if the violation of a dropped equation exceeds 1e-8 (1 + max |q|) plus 100 times the largest violation of the
  /// other equations.
  static bool is_open(System& system, std::span<Index const> left_out, State const& x) {
    VecX phi = VecX::Zero(system.rows());
    system.evaluate(x.q, x.v, x.t);
    system.violation(phi);
    double open = 0.0;
    for (Index const i : left_out) {
      open = std::max(open, std::abs(phi[i - system.velocities()]));
      phi[i - system.velocities()] = 0.0;
    }
    return open > 1e-8 * (1.0 + largest_size(x.q)) + 100.0 * largest_size(phi);
  }

  bool keeps_all_ = false;
};

/// Compares a measure of near redundancy at the ends of steps with its value at the start of the run.
class BranchWatch {
 public:
  /// Stores a measure of near redundancy of the constraint equations at x, which is taken as a regular configuration.
  template <class Solver>
  [[gnu::cold]] void begin(System& system, ForwardDynamics<Solver>& forward, State const& x) {
    if (system.rows() > 0) usual_ = forward.constraint_gain(system, x.q, x.v, x.t);
  }

  /// Adds a warning if the step ends at a state x near a singular configuration. Only the first warning of a run is
  /// added. A step is examined only if it factorised a matrix and changed the velocities by more than a tenth of the
  /// norm of `v`.
  /// \param v velocities before the step
  /// \param warnings warnings of the run
  template <class Solver>
  void look(System& system, ForwardDynamics<Solver>& forward, StepReport const& taken, VecX const& v, State const& x,
            std::vector<std::string>& warnings) {
    if (taken.factorisations == 0 || system.rows() == 0) return;
    SimdSum change;
    for_each_simd_block(x.v.size(), [&](auto at) {
      auto const by = at(x.v) - at(v);
      change.add(by * by);
    });
    if (change.total() > 0.01 * squares(v)) ask(system, forward, x, warnings);
  }

 private:
  template <class Solver>
  [[gnu::cold]] void ask(System& system, ForwardDynamics<Solver>& forward, State const& x,
                         std::vector<std::string>& warnings) {
    char const* const what = "The constraint equations lose rank near t = ";
    for (std::string const& warning : warnings)
      if (warning.starts_with(what)) return;
    if (!forward.is_singular(system, {x.q, x.v, x.t}, usual_)) return;
    warnings.push_back(
        what + number(x.t) +
        " s, and the velocities jump in the step that ends at this time. At this singular configuration the motion can "
        "change to another branch, and the step and the integrator select the branch. Compare the run with a run of "
        "another step length.");
  }

  ConstraintGain usual_;
};

}  // namespace polybody
