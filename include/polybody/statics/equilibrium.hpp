#pragma once
/// \file
/// Static equilibrium: f(q, z) − Gᵀλ = 0, Φ(q) = 0 and h(q, z) = 0 at v = 0, by full Newton with load steps.

#include <polybody/integrators/forward_dynamics.hpp>
#include <polybody/solvers/default_solver.hpp>
#include <polybody/solvers/newton.hpp>
#include <polybody/statics/load_steps.hpp>
#include <polybody/statics/static_tangent.hpp>
#include <polybody/system/model_entries.hpp>

namespace polybody {

namespace detail {
/// Multipliers that carry the loads at the first instant, in place of none: what holds a pendulum upright is made of
/// them. False where the state has no unique acceleration.
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

/// The equations of `equilibrium` for Newton's method, at a share s of the path.
template <class Solver>
struct EquilibriumPath {
  System& system;
  StaticTangent<Solver>& tangent;
  State& trial;
  double tolerance;
  double far = 1e6 * (1.0 + trial.q.cwiseAbs().maxCoeff());  ///< no equilibrium is sought beyond
  Index nv = system.speeds(), rows = system.rows(), states = system.layout().states, bad = -1;
  double first = 0.0, share = 0.0;  ///< p₀, s
  VecX r0 = VecX::Zero(nv), phi0 = VecX::Zero(rows), r = r0, phi = phi0, y = VecX::Zero(nv + rows), dq = r, q = trial.q;

  /// The path starts at the present place.
  void begin() {
    system.evaluate(trial.q, trial.v, trial.t);
    system.load_factor = 0.0;
    system.residual(trial.a, trial.lambda, r0);
    system.load_factor = 1.0;
    system.residual(trial.a, trial.lambda, r);
    r -= r0;
    double const loads = r.squaredNorm();
    first = loads > 0.0 ? std::clamp(-r0.dot(r) / loads, 0.0, 1.0) : 0.0;
    r0 += first * r;
    system.violation(phi0);
  }
  void advance(double s) {
    share = s;
    system.load_factor = first + s * (1.0 - first);
  }

  bool evaluate() {
    system.evaluate(trial.q, trial.v, trial.t);
    system.residual(trial.a, trial.lambda, r);
    system.violation(phi);
    r = (1.0 - share) * r0 - r;
    phi = (1.0 - share) * phi0 - phi;
    return r.allFinite() && phi.allFinite();
  }
  bool refactor() {
    bad = tangent.factor(trial.lambda);
    return bad < 0;
  }
  double solve() {
    tangent.solve(r, phi, y);
    dq = y.head(nv);
    for (Index i = nv - states; i < nv; ++i) dq[i] /= 1.0 + std::abs(trial.v[i]);  // each by its own unit
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
    trial.v.tail(states) += y.segment(nv - states, states);
    trial.lambda += y.tail(rows);
  }

  /// \throws LinearSolverSingular, NonFinite, NewtonStalled as the result says.
  [[noreturn]] void refuse(NewtonResult result) const {
    std::string const at = " at load factor " + number(system.load_factor);
    if (result == NewtonResult::singular)
      throw LinearSolverSingular("equilibrium: the stiffness is singular" + at + ", first at " +
                                 system.name_of(std::max<Index>(bad, 0)) +
                                 ". Hold every body, or pass a limit point another way.");
    if (result == NewtonResult::not_finite) throw NonFinite("equilibrium: a force is not finite" + at + ".");
    throw NewtonStalled("equilibrium: Newton's method did not converge" + at +
                        ". Use more load steps, or start nearer to the solution.");
  }
};

}  // namespace detail

/// Moves x (coordinates, first-order states, multipliers; speeds become zero) into equilibrium at time x.t, from its
/// present place. Every
/// term of the tangent is included. Where Newton's method does not get there at once, it follows the path s = 0 … 1 of
///   r(q, λ, p) = (1 − s) r₀,  Φ(q) = (1 − s) Φ₀,  p = p₀ + s (1 − p₀),
/// p the factor of loads and gravity: p₀ ∈ [0, 1] is the one that best keeps x where it is, r₀ and Φ₀ what it leaves.
/// From a reference state loads grow from nothing; from an equilibrium under smaller ones they grow from those.
/// \throws NewtonStalled, LinearSolverSingular, NonFinite; x is then untouched.
template <LinearSolver Solver = DefaultStaticSolver>
EquilibriumReport equilibrium(System& system, State& x, EquilibriumOptions const& options = {}) {
  State trial = x;
  trial.v.head(trial.v.size() - system.layout().states).setZero();
  trial.a.setZero();
  system.evaluate(trial.q, trial.v, trial.t);
  StaticTangent<Solver> tangent(system, trial.lambda);
  detail::EquilibriumPath<Solver> path{system, tangent, trial, options.tolerance};
  NewtonOptions const newton_options{.max_iterations = options.max_iterations, .always_refactor = true};
  EquilibriumReport report;
  LoadSteps steps(options);
  bool primed = false;
  path.begin();
  while (!steps.done()) {
    State const before = trial;
    path.advance(steps.next());
    bool factored = false;
    double theta = 1.0;
    NewtonReport const n = newton(path, newton_options, factored, theta);
    report.iterations += n.iterations;
    if (n.result == NewtonResult::converged) {
      steps.reach_next();
      ++report.parts;
      continue;
    }
    trial = before;
    if (n.result == NewtonResult::singular && !primed) {
      primed = true;
      if (detail::multipliers_at_rest(system, trial)) {
        path.begin();
        steps.restart();
        continue;
      }
    }
    if (!steps.halve()) path.refuse(n.result);
  }
  x = std::move(trial);
  return report;
}

/// The same of a whole model: policies that eliminate unknowns are rows here.
template <LinearSolver Solver = DefaultStaticSolver, class M>
EquilibriumReport equilibrium(M const& model, State& x, EquilibriumOptions const& options = {}) {
  System system(model, with<Entries::implicit_step>);
  return equilibrium<Solver>(system, x, options);
}

}  // namespace polybody
