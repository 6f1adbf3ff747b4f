#pragma once
/// \file
/// A path of static equilibria past limit points: the load factor p becomes an unknown, and steps have a length along
/// the path [Riks 1979; Crisfield 1991, §9.3]. With r(q, λ, p) = 0 affine in p, K Δ = −r − r_p Δp, corrections stay in
/// the plane normal to the tangent (t, t_p) of the step's start:
///   a = −K⁻¹ r,  b = −K⁻¹ r_p,  Δp = −t·a / (t·b + t_p),  Δ = a + b Δp.

#include <functional>
#include <vector>

#include <polybody/solvers/default_solver.hpp>
#include <polybody/statics/static_tangent.hpp>
#include <polybody/system/model_entries.hpp>

namespace polybody {

struct ArcLengthOptions {
  double step = 0.05;       ///< first length: the load factor it covers at the start
  double largest = 0.05;    ///< no step is longer
  double smallest = 1e-6;   ///< nor shorter
  int points = 200;         ///< at most so many
  double tolerance = 1e-9;  ///< of a correction, relative to 1 + max |q|
  int max_iterations = 12;  ///< in a step
};

/// A state in equilibrium under `load_factor` times gravity and loads.
struct PathPoint {
  double load_factor = 0.0;
  State x;
};

/// Follows the path from x, in equilibrium without loads, until `done(point)` or `options.points`. Lengths are measured
/// by |dq|²/c² + dp², c = |dq/dp| at the start. \throws NewtonStalled naming the load factor where steps have become
/// too short, LinearSolverSingular where not even the start has a tangent, NonFinite.
template <LinearSolver Solver = DefaultStaticSolver>
std::vector<PathPoint> equilibrium_path(System& system, State const& start, ArcLengthOptions const& options = {},
                                        std::function<bool(PathPoint const&)> const& done = {}) {
  require_positive(options.step, "equilibrium_path: the step");
  require_positive(options.smallest, "equilibrium_path: the smallest step");
  Index const nv = system.speeds(), rows = system.rows();
  PathPoint now{0.0, start};
  now.x.v.setZero();
  now.x.a.setZero();
  system.evaluate(now.x.q, now.x.v, now.x.t);
  StaticTangent<Solver> stiffness(system, now.x.lambda);

  VecX r(nv), r0(nv), r1(nv), phi(rows), a(nv + rows), b(nv + rows), q;
  // a = −K⁻¹ r and b = −K⁻¹ r_p at a point; false where K is singular.
  auto const solve = [&](PathPoint const& at) {
    system.evaluate(at.x.q, at.x.v, at.x.t);
    for (auto const& [factor, out] : {std::pair{0.0, &r0}, std::pair{1.0, &r1}, std::pair{at.load_factor, &r}}) {
      system.load_factor = factor;
      system.residual(at.x.a, at.x.lambda, *out);
    }
    system.violation(phi);
    if (!r.allFinite() || !phi.allFinite())
      throw NonFinite("equilibrium_path: a force is not finite at load factor " + number(at.load_factor) + ".");
    if (stiffness.factor(at.x.lambda) >= 0) return false;
    stiffness.solve(-r, -phi, a);
    stiffness.solve(r0 - r1, VecX::Zero(rows), b);
    return a.allFinite() && b.allFinite();
  };
  auto const move = [&](PathPoint& point, VecX const& by, double load) {
    VecX const dq = by.head(nv);
    q = point.x.q;
    system.plus(point.x.q, dq, q);
    point.x.q.swap(q);
    point.x.lambda += by.tail(rows);
    point.load_factor += load;
  };

  if (!solve(now) || !(b.head(nv).norm() > 0.0))
    throw LinearSolverSingular(
        "equilibrium_path: there is no path to follow from here: the stiffness is singular at the start, or "
        "nothing is loaded.");
  double const c2 = b.head(nv).squaredNorm();
  auto const tangent = [&](VecX const& before, double before_p, VecX& t) {  // of unit length, onwards
    double tp = 1.0 / std::sqrt(1.0 + b.head(nv).squaredNorm() / c2);
    t = b * tp;
    if (t.head(nv).dot(before.head(nv)) / c2 + tp * before_p < 0.0) {
      t = -t;
      tp = -tp;
    }
    return tp;
  };
  std::vector<PathPoint> path;
  VecX t = b, next = b;
  double tp = tangent(b, 1.0, next), length = std::min(options.step, options.largest);
  t = next;
  while (int(path.size()) < options.points) {
    PathPoint trial = now;
    move(trial, VecX(length * t), length * tp);
    int iterations = 0;
    bool converged = false;
    for (double before = std::numeric_limits<double>::infinity(); iterations < options.max_iterations && !converged;
         ++iterations) {
      if (!solve(trial)) break;
      double const dp = -(t.head(nv).dot(a.head(nv)) / c2) / (t.head(nv).dot(b.head(nv)) / c2 + tp);
      VecX const d = a + b * dp;
      double const size = d.head(nv).cwiseAbs().maxCoeff() / (1.0 + trial.x.q.cwiseAbs().maxCoeff());
      if (!(size < 1e3) || (iterations > 3 && size > before)) break;
      move(trial, d, dp);
      converged = size <= options.tolerance;
      before = size;
    }
    if (!converged || !solve(trial)) {
      length *= 0.5;
      if (length < options.smallest)
        throw NewtonStalled("equilibrium_path: Newton's method did not converge beyond load factor " +
                            number(now.load_factor) +
                            ". A bifurcation may be near; give the structure an imperfection, or end the path before.");
      continue;
    }
    tp = tangent(t, tp, next);
    t = next;
    now = trial;
    path.push_back(now);
    if (done && done(now)) break;
    if (iterations <= 5) length = std::min(1.5 * length, options.largest);
  }
  return path;
}

template <LinearSolver Solver = DefaultStaticSolver, class M>
std::vector<PathPoint> equilibrium_path(M const& model, State const& start, ArcLengthOptions const& options = {},
                                        std::function<bool(PathPoint const&)> const& done = {}) {
  System system(model, with<Entries::implicit_step>);
  return equilibrium_path<Solver>(system, start, options, done);
}

}  // namespace polybody
