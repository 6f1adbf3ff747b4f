#pragma once
#include <polybody/integrators/free_rotations.hpp>
#include <polybody/integrators/stabilisation.hpp>

namespace polybody {

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
