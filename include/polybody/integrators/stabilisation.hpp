#pragma once
/// \file
/// Constraint stabilisation of explicit steps. A policy is a value with options:
///   policy.check();                                         throws if an option is not in its range
///   Policy::Scratch scratch(system);                        memory of the policy, allocated once
///   policy.start(scratch);                                  start of a run: discards earlier steps
///   policy.feedback()                                       feedback of the violation in the accelerations
///   policy.apply(system, forward, scratch, q, v, t);        corrects positions and velocities after a step
///   policy.velocities(system, forward, scratch, q, v, t);   corrects velocities only
/// Theory: Eqs. 6.25, 6.27.

#include <polybody/integrators/integrator.hpp>

namespace polybody {

namespace detail {
/// Number of times that a policy selected independent coordinates; zero for policies that select none.
template <class Scratch>
long choices_of(Scratch const& scratch) {
  if constexpr (requires { scratch.choices(); })
    return scratch.choices();
  else
    return 0;
}
}  // namespace detail

/// Common members of policies without memory and without corrections.
struct NoCorrection {
  /// Empty memory.
  struct Scratch {
    explicit Scratch(System const&) {}  ///< allocates nothing
  };
  void check() const {}
  void start(Scratch&) const {}
  ConstraintFeedback feedback() const { return {}; }
  template <class Solver>
  void apply(System&, ForwardDynamics<Solver>&, Scratch&, VecX&, VecX&, double) const {}
  template <class Solver>
  void velocities(System&, ForwardDynamics<Solver>&, Scratch&, VecX const&, VecX&, double) const {}
};

/// Default policy, for models with joints that add no constraint equations.
struct UnconstrainedOnly : NoCorrection {
  static constexpr bool accepts_constraints = false;
};

/// Augmented equations without stabilisation, Φ̈ = 0 [thesis Eq. 3.2]. The error of Φ̇ after a step persists, and Φ
/// drifts by Φ̇ t. Use it to show this drift, or for short runs.
struct NoStabilisation : NoCorrection {
  static constexpr bool accepts_constraints = true;
};

/// Baumgarte stabilisation: the accelerations satisfy Φ̈ + 2α Φ̇ + β² Φ = 0. With α = β, a violation decays as (c₁ + c₂
/// t) e^{−αt} [Baumgarte 1972]. The violation is damped but not removed, and the step must resolve 1/α.
struct Baumgarte {
  static constexpr bool accepts_constraints = true;
  using Scratch = NoCorrection::Scratch;  ///< empty
  Required<double> alpha;                 ///< coefficient α [1/s]
  Required<double> beta;                  ///< coefficient β [1/s]

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

/// Projection after every step: Gauss–Newton iterations correct the positions to Φ = 0, and then the velocities are
/// corrected to Φ̇ = 0. Both changes are the smallest ones in the norm of M [Lubich 1991; Eich-Soellner & Führer 1998,
/// §5.3].
struct Projection {
  static constexpr bool accepts_constraints = true;
  using Scratch = NoCorrection::Scratch;  ///< empty
  double tolerance = 1e-12;               ///< tolerance of Φ, relative to 1 + max |q|
  int max_iterations = 10;                ///< limit of Gauss–Newton iterations for the positions

  void check() const {
    require_positive(tolerance, "Projection: the tolerance");
    require_count(max_iterations, "Projection: max_iterations");
  }
  void start(Scratch&) const {}
  ConstraintFeedback feedback() const { return {}; }

  /// Corrects positions and velocities. \throws NewtonConvergenceFailure if the positions do not converge.
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
