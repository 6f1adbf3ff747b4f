#pragma once
/// \file
/// How an explicit step keeps to the rows. A policy is a value with options:
///   policy.check();                                         throws for options that cannot be meant
///   Policy::Scratch scratch(system);                        its memory, allocated once
///   policy.start(scratch);                                  at the start of a run: earlier steps are forgotten
///   policy.feedback()                                       what the accelerations feed back
///   policy.apply(system, forward, scratch, q, v, t);        positions and velocities after a step, back to the rows
///   policy.velocities(system, forward, scratch, q, v, t);   the velocities alone

#include <polybody/integrators/integrator.hpp>

namespace polybody {

namespace detail {
/// How often a policy chose independent coordinates; zero for one that chooses none.
template <class Scratch>
long choices_of(Scratch const& scratch) {
  if constexpr (requires { scratch.choices(); })
    return scratch.choices();
  else
    return 0;
}
}  // namespace detail

/// What policies have in common that need no memory and correct nothing.
struct NoCorrection {
  /// Nothing is kept.
  struct Scratch {
    explicit Scratch(System const&) {}  ///< needs no room
  };
  void check() const {}
  void start(Scratch&) const {}
  ConstraintFeedback feedback() const { return {}; }
  template <class Solver>
  void apply(System&, ForwardDynamics<Solver>&, Scratch&, VecX&, VecX&, double) const {}
  template <class Solver>
  void velocities(System&, ForwardDynamics<Solver>&, Scratch&, VecX const&, VecX&, double) const {}
};

/// Where none is named: for models whose joints bring no rows.
struct UnconstrainedOnly : NoCorrection {
  static constexpr bool accepts_constraints = false;
};

/// The augmented equations alone, Φ̈ = 0 [thesis Eq. 3.2]. What a step leaves of Φ̇ stays, and Φ drifts off as Φ̇ t: to
/// show that, or for runs short enough.
struct NoStabilisation : NoCorrection {
  static constexpr bool accepts_constraints = true;
};

/// The accelerations obey Φ̈ + 2α Φ̇ + β² Φ = 0: with α = β a violation dies away as e^{−αt} [Baumgarte 1972]. It is
/// damped, not removed, and the step must resolve 1/α.
struct Baumgarte {
  static constexpr bool accepts_constraints = true;
  using Scratch = NoCorrection::Scratch;  ///< nothing is kept
  Required<double> alpha;                 ///< [1/s]
  Required<double> beta;                  ///< [1/s]

  void check() const {
    require_positive(alpha, "Baumgarte: alpha");
    require_positive(beta, "Baumgarte: beta");
  }
  void start(Scratch&) const {}
  ConstraintFeedback feedback() const { return {.rate = 2.0 * alpha, .position = beta * beta}; }
  template <class Solver>
  void apply(System&, ForwardDynamics<Solver>&, Scratch&, VecX&, VecX&, double) const {}
  template <class Solver>
  void velocities(System&, ForwardDynamics<Solver>&, Scratch&, VecX const&, VecX&, double) const {}
};

/// After every step the positions are brought back to Φ = 0 by Gauss–Newton and the velocities to Φ̇ = 0, both
/// by the smallest change in the norm of M [Lubich 1991; Eich-Soellner & Führer 1998, §5.3].
struct Projection {
  static constexpr bool accepts_constraints = true;
  using Scratch = NoCorrection::Scratch;  ///< nothing is kept
  double tolerance = 1e-12;               ///< of Φ, relative to 1 + max |q|
  int max_iterations = 10;                ///< of Gauss–Newton for the positions, before it throws

  void check() const {
    require_positive(tolerance, "Projection: the tolerance");
    require_count(max_iterations, "Projection: max_iterations");
  }
  void start(Scratch&) const {}
  ConstraintFeedback feedback() const { return {}; }

  /// \throws NewtonConvergenceFailure when the positions cannot be brought back.
  template <class Solver>
  void apply(System& system, ForwardDynamics<Solver>& forward, Scratch&, VecX& q, VecX& v, double t) const {
    if (system.rows() == 0) return;
    double const enough = tolerance * (1.0 + q.cwiseAbs().maxCoeff());
    for (int k = 0;; ++k) {
      if (forward.project_positions_once(system, q, v, t) <= enough) break;
      if (k == max_iterations)
        throw NewtonConvergenceFailure(
            "projection.not_converged",
            {ErrorObject{"Projection"},
             ": the projection of the positions onto the constraint equations does not converge at t = ", ErrorTime{t},
             " s. Take a smaller step."});
    }
    forward.project_velocities(system, q, v, t);
  }
  template <class Solver>
  void velocities(System& system, ForwardDynamics<Solver>& forward, Scratch&, VecX const& q, VecX& v, double t) const {
    forward.project_velocities(system, q, v, t);
  }
};

}  // namespace polybody
