#pragma once
/// \file
/// Static equilibrium by Newton's method with load steps, or by a damped motion if Newton's method does not converge.
/// Theory: Eqs. 7.16, 7.18.

#include <polybody/integrators/forward_dynamics.hpp>
#include <polybody/run/redundant_constraints.hpp>
#include <polybody/run/state_checks.hpp>
#include <polybody/solvers/default_solver.hpp>
#include <polybody/statics/equilibrium_equations.hpp>
#include <polybody/statics/equilibrium_options.hpp>
#include <polybody/statics/stability.hpp>
#include <polybody/system/make_operations.hpp>

namespace polybody::detail {

// Damped motion into equilibrium, for `equilibrium` if Newton's method does not converge.

/// Receiver of matrix blocks that adds up the diagonal of the matrix.
struct DiagonalSink {
  VecX& sum;

  void add(Index row, Index col, BlockView const& b) {
    if (row != col || row + b.rows > sum.size()) return;
    for (Index i = 0; i < std::min(b.rows, b.cols); ++i) sum[row + i] += b(i, i);
  }
};

/// Equations of one step τ of the damped motion `relax`, for Newton's method. The tangent is K + μ W instead of K, with
/// μ = 1/τ and the weights W.
template <class Solver>
struct DampedStep {
  EquilibriumPath<Solver>& path;
  VecX weights;
  double mu = 0.0;
  VecX moved = VecX::Zero(path.nv), springs = VecX::Zero(path.nv + path.rows);

  bool evaluate() {
    if (!path.evaluate()) return false;
    path.r.array() -= mu * weights.array() * moved.array();
    return true;
  }
  bool refactor() {
    springs.head(path.nv) = (mu / path.tangent.next_unit()) * weights;
    path.tangent.set_springs(springs, path.trial.lambda);
    path.bad = path.tangent.factor(path.trial.lambda);
    return path.bad < 0;
  }
  double solve() {
    path.tangent.solve(path.r, path.phi, path.y);
    return path.correction();
  }
  void apply() {
    path.apply();
    moved += path.dq;
  }
};

/// Displaces an unstable equilibrium by 1e-3 (1 + max |q|) along a motion of negative stiffness. Returns false if no
/// motion of negative stiffness is found.
template <class Solver>
[[gnu::cold]] bool leaves_saddle(EquilibriumPath<Solver>& path) {
  Stability const found = stability(path.system, path.tangent, path.trial, 10.0 * path.tolerance);
  if (found.negative <= 0) return false;
  path.dq = (1e-3 * (1.0 + largest_size(path.trial.q)) / largest_size(found.motion)) * found.motion;
  path.system.plus(path.trial.q, path.dq, path.q);
  path.trial.q.swap(path.q);
  return true;
}

/// Damped motion from `start` into equilibrium, for states from which Newton's method does not converge, such as slack
/// cables. The damped motion follows the gradient flow
///   W q̇ = f − Gᵀλ,  Φ(q) = (1 − s) Φ₀,  W the diagonal of the mass matrix,
/// by the implicit Euler method. The fraction s of the load path increases to one. The steps τ grow as long as they
/// converge (pseudo-transient continuation [Kelley & Keyes 1998]). The motion ends in a stable equilibrium, because
/// unstable equilibria repel it. Returns true if the motion ends in equilibrium.
template <class Solver>
[[gnu::cold]] bool relax(EquilibriumPath<Solver>& path, State const& start, EquilibriumOptions const& options,
                         EquilibriumReport& report) {
  if (path.states > 0) return false;
  path.trial = start;
  path.takes_least = false;
  path.begin();
  DampedStep<Solver> step{path, VecX::Zero(path.nv)};
  DiagonalSink sink{step.weights};
  path.system.tangent({.mass = 1.0}, SecondOrder::included, path.trial.lambda, sink);
  double const heaviest = step.weights.maxCoeff();
  if (!(heaviest > 0.0 && std::isfinite(heaviest))) return false;
  step.weights = step.weights.cwiseMax(1e-9 * heaviest);
  double share = 0.0, part = 0.05;
  step.mu = path.tangent.next_unit() / heaviest;
  double const largest_mu = step.mu, stiffest = 1e6 * step.mu;
  bool reached = false;
  int saddles = 0, failures = 0;
  NewtonOptions const few{.max_iterations = std::min(12, options.max_iterations), .always_refactor = true};
  for (int k = 0; k < 2000 && failures < 200 && step.mu < stiffest && !reached; ++k) {
    State const before = path.trial;
    double const next = std::min(1.0, share + part);
    path.advance(next);
    step.moved.setZero();
    ReusedFactorisation reused;
    NewtonReport const n = newton(step, few, reused);
    report.iterations += n.iterations;
    if (n.result != NewtonResult::converged) {
      ++failures;
      path.trial = before;
      step.mu *= 4.0;
      part = std::max(0.5 * part, 1e-4);
      continue;
    }
    share = next;
    step.mu *= n.iterations <= 5 ? 0.25 : 0.7;
    part = std::min(2.0 * part, 0.1);
    if (share < 1.0 || !(largest_size(step.moved) <= 1e-3 * (1.0 + largest_size(path.trial.q)))) continue;
    State const near = path.trial;
    double const size = 1.0 + largest_size(near.q);
    // Free motions about the equilibrium make its tangent singular. The damped motion then continues until its steps
    // are below the tolerance.
    reached = step.mu < 1e-12 * largest_mu && largest_size(step.moved) <= options.tolerance * size;
    if (reached) break;
    path.tangent.remove_springs(path.trial.lambda);
    NewtonResult const end = correct(path, options, report);
    reached = end == NewtonResult::converged && largest_size(path.trial.q - near.q) <= 0.05 * size;
    if (!reached) {
      failures += end == NewtonResult::singular ? 1 : 4;
      path.trial = near;
    } else if (saddles < 20 && leaves_saddle(path)) {
      ++saddles;
      reached = false;
      step.mu = std::min(1e4 * step.mu, 1e-6 * stiffest);
    }
  }
  path.tangent.remove_springs(path.trial.lambda);
  return report.relaxed = reached;
}

/// Adds the number of negative pivots of the stiffness in the present state to the report, with a warning if there are
/// any. The number is −1 for a model with first-order states, and if the matrix is too large.
template <class Solver>
[[gnu::cold]] void report_stability(EquilibriumPath<Solver>& path, EquilibriumReport& report) {
  report.negative_pivots = -1;
  if (path.states > 0) return;
  Stability const found = stability(path.system, path.tangent, path.trial, 10.0 * path.tolerance);
  report.negative_pivots = int(found.negative);
  if (found.negative <= 0) return;
  Index largest = 0;
  found.motion.cwiseAbs().maxCoeff(&largest);
  report.warnings.push_back(sentence_of(
      {"The equilibrium is unstable: the stiffness has ", found.negative,
       found.negative == 1 ? " negative pivot" : " negative pivots",
       " on the motions that the joints allow. One such motion: ", name_of_motion(path.system, found.motion, largest),
       ". A small disturbance leads away from this state. Start nearer to a stable state, or "
       "apply the loads in smaller steps."}));
}

}  // namespace polybody::detail

namespace polybody {

namespace detail {
/// Computes initial multipliers by forward dynamics in state x. A pendulum, for example, has no stiffness without
/// multipliers. Returns false if they cannot be computed, for example because the accelerations are not unique.
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

/// Joints of `joints_of_branch_point` in a state at rest. Empty if the state has no factorisation.
template <class = void>
[[gnu::cold]] std::string branching_joints(System& system, State const& x) {
  try {
    ForwardDynamics<DefaultSolver> forward(system);
    return joints_of_branch_point(system, forward, x);
  } catch (Error const&) {
    return "";
  }
}

/// Follows the path from the present state to its end. Returns `converged` at the end, otherwise the reason why the
/// path ends earlier. `path.trial` is then the last equilibrium.
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
/// last corrections use the tangent at the end of the path; the report names the motions and constraints to which
/// springs were added. \throws InconsistentInitialConditions for redundant constraints that contradict others.
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

/// Treats an unstable state that was reached only by step halving. If the damped motion from `start` ends in a stable
/// state, that state replaces the unstable one.
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
/// With several load steps, or if one step does not converge, Newton's method is applied along the path s = 0 … 1 of
///   r(q, λ, p) = (1 − s) r₀,  Φ(q) = (1 − s) Φ₀,  p = p₀ + s (1 − p₀),
/// with the factor p of loads and gravity. p₀ ∈ [0, 1] minimises the residual at x; r₀ and Φ₀ are the remaining
/// residuals. From a reference state the loads increase from zero; from an equilibrium under smaller loads they
/// increase from these smaller loads. If Newton's method does not converge on the path either, a damped motion from x
/// is followed to a stable equilibrium (`EquilibriumReport::relaxed`).
///
/// If the tangent is singular, the path is followed again by minimum-norm corrections (`MinimumNormStep`). Redundant
/// constraints are omitted, and their multipliers are zero. Free motions that no load excites are as small as possible.
/// The report names these constraints and motions.
///
/// \throws NewtonConvergenceFailure; SingularMatrix, naming the motion if a load excites a motion without stiffness;
/// InconsistentInitialConditions for redundant constraints that contradict others; NonFiniteValue; InvalidInput for
/// invalid options or a state that does not fit the model. x is then unchanged.
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
        path.refuse(result, bad, at, detail::branching_joints(system, start));
      detail::report_limit_point<>(limit, report);
    }
  }
  bool const crosses = path.crosses && !path.takes_least && !report.relaxed;
  detail::report_stability(path, report);
  if (report.negative_pivots > 0 && !report.relaxed && report.load_steps > options.load_steps)
    detail::relax_unstable(path, start, options, report);
  else if (crosses && path.states == 0 && report.negative_pivots == 0)
    detail::follow_without_crossing(path, start, options, report);
  warn_of_units(system, report.warnings);
  x = std::move(trial);
  return report;
}

/// Moves state x of `model` into static equilibrium, with the method and exceptions of the overload for `System`.
/// Joints whose policies eliminate unknowns are treated as constraint equations.
template <LinearSolver Solver = DefaultStaticSolver, class M>
EquilibriumReport equilibrium(M const& model, State& x, EquilibriumOptions const& options = {}) {
  System system(model, with < Capabilities::implicit_step | Capabilities::rigid_velocities >);
  return equilibrium<Solver>(system, x, options);
}

}  // namespace polybody
