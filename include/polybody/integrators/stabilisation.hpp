#pragma once
/// \file
/// How an explicit step keeps to the rows.

#include <polybody/integrators/integrator.hpp>

namespace polybody {

/// None: for models whose joints bring no rows.
struct NoStabilisation {
  static constexpr bool accepts_rows = false;
  template <class M, class Solver>
  void apply(System<M>&, ForwardDynamics<M, Solver>&, VecX&, VecX&, double) const {}
};

/// After every step the positions are brought back to Φ = 0 by Gauss–Newton and the velocities to Φ̇ = 0, both
/// by the smallest change in the norm of M [Lubich 1991; Eich-Soellner & Führer 1998, §5.3].
struct Projection {
  static constexpr bool accepts_rows = true;
  double tolerance = 1e-12;  ///< of Φ, relative to 1 + max |q|
  int max_iterations = 10;

  /// \throws NewtonStalled when the positions cannot be brought back.
  template <class M, class Solver>
  void apply(System<M>& system, ForwardDynamics<M, Solver>& forward, VecX& q, VecX& v, double t) const {
    if (system.rows() == 0) return;
    double const enough = tolerance * (1.0 + q.cwiseAbs().maxCoeff());
    for (int k = 0;; ++k) {
      if (forward.project_positions_once(system, q, v, t) <= enough) break;
      if (k == max_iterations)
        throw NewtonStalled("Projection: the positions cannot be brought back to the joints at t = " +
                            number(t) + " s. Take a smaller step.");
    }
    forward.project_velocities(system, q, v, t);
  }
};

}  // namespace polybody
