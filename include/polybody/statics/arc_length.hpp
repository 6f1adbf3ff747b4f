#pragma once
/// \file
/// Arc-length method: paths of static equilibria past limit points.
/// Theory: Eqs. 7.20, 7.21.

#include <functional>
#include <limits>
#include <vector>

#include <polybody/run/state_checks.hpp>
#include <polybody/solvers/default_solver.hpp>
#include <polybody/statics/minimum_norm_step.hpp>
#include <polybody/system/make_operations.hpp>

namespace polybody {

/// Options of `equilibrium_path`: step lengths, number of points and Newton iteration.
struct ArcLengthOptions {
  double step = 0.05;       ///< first step, an arc length [1]; the load factor increases by step/√2 at first
  double max_step = 0.05;   ///< largest step, an arc length [1]
  double min_step = 1e-6;   ///< smallest step, an arc length [1]
  int points = 200;         ///< largest number of points
  double tolerance = 1e-9;  ///< largest correction at convergence, relative to 1 + max |q|
  int max_iterations = 12;  ///< largest number of iterations in a step

  /// \throws InvalidInput unless the counts are in [1, 10⁶] and the other numbers are positive and finite.
  void check() const {
    require_positive(step, "equilibrium_path: the step");
    require_positive(max_step, "equilibrium_path: the largest step");
    require_positive(min_step, "equilibrium_path: the smallest step");
    require_count(points, "equilibrium_path: points");
    require_positive(tolerance, "equilibrium_path: the tolerance");
    require_count(max_iterations, "equilibrium_path: max_iterations");
  }
};

/// State in equilibrium under `load_factor` times gravity and loads.
struct PathPoint {
  double load_factor = 0.0;  ///< factor of gravity and all loads
  State x;                   ///< equilibrium under that factor
};

namespace detail {

/// Equations of an equilibrium path at a point, and the tangent (t, t_p) of a step.
template <class Solver>
class PathEquations {
 public:
  /// `start` is in equilibrium without loads. \throws SingularMatrix if the path has no tangent at `start`.
  PathEquations(System& system, PathPoint const& start)
      : system_(system),
        nv_(system.velocities()),
        rows_(system.rows()),
        stiffness_(evaluated(start), start.x.lambda),
        least_(system, stiffness_) {
    if (stiffness_.factor(start.x.lambda) >= 0 || stiffness_.growth() > MinimumNormStep<Solver>::suspicious) {
      takes_least_ = least_.factor(start.x.lambda) < 0 && !least_.pins().empty();
      if (!takes_least_) stiffness_.remove_springs(start.x.lambda);
    }
    if (!solve(start) || !(b_.head(nv_).norm() > 0.0))
      throw SingularMatrix("path.no_direction", {ErrorObject{"equilibrium_path"},
                                                 ": the path has no direction at the start: the stiffness is singular, "
                                                 "or no load acts. Fix every body, and apply a load."});
    c2_ = b_.head(nv_).squaredNorm();
    t_ = b_;
    turn();
  }

  /// Computes the unit tangent from the last solution. The sign is chosen such that the scalar product with the
  /// previous tangent is positive.
  void turn() {
    double tp = 1.0 / std::sqrt(1.0 + b_.head(nv_).squaredNorm() / c2_);
    next_ = b_ * tp;
    if (next_.head(nv_).dot(t_.head(nv_)) / c2_ + tp * tp_ < 0.0) {
      next_ = -next_;
      tp = -tp;
    }
    t_.swap(next_);
    tp_ = tp;
  }
  /// Moves a point along the tangent.
  void predict(PathPoint& point, double length) { move(point, VecX(length * t_), length * tp_); }
  /// Corrects a point by Newton's method in the plane orthogonal to the tangent. Returns the number of iterations, or
  /// −1 if the iterations do not converge or K is singular.
  int correct(PathPoint& trial, ArcLengthOptions const& options) {
    double before = std::numeric_limits<double>::infinity();
    for (int k = 0; k < options.max_iterations; ++k) {
      if (!solve(trial)) return -1;
      double const dp = -(t_.head(nv_).dot(a_.head(nv_)) / c2_) / (t_.head(nv_).dot(b_.head(nv_)) / c2_ + tp_);
      VecX const d = a_ + b_ * dp;
      double const size = d.head(nv_).cwiseAbs().maxCoeff() / (1.0 + trial.x.q.cwiseAbs().maxCoeff());
      if (!(size < 1e3) || (k > 3 && size > before)) return -1;
      move(trial, d, dp);
      if (size <= options.tolerance) return solve(trial) ? k + 1 : -1;
      before = size;
    }
    return -1;
  }

 private:
  System& evaluated(PathPoint const& at) {
    system_.evaluate(at.x.q, at.x.v, at.x.t);
    return system_;
  }
  /// Computes a = −K⁻¹ r and b = −K⁻¹ r_p at a point. Returns false if K is singular. \throws NonFiniteValue.
  bool solve(PathPoint const& at) {
    evaluated(at);
    for (auto const& [factor, out] : {std::pair{0.0, &r0_}, std::pair{1.0, &r1_}, std::pair{at.load_factor, &r_}}) {
      system_.load_factor = factor;
      system_.residual(at.x.a, at.x.lambda, *out);
    }
    system_.violation(phi_);
    if (!r_.allFinite() || !phi_.allFinite())
      throw NonFiniteValue(
          "equilibrium.not_finite",
          {ErrorObject{"equilibrium_path"}, ": a force or constraint function is not finite at load factor ",
           ErrorValue{at.load_factor}, ". Check the forces and the time functions."});
    if ((takes_least_ ? least_.factor(at.x.lambda) : stiffness_.factor(at.x.lambda)) >= 0) return false;
    return solve_for(-r_, -phi_, at, a_) && solve_for(r0_ - r1_, VecX::Zero(rows_), at, b_);
  }
  /// Solves the linear equations. Returns false if a force excites a motion without stiffness.
  bool solve_for(VecX const& f, VecX const& phi, PathPoint const& at, VecX& out) {
    if (takes_least_)
      least_.solve(f, phi, at.x.lambda, out);
    else
      stiffness_.solve(f, phi, out);
    return out.allFinite() && !(takes_least_ && least_.excited() >= 0);
  }
  void move(PathPoint& point, VecX const& by, double load) {
    VecX const dq = by.head(nv_);
    q_ = point.x.q;
    system_.plus(point.x.q, dq, q_);
    point.x.q.swap(q_);
    Index const states = system_.layout().states;
    point.x.v.tail(states) += dq.tail(states);
    point.x.lambda += by.tail(rows_);
    point.load_factor += load;
  }

  System& system_;
  Index nv_, rows_;
  StaticTangent<Solver> stiffness_;
  MinimumNormStep<Solver> least_;
  bool takes_least_ = false;
  VecX r_ = VecX::Zero(nv_), r0_ = r_, r1_ = r_, phi_ = VecX::Zero(rows_), q_;
  VecX a_ = VecX::Zero(nv_ + rows_), b_ = a_;
  VecX t_ = a_, next_ = a_;  ///< (nv + rows)
  double tp_ = 1.0, c2_ = 1.0;
};

}  // namespace detail

/// Follows a path of static equilibria past limit points by the arc-length method [Riks 1979; Crisfield 1991, §9.3].
/// The path begins at `start`, which is in equilibrium without loads and not part of the result. It ends if
/// `done(point)` is true or `options.points` points are computed. The arc length ds is defined by ds² = |dq|²/c² + dp²
/// with c = |dq/dp| at the start of the path.
///
/// The load factor p is an unknown, and the residual r(q, λ, p) is affine in it. Corrections (Δ, Δp) are in the plane
/// orthogonal to the tangent (t, t_p) at the start of the step:
///   K Δ = −r − r_p Δp,  a = −K⁻¹ r,  b = −K⁻¹ r_p,  Δp = −t·a / (t·b + t_p),  Δ = a + b Δp.
/// If the path starts with redundant constraints or with free motions that no load excites, a and b are solutions of
/// minimum norm.
/// \throws NewtonConvergenceFailure naming the load factor if a step would be shorter than `min_step`, SingularMatrix
/// if the path has no tangent at the start, NonFiniteValue, InvalidInput for invalid options or a state that does not
/// fit the model.
template <LinearSolver Solver = DefaultStaticSolver>
std::vector<PathPoint> equilibrium_path(System& system, State const& start, ArcLengthOptions const& options = {},
                                        std::function<bool(PathPoint const&)> const& done = {}) {
  options.check();
  require_usable(system, start);
  PathPoint now{0.0, start};
  now.x.v.head(now.x.v.size() - system.layout().states).setZero();
  now.x.a.setZero();
  detail::PathEquations<Solver> equations(system, now);
  std::vector<PathPoint> path;
  double length = std::min(options.step, options.max_step);
  while (int(path.size()) < options.points) {
    PathPoint trial = now;
    equations.predict(trial, length);
    int const iterations = equations.correct(trial, options);
    if (iterations < 0) {
      length *= 0.5;
      if (length < options.min_step)
        throw NewtonConvergenceFailure(
            "equilibrium.not_converged",
            {ErrorObject{"equilibrium_path"}, ": Newton's method did not converge beyond load factor ",
             ErrorValue{now.load_factor},
             ". A bifurcation may be near: give the structure an imperfection, or end the path earlier."});
      continue;
    }
    equations.turn();
    now = trial;
    path.push_back(now);
    if (done && done(now)) break;
    if (iterations <= 5) length = std::min(1.5 * length, options.max_step);
  }
  return path;
}

/// Path of static equilibria of `model` from `start`, with the conditions and exceptions of the overload for `System`.
template <LinearSolver Solver = DefaultStaticSolver, class M>
std::vector<PathPoint> equilibrium_path(M const& model, State const& start, ArcLengthOptions const& options = {},
                                        std::function<bool(PathPoint const&)> const& done = {}) {
  System system(model, with<Capabilities::implicit_step>);
  return equilibrium_path<Solver>(system, start, options, done);
}

}  // namespace polybody
