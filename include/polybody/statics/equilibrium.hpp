#pragma once
/// \file
/// Static equilibrium by Newton's method with load steps.

#include <polybody/integrators/forward_dynamics.hpp>
#include <polybody/run/state_checks.hpp>
#include <polybody/solvers/default_solver.hpp>
#include <polybody/statics/equilibrium_equations.hpp>
#include <polybody/statics/load_steps.hpp>
#include <polybody/statics/relaxation.hpp>
#include <polybody/statics/stability.hpp>
#include <polybody/system/make_operations.hpp>

namespace polybody {

namespace detail {
/// Computes initial multipliers by forward dynamics in state x. A pendulum, for example, has no stiffness without
/// multipliers. Returns false if the accelerations are not unique.
template <class = void>
bool multipliers_at_rest(System& system, State& x) {
  VecX a = x.a;
  try {
    ForwardDynamics<DefaultSolver>(system).accelerations(system, {x.q, x.v, x.t}, a, x.lambda);
  } catch (Error const&) {
    return false;
  }
  return true;
}

/// Follows the path from the present state to its end. Returns the result of the last Newton iteration. `path.trial`
/// is then the last equilibrium.
template <class Solver>
NewtonResult follow(EquilibriumPath<Solver>& path, EquilibriumOptions const& options, EquilibriumReport& report) {
  LoadSteps steps(options);
  bool primed = false, crosses = false;
  path.begin();
  while (!steps.done()) {
    State const before = path.trial;
    path.advance(steps.next());
    int const iterations = report.iterations;
    NewtonResult const result = correct(path, options, report);
    if (result == NewtonResult::converged && report.iterations - iterations > 5) path.look_half_way(before);
    if (result == NewtonResult::converged && !(path.refuses_crossing && path.crosses)) {
      path.measure_rate(before, steps.next() - steps.reached());
      steps.reach_next();
      ++report.load_steps;
      crosses = crosses || path.crosses;
      continue;
    }
    path.trial = before;
    if (result == NewtonResult::singular && !primed) {
      primed = true;
      if (multipliers_at_rest(path.system, path.trial)) {
        path.begin();
        steps.restart();
        continue;
      }
    }
    if (!steps.halve()) return result == NewtonResult::converged ? NewtonResult::diverged : result;
  }
  path.crosses = crosses;
  return NewtonResult::converged;
}

/// Follows the path again from `start`, by minimum-norm corrections. Returns true if the path ends in equilibrium. The
/// last corrections use the tangent at the end of the path; the report names the motions and constraints with springs.
template <class Solver>
bool follow_least(EquilibriumPath<Solver>& path, State const& start, EquilibriumOptions const& options,
                  EquilibriumReport& report) {
  path.trial = start;
  path.takes_least = true;
  if (follow(path, options, report) != NewtonResult::converged) return false;
  if (correct(path, options, report) != NewtonResult::converged) return false;
  path.report_springs(report);
  path.system.evaluate(path.trial.q, path.trial.v, path.trial.t);
  path.require_closed();
  path.least.drop_multipliers(path.trial.lambda);
  return true;
}

/// Treats an unstable state that was reached only by step halving. The end of the damped motion from `start` replaces
/// this state if it is stable.
template <class Solver>
[[gnu::cold]] void relax_unstable(EquilibriumPath<Solver>& path, State const& start, EquilibriumOptions const& options,
                                  EquilibriumReport& report) {
  State const found = path.trial;
  EquilibriumReport again;
  bool const converged = relax(path, start, options, again);
  report.iterations += again.iterations;
  if (converged) report_stability(path, again);
  if (converged && again.negative_pivots == 0) {
    report = again;
    return;
  }
  path.trial = found;
  path.advance(1.0);
  path.system.evaluate(found.q, found.v, found.t);
}

/// Adds a limit point at the load factor `factor` to the report, with a warning. Does nothing if `factor` is 0.
template <class = void>
[[gnu::cold]] void report_limit_point(double factor, EquilibriumReport& report) {
  if (factor == 0.0) return;
  report.limit_point = factor;
  report.warnings.push_back(sentence_of(
      {"The path of equilibria from the start has a limit point near load factor ", factor,
       ". The equilibrium that was found is not on this path. Follow the path with equilibrium_path(model, x)."}));
}

/// Follows the path a second time from `start`. Load steps in which the determinant of the tangent changes its sign are
/// halved. If this path ends in another stable state, that state becomes the result. If it ends early at a limit point,
/// the first result remains, and the report contains the load factor of the limit point.
template <class Solver>
[[gnu::cold]] void follow_without_crossing(EquilibriumPath<Solver>& path, State const& start,
                                           EquilibriumOptions const& options, EquilibriumReport& report) {
  State const found = path.trial;
  path.trial = start;
  path.advance(1.0);
  path.evaluate();
  double const loads = largest_size(path.r);
  path.refuses_crossing = true;
  path.least_rate = std::numeric_limits<double>::infinity();
  EquilibriumReport again;
  if (follow(path, options, again) != NewtonResult::converged) {
    report_limit_point<>(path.limit_point(), report);
  } else if (largest_size(path.trial.q - found.q) > 1e-6 * (1.0 + largest_size(found.q)) && !path.is_singular()) {
    path.advance(1.0);
    // If the stiffness is as small as the round-off of the loads, Newton's method may converge without leaving the
    // start.
    bool const balanced = path.evaluate() && largest_size(path.r) <= 1e-6 * loads;
    report_stability(path, again);
    if (again.negative_pivots == 0 && balanced) {
      report = std::move(again);
      return;
    }
  }
  path.trial = found;
  path.advance(1.0);
  path.system.evaluate(found.q, found.v, found.t);
}

}  // namespace detail

/// Moves x into static equilibrium at time x.t from its present configuration: f(q, z) − Gᵀλ = 0, Φ(q) = 0 and h(q, z)
/// = 0 at v = 0. Coordinates, first-order states and multipliers of x change; its velocities become zero. The tangent
/// stiffness contains every term, also those with multipliers.
///
/// If Newton's method does not converge at once, it is applied along the path s = 0 … 1 of
///   r(q, λ, p) = (1 − s) r₀,  Φ(q) = (1 − s) Φ₀,  p = p₀ + s (1 − p₀),
/// with the factor p of loads and gravity. p₀ ∈ [0, 1] minimises the residual at x; r₀ and Φ₀ are the remaining
/// residuals. From a reference state the loads increase from zero; from an equilibrium under smaller loads they
/// increase from these smaller loads.
///
/// If the tangent is singular, the path is followed again by minimum-norm corrections (`MinimumNormStep`). Redundant
/// constraints are omitted, and their multipliers are zero. Free motions that no load excites are as small as possible.
/// The report names these constraints and motions.
///
/// \throws NewtonConvergenceFailure; SingularMatrix, naming the motion if a load excites a motion without stiffness;
/// InconsistentInitialConditions for redundant constraints that contradict others; NonFiniteValue. x is then unchanged.
template <LinearSolver Solver = DefaultStaticSolver>
EquilibriumReport equilibrium(System& system, State& x, EquilibriumOptions const& options = {}) {
  options.check();
  require_usable(system, x);
  State trial = x;
  trial.v.head(trial.v.size() - system.layout().states).setZero();
  trial.a.setZero();
  State const start = trial;
  system.evaluate(trial.q, trial.v, trial.t);
  StaticTangent<Solver> tangent(system, trial.lambda);
  MinimumNormStep<Solver> least(system, tangent);
  detail::EquilibriumPath<Solver> path{system, tangent, least, trial, options.tolerance};
  EquilibriumReport report;
  NewtonResult const result = detail::follow(path, options, report);
  std::string const at = path.place();
  Index const bad = path.bad;
  if (result == NewtonResult::converged) {
    bool const has_free_motion = path.is_singular();
    path.report_springs(report);
    State const found = trial;
    if (has_free_motion && !detail::follow_least(path, start, options, report)) {
      trial = found;
      report.free_motions.clear();
    }
  } else {
    bool const singular =
        result == NewtonResult::singular || (result == NewtonResult::diverged && path.finds_springs());
    if (!singular || !detail::follow_least(path, start, options, report)) {
      path.refuse_excited();
      double const limit = result == NewtonResult::not_finite ? 0.0 : path.limit_point();
      if (result == NewtonResult::not_finite || !detail::relax(path, start, options, report))
        path.refuse(result, bad, at);
      detail::report_limit_point<>(limit, report);
    }
  }
  bool const crosses = path.crosses && !path.takes_least && !report.relaxed;
  detail::report_stability(path, report);
  if (report.negative_pivots > 0 && !report.relaxed && report.load_steps > options.load_steps)
    detail::relax_unstable(path, start, options, report);
  else if (crosses && path.states == 0 && report.negative_pivots == 0)
    detail::follow_without_crossing(path, start, options, report);
  x = std::move(trial);
  return report;
}

/// Overload for a model. Joints whose policies eliminate unknowns are treated as constraint equations here.
template <LinearSolver Solver = DefaultStaticSolver, class M>
EquilibriumReport equilibrium(M const& model, State& x, EquilibriumOptions const& options = {}) {
  System system(model, with < Capabilities::implicit_step | Capabilities::rigid_velocities >);
  return equilibrium<Solver>(system, x, options);
}

}  // namespace polybody
