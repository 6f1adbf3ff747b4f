#pragma once
#include <polybody/integrators/explicit_step.hpp>
#include <polybody/integrators/stabilisation.hpp>

namespace polybody {

/// Explicit central differences in their one-step form,
///   v½ = v₀ + ½h v̇₀,  q₁ = q₀ ⊞ h v½,  v̇₁ = accelerations(q₁, v½ + ½h v̇₀),  v₁ = v½ + ½h v̇₁,
/// of order two, stable for h < 2/ω_max [Hughes 2000, §9.1].
template <class Stabilisation = UnconstrainedOnly>
struct CentralDifference {
  static constexpr char const* name = "CentralDifference";
  static constexpr int order = 2;
  static constexpr bool accepts_constraints = Stabilisation::accepts_constraints;
  static constexpr double stability_limit = 2.0;  ///< ωh, a ratio
  static double stable_step(double omega, double rate) { return verlet_stability_limit(omega, rate); }

  Stabilisation stabilisation = {};  ///< how a step keeps to the rows

  /// Everything that a step needs, allocated once.
  template <class Solver>
  struct Workspace : detail::ExplicitStep<Solver> {
    typename Stabilisation::Scratch scratch;                                        ///< memory of the stabilisation
    explicit Workspace(System& s) : detail::ExplicitStep<Solver>(s), scratch(s) {}  ///< allocates all of it
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
    w.v = x.v + 0.5 * h * x.a;
    w.dq = h * w.v;
    system.plus(x.q, w.dq, w.q);
    w.v += 0.5 * h * x.a;  // predicted, for forces that depend on speed
    stabilisation.apply(system, w.forward, w.scratch, w.q, w.v, x.t + h);
    w.forward.accelerations(system, {w.q, w.v, x.t + h}, w.a, w.lambda, stabilisation.feedback());
    w.v = x.v + 0.5 * h * (x.a + w.a);
    stabilisation.velocities(system, w.forward, w.scratch, w.q, w.v, x.t + h);
    w.accept(system, x, h);
    return {.taken = h, .next = h, .factorisations = 1, .evaluations = 1};
  }
};

}  // namespace polybody
