#pragma once
#include <polybody/integrators/integrator.hpp>
#include <polybody/solvers/newton.hpp>

namespace polybody::detail {

/// Throws what says why Newton's method failed in the step of integrator `name` to time t. `bad` is the equation without a
/// pivot, −1 where none is known; `rhs` is the right-hand side, of one stage after another.
/// \throws LinearSolverSingular, NonFinite, NewtonStalled.
template <class M>
[[noreturn]] void throw_stalled(std::string const& name, System<M> const& system, double t, NewtonReport const& report, Index bad,
                                VecX const& rhs) {
  std::string const when = " at t = " + number(t) + " s";
  auto const owner = [&](Index i) { return system.name_of(i % system.size()); };
  if (report.result == NewtonResult::singular)
    throw LinearSolverSingular(name + ": the tangent is singular" + when + ", first at " +
                               system.name_of_equation(std::max<Index>(bad, 0) % system.equations()) +
                               ". Look for a joint that repeats another, or a free body without inertia.");
  if (report.result == NewtonResult::not_finite) {
    Index i = 0;
    while (i < rhs.size() && std::isfinite(rhs[i])) ++i;
    throw NonFinite(name + ": a force on " + owner(std::min(i, rhs.size() - 1)) + " is not finite" + when +
                    ". Look at the forces applied to it, or take a smaller step.");
  }
  throw NewtonStalled(name + ": Newton's method did not converge" + when + " after " + std::to_string(report.iterations) +
                      " iterations (contraction " + number(report.theta) +
                      "). Take a smaller step; the state is as before it.");
}

}  // namespace polybody::detail
