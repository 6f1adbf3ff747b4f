#pragma once
/// \file
/// Static equilibrium: f(q) − Gᵀλ = 0, Φ(q) = 0 at v = 0, by full Newton with load steps.

#include <polybody/analysis/equilibrium_options.hpp>
#include <polybody/integrators/forward_dynamics.hpp>
#include <polybody/solvers/default_solver.hpp>
#include <polybody/solvers/newton.hpp>
#include <polybody/system/system.hpp>

namespace polybody {

namespace detail {
/// Multipliers that carry the loads at the first instant, in place of none: what holds a pendulum upright is made of them. False where the
/// state has no unique acceleration.
template <class M>
bool multipliers_at_rest(System<M>& system, State& x) {
  VecX a = x.a;
  try {
    ForwardDynamics<M>(system).accelerations(system, x.q, x.v, x.t, a, x.lambda);
  } catch (Error const&) {
    return false;
  }
  return true;
}
}  // namespace detail

/// Moves x (coordinates, multipliers; speeds become zero) into equilibrium at time x.t, from its present place.
/// Every term of the tangent is included. \throws NewtonStalled, LinearSolverSingular, NonFinite; x is then
/// untouched.
template <LinearSolver Solver = DefaultStaticSolver, class M>
EquilibriumReport equilibrium(M const& model, State& x, EquilibriumOptions const& options = {}) {
  System<M> system(model);
  State trial = x;
  trial.v.setZero();
  trial.a.setZero();
  Solver solver;
  PatternSink pattern;
  system.evaluate(trial.q, trial.v, trial.t);
  system.tangent({.stiffness = 1.0}, SecondOrder::included, trial.lambda, pattern);
  solver.analyse(system.size(), pattern.blocks);

  struct Problem {
    System<M>& system;
    Solver& solver;
    State& trial;
    double tolerance;
    double far = 1e6 * (1.0 + trial.q.cwiseAbs().maxCoeff());  ///< no equilibrium is sought beyond
    Index nv = system.speeds(), rows = system.rows(), bad = -1;
    VecX r = VecX::Zero(nv), phi = VecX::Zero(rows), rhs = VecX::Zero(nv + rows), y = rhs, dq = r,
         q = trial.q;

    bool evaluate() {
      system.evaluate(trial.q, trial.v, trial.t);
      system.residual(trial.a, trial.lambda, r);
      system.violation(phi);
      rhs << -r, -phi;
      return rhs.allFinite();
    }
    bool refactor() {
      bad = write_and_factor(solver, [&](Solver& sink) {
        system.tangent({.stiffness = 1.0}, SecondOrder::included, trial.lambda, sink);
      });
      return bad < 0;
    }
    double solve() {
      solver.solve(rhs, y);
      dq = y.head(nv);
      Index largest = 0;
      double const step = dq.cwiseAbs().maxCoeff(&largest), size = trial.q.cwiseAbs().maxCoeff();
      if (!(step < far && size < far)) {  // nothing but rounding errors resists
        bad = largest;
        return std::numeric_limits<double>::infinity();
      }
      return step / (tolerance * (1.0 + size));
    }
    void apply() {
      system.plus(trial.q, dq, q);
      trial.q.swap(q);
      trial.lambda += y.tail(rows);
    }
  } problem{system, solver, trial, options.tolerance};

  EquilibriumReport report;
  NewtonOptions newton_options{.max_iterations = options.max_iterations, .always_refactor = true};
  double const whole = 1.0 / std::max(options.load_steps, 1);
  double done = 0.0, part = whole;
  bool primed = false;
  while (done < 1.0) {
    State const before = trial;
    system.load_factor = std::min(done + part, 1.0);
    if (1.0 - system.load_factor < 1e-12) system.load_factor = 1.0;
    bool factored = false;
    double theta = 1.0;
    NewtonReport const n = newton(problem, newton_options, factored, theta);
    report.iterations += n.iterations;
    if (n.result == NewtonResult::converged) {
      done = system.load_factor;
      ++report.parts;
      part = std::min(2.0 * part, whole);
      continue;
    }
    trial = before;
    if (n.result == NewtonResult::singular && !primed) {
      primed = true;
      if (detail::multipliers_at_rest(system, trial)) continue;
    }
    part *= 0.5;
    if (part >= options.smallest_part) continue;
    std::string const at = " at load factor " + number(system.load_factor);
    if (n.result == NewtonResult::singular)
      throw LinearSolverSingular("equilibrium: the stiffness is singular" + at + ", first at " +
                                 system.name_of(std::max<Index>(problem.bad, 0)) +
                                 ". Hold every body, or pass a limit point another way.");
    if (n.result == NewtonResult::not_finite)
      throw NonFinite("equilibrium: a force is not finite" + at + ".");
    throw NewtonStalled("equilibrium: Newton's method did not converge" + at +
                        ". Use more load steps, or start nearer to the solution.");
  }
  x = std::move(trial);
  return report;
}

}  // namespace polybody
