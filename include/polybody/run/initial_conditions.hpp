#pragma once
/// \file
/// Consistent starts: assembly of positions, projection of velocities, accelerations and multipliers.

#include <polybody/math/vectors.hpp>
#include <polybody/run/redundant_constraints.hpp>
#include <polybody/run/state_checks.hpp>
#include <polybody/system/make_operations.hpp>

namespace polybody {

namespace detail {
/// The row that is open most, by its place; 0 where there is none.
template <class = void>
Index most_open(VecX const& phi) {
  Index worst = 0;
  for (Index i = 1; i < phi.size(); ++i)
    if (std::abs(phi[i]) > std::abs(phi[worst])) worst = i;
  return worst;
}
}  // namespace detail

/// \throws InconsistentInitialConditions naming the joint that is violated most, when by more than `tolerance`.
template <class = void>
[[gnu::cold]] void require_assembled(System& system, State const& x, double tolerance = 1e-8) {
  system.evaluate(x.q, x.v, x.t);
  VecX phi = VecX::Zero(system.rows());
  system.violation(phi);
  Index const worst = detail::most_open(phi);
  if (phi.size() == 0 || std::abs(phi[worst]) <= tolerance) return;
  throw InconsistentInitialConditions{"At the start ", system.name_of(system.velocities() + worst), " is open by ",
                                      std::abs(phi[worst]),
                                      ". Place the bodies so that it closes, or call "
                                      "assemble(model, x)."};
}

/// \throws InconsistentInitialConditions naming joints that stay open because their rows repeat each other with other
/// dimensions.
template <class Solver>
[[gnu::cold]] void require_closable(System& system, ForwardDynamics<Solver>& forward, State const& x) {
  if (!all_finite(x.q)) return;
  forward.hold(system, x.q, x.v, x.t);
  VecX phi = VecX::Zero(system.rows());
  system.violation(phi);
  require_consistent_constraints(system, forward, phi, detail::ContradictionLimits{}.position, "positions");
}

/// Moves the coordinates by the smallest change in the norm of M until every joint closes (Gauss–Newton) to
/// `tolerance`, in at most `max_iterations`, then projects the speeds. \throws InconsistentInitialConditions naming the
/// joint that cannot be closed, or the joints whose rows repeat each other but contradict; x is then untouched.
template <LinearSolver Solver = DefaultSolver>
void assemble(System& system, State& x, double tolerance = 1e-12, int max_iterations = 50) {
  require_positive(tolerance, "assemble: the tolerance");
  require_count(max_iterations, "assemble: max_iterations");
  require_fitting(system, x);
  ForwardDynamics<Solver> forward(system);
  State trial = x;
  double before = 0.0;
  for (int k = 0;; ++k) {
    before = forward.project_positions_once(system, trial.q, trial.v, trial.t);
    if (before <= tolerance) break;
    if (k == max_iterations || !std::isfinite(before)) {
      require_closable(system, forward, trial);
      require_assembled(system, trial, tolerance);
      throw InconsistentInitialConditions("assemble: the joints cannot be closed from this start.");
    }
  }
  forward.project_velocities(system, trial.q, trial.v, trial.t);
  require_consistent_redundancy(system, forward, trial);
  x = std::move(trial);
}

/// The same of a model, to `tolerance` in at most `max_iterations`.
template <class M>
void assemble(M const& model, State& x, double tolerance = 1e-12, int max_iterations = 50) {
  System system(model, with<Capabilities::motion>);
  assemble(system, x, tolerance, max_iterations);
}

}  // namespace polybody
