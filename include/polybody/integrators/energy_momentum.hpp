#pragma once
/// \file
/// Energy-conserving and energy-decaying integrators, `EnergyMomentum` and `EnergyDecaying`, with their common step.
/// Theory: Eqs. 6.17, 6.19 to 6.21, 6.39 to 6.43.

#include <polybody/integrators/newton_failure.hpp>
#include <polybody/integrators/step_history.hpp>
#include <polybody/system/step_secants.hpp>

namespace polybody {

// Steps that conserve energy and momenta, and steps that dissipate energy, for a constant mass matrix M and
// coordinates that form a vector space, or that are frames (bodies/shared/frame_secants.hpp):
//   M Δv = h (f̄ − Ḡᵀλ),   Δq = h (v̄ + χ Δv),   Φ(q₁) = 0,   v̄ = ½ (v₀ + v₁).
// f̄ and Ḡ are discrete gradients [Gonzalez 1996, 1999], computed by secants (math/secant.hpp) of strains ε,
// constraint functions Φ and potentials. With the stored energy V and the elastic stiffness C,
//   f̄·Δq = −ΔV − χ ΔεᵀCΔε − (damping) + (work of the loads),   Ḡ Δq = ΔΦ = 0 (no drives).
// Hence, for the kinetic energy T, ΔT = v̄ᵀMΔv = (Δq/h − χ Δv)ᵀMΔv and
//   ΔT + ΔV = −χ (ΔvᵀMΔv + ΔεᵀCΔε) − (damping) + (work of the loads).
// With χ = 0, energy is conserved without damping, loads and drives. The linear momentum changes by the impulse of the
// loads for every χ. The angular momentum changes by the angular impulse of the loads if χ = 0 and if f̄ and Ḡ exert no
// net moment. This condition holds for functions of scalar products of coordinates: ANCF cables and the ANCF beam of
// `Continuum`, springs, joints between points on their axes, and all joints between frames (`Rigid<>`, `Lrvf`,
// `Se3Beam`). With angles as coordinates, section frames (`ElasticLine`) and joints of their axes, energy is also
// conserved, but angular momentum only to the order of the method. This also holds for dampers at points outside of
// the origin of a frame.
// First-order states with the rates ż(q, v, z, t) use the midpoint rule, Δz = h ż(q̄, v̄, z̄, t̄).

/// Step with the parameter χ, which conserves or dissipates energy. `State::a` and `State::lambda` after a step are
/// values at the middle of the step. With χ = 0, λ alternates by O(h) about the reaction, and the mean over two steps
/// has an error of O(h²).
struct ConservingStep {
  char const* name;      ///< name of the integrator in messages
  double chi;            ///< χ [1]: 0 conserves energy, ½ dissipates most
  double tolerance;      ///< tolerance of Newton's corrections, relative to the accelerations
  NewtonOptions newton;  ///< options of Newton's method

  /// Memory of a step, allocated once.
  template <class Solver>
  struct Workspace {
    VecX q, v, vd, lambda, r, phi, rhs, y, kept;  ///< in order: q, v, v̇, λ, r, Φ, −(r, Φ/s), two corrections
    VecX other_vd, other_lambda;                  ///< result of the second attempt, during the third
    StepSecants secants;                          ///< mean forces and constraint Jacobian of the step
    TangentSolver<StepSolver<Solver>> solver;     ///< solver of the tangent of `secants`
    TangentSolver<StepSolver<UnsymmetricSolver<Solver>>> exact;  ///< solver of the exact tangent
    ForwardDynamics<Solver> forward;           ///< solver of [M, Gᵀ; G, 0]: accelerations at the start
    StepCheck check;                           ///< checks of the steps of a run
    ReusedFactorisation reused_factorisation;  ///< state of the reused factorisation of the tangent
    bool has_exact = false;                    ///< true if `exact` is analysed
    double h_factored = 0.0;                   ///< step length of the last factorisation of the tangent [s]

    /// Allocates all members except `exact`.
    explicit Workspace(System& s)
        : q(VecX::Zero(s.coordinates())),
          v(VecX::Zero(s.velocities())),
          vd(v),
          lambda(VecX::Zero(s.rows())),
          r(v),
          phi(lambda),
          rhs(VecX::Zero(s.size())),
          y(rhs),
          kept(rhs),
          other_vd(v),
          other_lambda(lambda),
          secants(s),
          forward(s) {}
  };

  template <class Solver>
  Workspace<Solver> workspace(System& system) const {
    return Workspace<Solver>(system);
  }

  /// Computes consistent v̇ and λ at x, and clears the history of earlier steps.
  template <class Solver>
  void start(System& system, State& x, double h, Workspace<Solver>& w) const {
    w.forward.accelerations(system, {x.q, x.v, x.t}, x.a, x.lambda);
    StepHistory::reset(x);
    w.secants.evaluate(system, {&x.q, &x.q, x.t, h, chi, &x.v, &x.a});
    w.solver.analyse(system, 1, [&](BlockSink& sink) { w.secants.tangent(system, scale(h), sink); });
    if (w.forward.leaves_out()) w.solver.mark_redundant(w.forward.left_out());
    w.reused_factorisation.usable = false;
    (void)refactor(system, h, w);  // so that the elimination order does not change within the first step
  }

  /// Performs one step; x changes only if Newton's method converges.
  template <class Solver>
  StepReport step(System& system, State& x, double h, Workspace<Solver>& w) const {
    return advance(system, x, h, w);
  }

 private:
  /// Factor s [s²] in Δq = h v₀ + s a, with Δv = h a.
  double scale(double h) const { return (0.5 + chi) * h * h; }

  template <class Solver>
  Index refactor(System& system, double h, Workspace<Solver>& w) const {
    w.h_factored = h;
    return w.solver.factor([&](BlockSink& sink) { w.secants.tangent(system, scale(h), sink); });
  }

  /// Equations of one step, as a problem of Newton's method.
  template <class Solver>
  struct Problem {
    ConservingStep const& method;
    System& system;
    State const& x;
    Workspace<Solver>& w;
    double h, s;  ///< h [s]; s of the tangent M + s K̄ [s²]
    Index nv, rows;
    bool exact;
    Index bad = -1;

    SecantStep secant() const { return {&x.q, &w.q, x.t, h, method.chi, &x.v, &w.vd}; }
    void move() { w.secants.move(secant(), w.q); }
    bool evaluate() {
      move();
      return evaluate_here();
    }
    bool evaluate_here() {
      w.secants.evaluate(system, secant());
      w.secants.residual(system, w.vd, w.lambda, w.r);
      w.secants.violation(w.phi);
      for (Index i = 0; i < nv; ++i) w.rhs[i] = -w.r[i];
      for (Index i = 0; i < rows; ++i) w.rhs[nv + i] = w.phi[i] / -s;
      return all_finite(w.rhs);
    }
    bool refactor() {
      auto const write = [&](BlockSink& sink) { w.secants.exact_tangent(system, secant(), s, w.lambda, sink); };
      if (exact && !w.has_exact) w.exact.analyse(system, 1, write);
      if (exact && !w.has_exact && w.forward.leaves_out()) w.exact.mark_redundant(w.forward.left_out());
      w.has_exact = w.has_exact || exact;
      bad = exact ? w.exact.factor(write) : method.refactor(system, h, w);
      return bad < 0;
    }
    CorrectionSize solve() {
      exact ? w.exact.solve(w.rhs, w.y) : w.solver.solve(w.rhs, w.y);
      return measure();
    }
    CorrectionSize measure() const {
      Index const bodies = nv - system.layout().states;
      double const n = std::sqrt(double(std::max<Index>(bodies, 1)));
      CorrectionSize const size{
          all_finite(w.y) ? w.y.head(bodies).norm() / n : std::numeric_limits<double>::quiet_NaN(),
          method.tolerance * (1.0 + w.vd.head(bodies).norm() / n) + detail::rounding_of(w.q, s)};
      return detail::StatesInStep{system.layout().states, w.v, w.vd, h}.join(size, method.tolerance, w.y.data());
    }
    void apply() {
      for (Index i = 0; i < nv; ++i) w.vd[i] += w.y[i];
      for (Index i = 0; i < rows; ++i) w.lambda[i] += w.y[nv + i];
    }
    bool is_round_off(double norm) {
      if (!detail::may_be_rounding(w.phi, s * norm, x.q)) return false;
      auto const moved = [&] {
        detail::perturb(w.q, w.q, w.q);
        evaluate_here();
        detail::perturb(w.phi, w.q, w.phi);
        for (Index i = 0; i < rows; ++i) w.rhs[nv + i] = w.phi[i] / -s;
        return std::isfinite(solve().norm);
      };
      return detail::is_round_off(w.y, norm, w.kept, moved, [&] { return measure().norm; });
    }
  };

  /// Squared deviation of the velocities from constant acceleration, ‖Δv − h v̇₀‖².
  static double change(State const& x, double h, VecX const& vd) {
    double sum = 0.0;
    for (Index i = 0; i < vd.size(); ++i) sum += (vd[i] - x.a[i]) * (vd[i] - x.a[i]);
    return h * h * sum;
  }
  /// Restores the result of the second attempt, and returns true, if the third attempt `failed` or has a larger
  /// `change` than the second.
  template <class Solver>
  static bool takes_other(State const& x, double h, Workspace<Solver>& w, bool failed) {
    if (!failed && change(x, h, w.vd) <= change(x, h, w.other_vd)) return false;
    w.vd.swap(w.other_vd);
    w.lambda.swap(w.other_lambda);
    return true;
  }

  /// Performs one step from x. If Newton's method does not converge, the second attempt uses full Newton from zero
  /// accelerations. Models with constraint equations have a third attempt. It starts from the last accelerations and
  /// uses the exact tangent, as required near a singular configuration. A step near a singular configuration has one
  /// solution on each branch. If `change` of the second attempt exceeds 0.01 ‖v₀‖², the third also runs, and the
  /// solution with the smaller `change` is accepted.
  template <class Solver>
  StepReport advance(System& system, State& x, double h, Workspace<Solver>& w, int effort = 0,
                     bool has_other = false) const {
    StepHistory history(x);
    bool const careful = effort > 0;
    if (careful) {
      w.vd = x.a;
      if (effort == 1) w.vd.setZero();  // the mean of accelerations that h does not resolve
      w.lambda = x.lambda;
    } else {
      history.extrapolate(x, h, w.vd, w.lambda);
    }
    if (std::abs(h - w.h_factored) > 0.25 * w.h_factored) w.reused_factorisation.usable = false;
    NewtonOptions options = newton;
    options.always_refactor = options.always_refactor || careful;
    if (careful) options.max_growths = 10;
    Problem<Solver> problem{*this, system, x, w, h, scale(h), system.velocities(), system.rows(), effort == 2};
    NewtonReport report = polybody::newton(problem, options, w.reused_factorisation);
    if (effort == 1 && system.rows() > 0 && report.result == NewtonResult::converged &&
        change(x, h, w.vd) > 0.01 * squares(x.v)) {
      w.other_vd.swap(w.vd);
      w.other_lambda.swap(w.lambda);
      w.reused_factorisation.usable = false;
      return detail::retried(w.check.failed, report, [&] { return advance(system, x, h, w, 2, true); });
    }
    if (has_other && takes_other(x, h, w, report.result != NewtonResult::converged)) {
      (void)problem.evaluate();
      report.result = NewtonResult::converged;
    }
    if (report.result != NewtonResult::converged && effort < (system.rows() > 0 ? 2 : 1)) {
      w.reused_factorisation.usable = false;
      return detail::retried(w.check.failed, report, [&] { return advance(system, x, h, w, effort + 1); });
    }
    StepReport const step = detail::report_of(h, report);
    detail::count_if_failed(w.check.failed, step, [&] {
      if (report.result != NewtonResult::converged)
        detail::throw_convergence_failure(name, system, x.t + h, report, {problem.bad, w.rhs, w.y});
      problem.move();
      for (Index i = 0; i < w.v.size(); ++i) w.v[i] = x.v[i] + h * w.vd[i];
      system.push_forces(w.lambda);  // not evaluated by the discrete gradients
      w.check.require_end(system, {w.q, w.v, w.lambda, x.t + h, h});
    });
    if (w.solver.lost_rank() || effort == 2) w.reused_factorisation.usable = false;
    history.push(x, h, w.vd);
    x.q.swap(w.q);
    x.v.swap(w.v);
    x.a.swap(w.vd);
    x.lambda.swap(w.lambda);
    x.t += h;
    return step;
  }
};

/// Energy–momentum method of order two [Simo & Tarnow 1992; Gonzalez 1996], `ConservingStep` with χ = 0. It conserves
/// energy, and is therefore stable, for every h at which Newton's method converges. High modes are not damped. The
/// tolerance of Newton's method determines the errors of energy and momenta. If angles are coordinates, as in the
/// plane, the error of the angular momentum has order two.
struct EnergyMomentum {
  static constexpr char const* name = "EnergyMomentum";
  static constexpr int order = 2;
  static constexpr bool accepts_constraints = true;
  static constexpr Capabilities capabilities = Capabilities::implicit_step | Capabilities::secants;

  double tolerance = 1e-10;                       ///< tolerance of Newton's corrections, relative to the accelerations
  NewtonOptions newton = {.max_iterations = 50};  ///< options of Newton's method

  /// \throws InvalidInput unless the tolerance is positive and the options of `newton` are valid.
  void check() const {
    require_positive(tolerance, "EnergyMomentum: the tolerance");
    newton.check(name);
  }

  ConservingStep method() const { return {name, 0.0, tolerance, newton}; }
};

/// Energy-decaying method, `ConservingStep` with χ = ½ (1 − ρ∞)/(1 + ρ∞): without loads, energy decreases in every step
/// for ρ∞ < 1. The energy of a linear mode decreases by the factor ρ∞² as ωh → ∞. The method has order one for ρ∞ < 1.
/// The dissipation by strains is that of the energy-dissipative momentum-conserving method EDMC-1 [Armero & Romero
/// 2001]. The dissipation by velocities uses the norm of M, so that every mode is damped; the angular momentum is then
/// accurate to first order only. Force elements with a potential do not dissipate energy themselves: the dissipation by
/// velocities damps their motion.
struct EnergyDecaying {
  static constexpr char const* name = "EnergyDecaying";
  static constexpr int order = 1;
  static constexpr bool accepts_constraints = true;
  static constexpr Capabilities capabilities = Capabilities::implicit_step | Capabilities::secants;

  double rho_inf = 0.9;      ///< spectral radius of a strain mode as ωh → ∞, in [0, 1]; 1 conserves energy
  double tolerance = 1e-10;  ///< tolerance of Newton's corrections, relative to the accelerations
  NewtonOptions newton = {.max_iterations = 50};  ///< options of Newton's method

  /// \throws InvalidInput unless 0 ≤ ρ∞ ≤ 1, the tolerance is positive, and the options of `newton` are valid.
  void check() const {
    if (!(rho_inf >= 0.0 && rho_inf <= 1.0))
      throw InvalidInput("integrator.option", {ErrorObject{"EnergyDecaying"}, ": rho_inf must lie in [0, 1], but is ",
                                               ErrorValue{rho_inf}, "."});
    require_positive(tolerance, "EnergyDecaying: the tolerance");
    newton.check(name);
  }

  ConservingStep method() const { return {name, 0.5 * (1.0 - rho_inf) / (1.0 + rho_inf), tolerance, newton}; }
};

}  // namespace polybody
