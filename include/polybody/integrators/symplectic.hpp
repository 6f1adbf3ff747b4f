#pragma once
/// \file
/// Explicit methods with bounded energy error: `SymplecticEuler`, `Rattle` and `CentralDifference`. They are symplectic
/// if coordinates form a vector space, the mass is constant and forces depend on positions only (planar rigid bodies,
/// cables, springs). Rigid bodies in space rotate by `FreeRotations`: reversible in time, with the energy of a free
/// rotation conserved. Other bodies that rotate in space, and damped forces, are integrated with the same order, but
/// without a bound of the energy error.
/// Theory: Eqs. 6.33 to 6.37.

#include <polybody/integrators/free_rotations.hpp>
#include <polybody/integrators/stabilisation.hpp>

namespace polybody {

/// Symplectic Euler method,
///   v₁ = v₀ + h v̇₀,  q₁ = q₀ ⊞ h v₁,
/// of order one, with one evaluation per step [Hairer, Lubich & Wanner 2006, §I.1.2].
struct SymplecticEuler {
  static constexpr char const* name = "SymplecticEuler";
  static constexpr int order = 1;
  static constexpr bool accepts_constraints = false;
  static constexpr bool needs_constant_mass = true;
  static constexpr double stability_limit = 2.0;  ///< largest stable ωh [1]
  /// Largest stable step: beyond ω²h² + 2dh = 4, with d = `rate` [1/s] and ω = `omega` [rad/s], an amplification factor
  /// lies below −1.
  static double stable_step(double omega, double rate) {
    return 4.0 / (rate + std::sqrt(rate * rate + 4.0 * omega * omega));
  }

  void check() const {}
  template <class Solver>
  auto workspace(System& system) const {
    return detail::RotatingStep<Solver>(system);
  }
  template <class W>
  void start(System& system, State& x, double, W& w) const {
    w.forward.accelerations(system, {x.q, x.v, x.t}, x.a, x.lambda);
  }
  template <class W>
  StepReport step(System& system, State& x, double h, W& w) const {
    w.find_applied(x);
    w.v = x.v + h * w.applied;
    w.dq = h * w.v;
    w.move(system, x, x.t + h);
    w.forward.accelerations(system, {w.q, w.v, x.t + h}, w.a, w.lambda);
    StepReport const report{.taken = h, .next = h, .factorisations = 1, .evaluations = 1};
    w.accept(system, x, h, report);
    return report;
  }
};

/// RATTLE method, of order two [Andersen 1983; Hairer, Lubich & Wanner 2006, §VII.1.4]:
///   v½ = v₀ + ½h M⁻¹(f₀ − G₀ᵀλ),  q₁ = q₀ ⊞ h v½,   λ such that Φ(q₁) = 0,
///   v₁ = v½ + ½h M⁻¹(f₁ − G₁ᵀμ),                    μ such that G₁ v₁ + Φ_t = 0.
/// Newton's method solves for λ with the matrix at q₀ in all iterations, so that every correction of h v½ lies along
/// M⁻¹G₀ᵀ. Forces at t₁ are evaluated with the velocities v½ + ½h v̇₀.
struct Rattle {
  static constexpr char const* name = "Rattle";
  static constexpr int order = 2;
  static constexpr bool accepts_constraints = true;
  static constexpr bool needs_constant_mass = true;
  static constexpr double stability_limit = 2.0;  ///< largest stable ωh [1]
  static double stable_step(double omega, double rate) { return verlet_stability_limit(omega, rate); }

  double tolerance = 1e-12;  ///< tolerance of Φ, relative to 1 + max |q|
  /// Limit of iterations. Each iteration multiplies Φ by about ωh, with the angular frequency ω of the motion.
  int max_iterations = 50;

  /// Memory of a step, allocated once.
  template <class Solver>
  struct Workspace : detail::RotatingStep<Solver> {
    VecX change, phi;  ///< correction of dq (nv); Φ
    VecX moved;        ///< h v½ with the rotation vectors of free rotations
    /// Allocates all members.
    explicit Workspace(System& s)
        : detail::RotatingStep<Solver>(s), change(this->v), phi(this->lambda), moved(this->v) {}
  };

  void check() const {
    require_positive(tolerance, "Rattle: the tolerance");
    require_count(max_iterations, "Rattle: max_iterations");
  }
  template <class Solver>
  Workspace<Solver> workspace(System& system) const {
    return Workspace<Solver>(system);
  }
  template <class W>
  void start(System& system, State& x, double, W& w) const {
    w.forward.accelerations(system, {x.q, x.v, x.t}, x.a, x.lambda);
  }

  /// Performs one step of h [s]. \throws NewtonConvergenceFailure if the positions do not converge to Φ = 0.
  template <class W>
  StepReport step(System& system, State& x, double h, W& w) const {
    w.find_applied(x);
    w.dq = h * x.v + (0.5 * h * h) * w.applied;
    move(system, x, h, w);
    StepReport report{.taken = h, .next = h, .factorisations = 1, .evaluations = 1};
    if (system.rows() > 0) {
      report.factorisations = 3;
      report.iterations = detail::count_if_failed(
          w.check.failed, {.iterations = max_iterations, .factorisations = 1, .evaluations = max_iterations + 1},
          [&] { return close(system, x, h, w); });
    }
    w.dq /= h;  // v½
    w.rotations.carry(w.moved, w.dq);
    w.v = w.dq + 0.5 * h * w.applied;
    w.forward.accelerations(system, {w.q, w.v, x.t + h}, w.a, w.lambda);
    w.rotations.add_gyroscopic(w.v, w.a);
    w.v = w.dq + 0.5 * h * w.a;
    w.forward.project_velocities(system, w.q, w.v, x.t + h);
    w.rotations.subtract_gyroscopic(w.v, w.a);
    w.accept(system, x, h, report);
    return report;
  }

 private:
  /// Computes q = q₀ ⊞ dq after the free rotations.
  template <class W>
  static void move(System& system, State const& x, double h, W& w) {
    w.moved = w.dq;
    w.rotations.find_rotations(system, x.t + h, w.moved);
    system.plus(x.q, w.moved, w.q);
  }
  /// Moves dq along M⁻¹G₀ᵀ until Φ(q₀ ⊞ dq) = 0. Returns the number of corrections.
  template <class W>
  int close(System& system, State const& x, double h, W& w) const {
    double const enough = tolerance * (1.0 + x.q.cwiseAbs().maxCoeff());
    w.forward.hold(system, x.q, x.v, x.t);
    for (int k = 0; k <= max_iterations; ++k) {
      system.evaluate(w.q, x.v, x.t + h);
      system.violation(w.phi);
      if (w.phi.cwiseAbs().maxCoeff() <= enough) return k;
      w.forward.least_change(system, w.phi, w.change);
      w.dq += w.change;
      move(system, x, h, w);
    }
    throw NewtonConvergenceFailure(
        "projection.not_converged",
        {ErrorObject{"Rattle"},
         ": the projection of the positions onto the constraint equations does not converge at t = ",
         ErrorTime{x.t + h}, " s. Take a smaller step."});
  }
};

/// Explicit central differences in their one-step form,
///   v½ = v₀ + ½h v̇₀,  q₁ = q₀ ⊞ h v½,  v̇₁ = accelerations(q₁, v½ + ½h v̇₀),  v₁ = v½ + ½h v̇₁,
/// of order two, stable without damping for h < 2/ω_max [Hughes 2000, §9.1]. Rigid bodies in space rotate by
/// `FreeRotations` between the half steps of v, so the energy of a freely rotating body is conserved.
template <class Stabilisation = UnconstrainedOnly>
struct CentralDifference {
  static constexpr char const* name = "CentralDifference";
  static constexpr int order = 2;
  static constexpr bool accepts_constraints = Stabilisation::accepts_constraints;
  static constexpr double stability_limit = 2.0;  ///< largest stable ωh [1]
  static double stable_step(double omega, double rate) { return verlet_stability_limit(omega, rate); }

  Stabilisation stabilisation = {};  ///< constraint stabilisation

  /// Memory of a step, allocated once.
  template <class Solver>
  struct Workspace : detail::RotatingStep<Solver> {
    typename Stabilisation::Scratch scratch;  ///< memory of the stabilisation
    VecX half;                                ///< v½ after the free rotations
    /// Allocates all members.
    explicit Workspace(System& s) : detail::RotatingStep<Solver>(s), scratch(s), half(this->v) {}
  };

  void check() const { stabilisation.check(); }
  template <class Solver>
  Workspace<Solver> workspace(System& system) const {
    return Workspace<Solver>(system);
  }
  template <class W>
  void start(System& system, State& x, double, W& w) const {
    stabilisation.start(w.scratch);
    w.forward.accelerations(system, {x.q, x.v, x.t}, x.a, x.lambda, stabilisation.feedback());
  }
  template <class W>
  StepReport step(System& system, State& x, double h, W& w) const {
    w.find_applied(x);
    w.v = x.v + 0.5 * h * w.applied;
    w.dq = h * w.v;
    w.move(system, x, x.t + h);
    w.half = w.v;
    w.v += 0.5 * h * w.applied;  // predicted, for velocity-dependent forces
    stabilisation.apply(system, w.forward, w.scratch, w.q, w.v, x.t + h);
    w.forward.accelerations(system, {w.q, w.v, x.t + h}, w.a, w.lambda, stabilisation.feedback());
    w.rotations.add_gyroscopic(w.v, w.a);
    if (w.rotations.empty())
      w.v = x.v + 0.5 * h * (x.a + w.a);
    else
      w.v = w.half + 0.5 * h * w.a;
    stabilisation.velocities(system, w.forward, w.scratch, w.q, w.v, x.t + h);
    w.rotations.subtract_gyroscopic(w.v, w.a);
    StepReport const report{.taken = h, .next = h, .factorisations = 1, .evaluations = 1};
    w.accept(system, x, h, report);
    return report;
  }
};

}  // namespace polybody
