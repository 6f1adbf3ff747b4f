#pragma once
/// \file
/// Small vibrations about a steady rotation.
/// Theory: Eqs. 7.25, 11.9, 11.10.

#include <polybody/solvers/newton.hpp>
#include <polybody/statics/equilibrium_options.hpp>
#include <polybody/vibration/modes.hpp>

namespace polybody {

/// Steady rotation of a whole model with the angular velocity Ω about an axis fixed in the world. With small vibrations
/// ε superposed on the rotation g(t), the coordinates are q(t) = g(t)·(q₀ ⊞ ε(t)). The rotation at q has the
/// generalised velocities w(q). The rotation g transforms the velocities of a body by a linear map that does not depend
/// on q and has the generator
///   Γξ = Dw ξ − c(w, ξ),   c(δ, v) = d/ds (local_rate(s δ, v) − local_rate(−s δ, v)) at s = 0,
/// with the commutator c of the local coordinates. (Positions and gradients: Γ = Dw = Ω×, c = 0. Angular velocities in
/// body axes: Γ = 0, Dw ξ = w × ξ = c.) At t = 0, to first order in ε,
///   v = w(q₀ ⊞ ε) + ε˙,   v˙ = Γ w(q₀ ⊞ ε) + (Γ + Dw) ε˙ + ε¨.
/// The linearised residual R = M v˙ − f + Gᵀλ then has constant coefficients [Simo, Lewis & Marsden 1991]:
///   M ε¨ + (D + M (Γ + Dw)) ε˙ + K ε + Gᵀμ = 0,  G ε = 0,
///   D = −∂f/∂v,   K = ∂/∂ε R(q₀ ⊞ ε, w(q₀ ⊞ ε), Γ w(q₀ ⊞ ε)).
/// The term M (Γ + Dw) contains Coriolis and gyroscopic forces. K contains the centrifugal forces and the geometric
/// stiffness of the stress that they cause.
struct SteadyRotation {
  Vec3 angular_velocity = Vec3::Zero();  ///< (3) Ω, world axes [rad/s]
  Vec3 point = Vec3::Zero();             ///< (3) point on the axis, world axes [m]
};

namespace detail {

/// Residual and stiffness of a model in a frame that rotates with the model. The derivatives of static terms are exact.
/// Terms due to the rotation are differentiated by finite differences of fourth order, with steps of 1e-3 [m], [rad].
template <class = void>  // compiled where it is used
class TurningFrame {
 public:
  System& system;
  double share = 1.0;  ///< applied fraction of the angular velocity

  TurningFrame(System& of, VecX const& q, SteadyRotation const& rotation)
      : system(of),
        rotation_(rotation),
        none_(VecX::Zero(system.velocities())),
        no_row_(VecX::Zero(system.rows())),
        w_(none_),
        a_(none_),
        at_(q) {
    require_finite(rotation.angular_velocity, "SteadyRotation: the angular velocity");
    require_finite(rotation.point, "SteadyRotation: the point of the axis");
    if (system.layout().states > 0)
      throw InvalidInput(
          "steady_rotation.first_order_states",
          {ErrorObject{"SteadyRotation"}, ": models with first-order states are not supported, but there are ",
           ErrorValue{system.layout().states}, "."});
    for (BodyLayout const& body : system.layout().bodies)
      if (body.planar && !rotation.angular_velocity.head<2>().isZero(0.0))
        throw InvalidInput("steady_rotation.axis", {"SteadyRotation: body \"", ErrorObject{body.name},
                                                    "\" is planar, so the axis must be parallel to z."});
    gradient_ = by_velocities(q, [&](VecX const& at, VecX& w) { velocities(at, w); });
    generator_ = gradient_;
    double const s = 1e-3 / std::max(rotation.angular_velocity.norm(), 1e-3);
    VecX w(none_), there(none_), back(none_), one(none_);
    velocities(q, w);
    for (Index j = 0; j < one.size(); ++j) {
      one[j] = 1.0;
      system.local_rate(s * w, one, there);
      system.local_rate(-s * w, one, back);
      generator_.col(j) -= (there - back) / s;
      one[j] = 0.0;
    }
  }

  /// Generalised velocities w(q) of the rotation.
  void velocities(VecX const& q, VecX& w) const {
    Vec3 const omega = share * rotation_.angular_velocity, origin = rotation_.point.cross(omega);
    system.operations().rigid_velocities(q, origin, omega, w);
  }
  /// Computes the residual R(q, w, Γw) with the multipliers `lambda`. The last evaluation of the system is then at (q,
  /// w, t).
  void residual(VecX const& q, VecX const& lambda, double t, VecX& r) {
    velocities(q, w_);
    a_.noalias() = share * generator_ * w_;
    system.evaluate(q, w_, t);
    system.residual(a_, lambda, r);
  }
  /// Matrix [K, Gᵀ; G, 0] at x.
  MatX stiffness(State const& x) {
    system.evaluate(x.q, none_, x.t);
    MatX k = dense_tangent(system, {.stiffness = 1.0}, x.lambda);
    VecX rest(none_);
    k.topLeftCorner(none_.size(), none_.size()) += by_velocities(x.q, [&](VecX const& q, VecX& r) {
      residual(q, no_row_, x.t, r);
      system.evaluate(q, none_, x.t);
      system.residual(none_, no_row_, rest);
      r -= rest;
    });
    return k;
  }
  /// Dw + Γ at the full angular velocity and the initial q.
  MatX rate_matrix() const { return gradient_ + generator_; }
  MatX const& generator() const { return generator_; }

  /// Checks that the constraint equations rotate with the model: Φ˙ = G w + Φ_t = 0. \throws InvalidInput otherwise.
  void require_turning_rows(State const& x) {
    VecX rate(no_row_);
    velocities(x.q, w_);
    system.evaluate(x.q, w_, x.t);
    system.violation_rate(rate);
    Index i = 0;
    if (rate.size() && !(rate.cwiseAbs().maxCoeff(&i) <= 1e-8 * w_.cwiseAbs().maxCoeff()))
      throw InvalidInput("steady_rotation.joint",
                         {"SteadyRotation: ", ErrorObject{system.name_of(system.velocities() + i)},
                          " does not rotate with the model (its constraint violation grows by ", ErrorValue{rate[i]},
                          " m or rad per second). Align the joint with the axis of rotation; set a drive to the rate "
                          "of the rotation."});
  }

 private:
  /// Derivative ∂f/∂ε (nv×nv) of f(q ⊞ ε) at ε = 0, by finite differences: (8 (f(h) − f(−h)) − (f(2h) − f(−2h)))/12h.
  template <class F>
  MatX by_velocities(VecX const& q, F&& f) {
    double const h = 1e-3;
    Index const n = none_.size();
    MatX slopes = MatX::Zero(n, n);
    VecX step(none_), value(none_);
    for (Index j = 0; j < n; ++j) {
      for (auto const& [steps, weight] : {std::pair{-2.0, 1.0}, {-1.0, -8.0}, {1.0, 8.0}, {2.0, -1.0}}) {
        step[j] = steps * h;
        system.plus(q, step, at_);
        f(at_, value);
        slopes.col(j) += (weight / (12.0 * h)) * value;
      }
      step[j] = 0.0;
    }
    return slopes;
  }

  SteadyRotation rotation_;
  VecX none_, no_row_, w_, a_, at_;
  MatX gradient_, generator_;
};

/// Equations of a steady rotation for Newton's method, at a fraction of the angular velocity.
template <class = void>  // compiled where it is used
struct TurningEquilibrium {
  TurningFrame<> frame;
  State trial;
  double tolerance, unit = 1.0;  ///< unit: factor of the constraint equations, equal to the largest entry of K
  Index nv = trial.v.size(), rows = trial.lambda.size();
  MatX k = {};
  VecX r = VecX::Zero(nv), phi = VecX::Zero(rows), rhs = VecX::Zero(nv + rows), y = rhs, q = trial.q;

  bool evaluate() {
    frame.residual(trial.q, trial.lambda, trial.t, r);
    frame.system.violation(phi);
    rhs << -r, -phi;
    return rhs.allFinite();
  }
  bool refactor() {
    k = frame.stiffness(trial);
    if (!k.allFinite()) return false;
    double const largest = k.topLeftCorner(nv, nv).cwiseAbs().maxCoeff();
    unit = largest > 0.0 ? largest : 1.0;
    k.bottomRows(rows) *= unit;
    k.rightCols(rows) *= unit;
    return true;
  }
  double solve() {
    rhs.tail(rows) *= unit;
    y = smallest_solution(k, rhs, 1e-12);
    y.tail(rows) *= unit;
    return y.head(nv).cwiseAbs().maxCoeff() / (tolerance * (1.0 + trial.q.cwiseAbs().maxCoeff()));
  }
  void apply() {
    frame.system.plus(trial.q, y.head(nv), q);
    trial.q.swap(q);
    trial.lambda += y.tail(rows);
  }

  /// Checks that no force acts along a motion without stiffness: minimum-norm corrections cannot remove such a force.
  /// \throws SingularMatrix otherwise.
  void require_balance() {
    evaluate();
    double const load = rows ? (k.topRightCorner(nv, rows) * (trial.lambda / unit)).cwiseAbs().maxCoeff() : 0.0;
    double const small = 1e-6 * load + (tolerance + 1e-12) * unit * (1.0 + trial.q.cwiseAbs().maxCoeff());
    Index i = 0;
    if (!(r.cwiseAbs().maxCoeff(&i) <= small))
      throw SingularMatrix("equilibrium.singular",
                           {"relative_equilibrium: nothing resists a motion of ", ErrorObject{frame.system.name_of(i)},
                            " that forces excite as the model rotates (remaining force ", ErrorValue{r[i]},
                            "). Constrain this motion or add stiffness."});
  }

  /// Throws the error of a failed iteration. \throws NewtonConvergenceFailure if `result` is `diverged`, otherwise
  /// NonFiniteValue.
  [[noreturn, gnu::cold]] void refuse(NewtonResult result) const {
    std::string const at = sentence_of({" at ", frame.share, " times the angular velocity"});
    if (result != NewtonResult::diverged)
      throw NonFiniteValue("equilibrium.not_finite", {ErrorObject{"relative_equilibrium"}, ": a force is not finite",
                                                      at, ". Check the forces and the initial state."});
    throw NewtonConvergenceFailure(
        "equilibrium.not_converged",
        {ErrorObject{"relative_equilibrium"}, ": Newton's method did not converge", at,
         ". Use more load steps or start closer to the solution; beyond a critical speed there may be no solution."});
  }
};

}  // namespace detail

/// State x in steady rotation: v = w(q), a = Γw; coordinates and multipliers are those of x. \throws InvalidInput for
/// planar bodies if the axis is not parallel to z, and for models with first-order states.
template <class = void>
State rotating_state(System& system, State const& x, SteadyRotation const& rotation) {
  require_usable(system, x);
  detail::TurningFrame<> const frame(system, x.q, rotation);
  State out = x;
  frame.velocities(x.q, out.v);
  out.a = frame.generator() * out.v;
  return out;
}

/// Moves x (coordinates, multipliers) into relative equilibrium, in which elastic, centrifugal and all other forces
/// balance during steady rotation. The velocities and accelerations of x become those of the rotation. Constraint
/// equations that depend on time are evaluated at x.t. The options `load_steps` and `min_load_step` apply to Ω instead
/// of the loads. Corrections have minimum norm if constraints are redundant or a motion has no stiffness. The solver is
/// dense, for models of up to some hundred generalised velocities.
/// \throws InvalidInput if constraint equations do not rotate with the model; SingularMatrix if a force on a body acts
/// along a motion without stiffness; NewtonConvergenceFailure; NonFiniteValue. After an exception x is unchanged.
template <class = void>
EquilibriumReport relative_equilibrium(System& system, State& x, SteadyRotation const& rotation,
                                       EquilibriumOptions const& options = {}) {
  options.check();
  require_usable(system, x);
  detail::TurningEquilibrium<> problem{.frame = {system, x.q, rotation}, .trial = x, .tolerance = options.tolerance};
  NewtonOptions const newton_options{.max_iterations = options.max_iterations, .always_refactor = true};
  EquilibriumReport report;
  report.negative_pivots = -1;
  for (LoadSteps steps(options); !steps.done();) {
    State const before = problem.trial;
    problem.frame.share = steps.next();
    ReusedFactorisation reused;
    NewtonReport const n = newton(problem, newton_options, reused);
    report.iterations += n.iterations;
    if (n.result == NewtonResult::converged) {
      steps.reach_next();
      ++report.load_steps;
      continue;
    }
    problem.trial = before;
    if (!steps.halve()) problem.refuse(n.result);
  }
  problem.frame.require_turning_rows(problem.trial);
  problem.require_balance();
  warn_of_units(system, report.warnings);
  x = rotating_state(system, problem.trial, rotation);
  return report;
}

/// Linearisation about x in steady rotation; coordinates, multipliers and time of x are used. `damped_modes` of the
/// result computes the motions ε = Re(shape e^{st}) relative to the rotating model. \throws InvalidInput if forces do
/// not balance at x, or if forces or constraint equations do not rotate with the model. Gravity perpendicular to the
/// axis does not rotate with the model.
template <class = void>
Linearisation linearise(System& system, State const& x, SteadyRotation const& rotation) {
  require_usable(system, x);
  detail::TurningFrame<> frame(system, x.q, rotation);
  frame.require_turning_rows(x);
  Index const nv = system.velocities(), rows = system.rows();
  MatX const k = frame.stiffness(x);
  Linearisation l;
  l.K = k.topLeftCorner(nv, nv);
  l.G = k.bottomLeftCorner(rows, nv);
  l.N = detail::free_motions(l.G);
  VecX w(nv), r(nv);
  frame.velocities(x.q, w);
  frame.residual(x.q, x.lambda, x.t, r);
  l.M = detail::dense_tangent(system, {.mass = 1.0}, x.lambda).topLeftCorner(nv, nv);
  l.D = detail::dense_tangent(system, {.damping = 1.0}, x.lambda).topLeftCorner(nv, nv) + l.M * frame.rate_matrix();

  // the tolerance is relative to the inertia and constraint forces, plus the round-off of the stiffness
  double const omega = rotation.angular_velocity.norm();
  double const pull = rows ? (l.G.transpose() * x.lambda).cwiseAbs().maxCoeff() : 0.0;
  double const small = 1e-6 * (omega * (l.M * w).cwiseAbs().maxCoeff() + pull) +
                       1e-13 * l.K.cwiseAbs().maxCoeff() * (1.0 + x.q.cwiseAbs().maxCoeff());
  Index i = 0;
  if (!(r.cwiseAbs().maxCoeff(&i) <= small))
    throw InvalidInput("steady_rotation.unbalanced",
                       {"linearise: forces on ", ErrorObject{system.name_of(i)},
                        " do not balance as the model rotates (remaining force ", ErrorValue{r[i]},
                        "). Take the state from relative_equilibrium(model, x, rotation)."});
  // K w is the rate of R during the rotation; its component along permitted motions must be zero
  VecX const turned = l.N * (l.N.transpose() * (l.K * w));
  if (!(turned.cwiseAbs().maxCoeff(&i) <= small * omega))
    throw InvalidInput(
        "steady_rotation.force",
        {"linearise: forces on ", ErrorObject{system.name_of(i)},
         " do not rotate with the model, for example gravity perpendicular to the axis. A steady rotation does not "
         "exist."});
  return l;
}

namespace detail {
template <class M>
System turning_system(M const& model) {
  return System(model, with < Capabilities::implicit_step | Capabilities::rigid_velocities >);
}
}  // namespace detail

/// Overload for a model.
template <class M>
State rotating_state(M const& model, State const& x, SteadyRotation const& rotation) {
  System system = detail::turning_system(model);
  return rotating_state(system, x, rotation);
}
/// Overload for a model.
template <class M>
EquilibriumReport relative_equilibrium(M const& model, State& x, SteadyRotation const& rotation,
                                       EquilibriumOptions const& options = {}) {
  System system = detail::turning_system(model);
  return relative_equilibrium(system, x, rotation, options);
}
/// Overload for a model.
template <class M>
Linearisation linearise(M const& model, State const& x, SteadyRotation const& rotation) {
  System system = detail::turning_system(model);
  return linearise(system, x, rotation);
}

}  // namespace polybody
