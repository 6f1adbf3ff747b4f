#pragma once
/// \file
/// Damped motion into equilibrium, for `equilibrium` if Newton's method does not converge.

#include <polybody/statics/equilibrium_equations.hpp>
#include <polybody/statics/stability.hpp>

namespace polybody::detail {

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

/// Displaces an unstable equilibrium by 1e-3 (1 + max |q|) along a motion of negative stiffness. Returns false for a
/// stable equilibrium.
template <class Solver>
[[gnu::cold]] bool leaves_saddle(EquilibriumPath<Solver>& path) {
  path.system.evaluate(path.trial.q, path.trial.v, path.trial.t);
  Stability const found = stability(path.system, path.tangent, path.trial.lambda);
  if (found.negative <= 0) return false;
  path.dq = (1e-3 * (1.0 + largest_size(path.trial.q)) / largest_size(found.motion)) * found.motion;
  path.system.plus(path.trial.q, path.dq, path.q);
  path.trial.q.swap(path.q);
  return true;
}

/// Damped motion from `start` into equilibrium, for states from which Newton's method does not converge, such as
/// slack cables. It follows the gradient flow
///   W q̇ = f − Gᵀλ,  Φ(q) = (1 − s) Φ₀,  W the diagonal of the mass matrix,
/// by the implicit Euler method. The load increases to the full load. The steps τ grow as long as they converge
/// (pseudo-transient continuation [Kelley & Keyes 1998]). The motion ends in a stable equilibrium, because unstable
/// equilibria repel it. Returns true if the motion ends in equilibrium.
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
  double const stiffest = 1e6 * step.mu;
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
    path.tangent.remove_springs(path.trial.lambda);
    reached = correct(path, options, report) == NewtonResult::converged &&
              largest_size(path.trial.q - near.q) <= 0.05 * (1.0 + largest_size(near.q));
    if (!reached) {
      failures += 4;
      path.trial = near;
    } else if (saddles < 20 && leaves_saddle(path)) {
      ++saddles;
      reached = false;
      step.mu = std::min(1e4 * step.mu, 1e-6 * stiffest);
    }
  }
  if (!reached) path.tangent.remove_springs(path.trial.lambda);
  return report.relaxed = reached;
}

/// Counts the negative pivots in the present state and adds them to the report, with a warning if there are any.
template <class Solver>
[[gnu::cold]] void report_stability(EquilibriumPath<Solver>& path, EquilibriumReport& report) {
  report.negative_pivots = -1;
  if (path.states > 0) return;
  path.system.evaluate(path.trial.q, path.trial.v, path.trial.t);
  Stability const found = stability(path.system, path.tangent, path.trial.lambda);
  report.negative_pivots = int(found.negative);
  if (found.negative <= 0) return;
  Index largest = 0;
  found.motion.cwiseAbs().maxCoeff(&largest);
  report.warnings.push_back(sentence_of(
      {"The equilibrium is unstable: the stiffness has ", found.negative,
       found.negative == 1 ? " negative pivot" : " negative pivots",
       " on the motions that the joints allow. In such a motion, ", name_of_motion(path.system, found.motion, largest),
       ". A small disturbance leads away from this state. Start nearer to a stable state, or "
       "apply the loads in smaller steps."}));
}

}  // namespace polybody::detail
