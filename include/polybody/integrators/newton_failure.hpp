#pragma once
#include <polybody/integrators/correction_size.hpp>
#include <polybody/integrators/integrator.hpp>

namespace polybody::detail {

/// Throws what says why Newton's method failed in the step of `integrator` to time t; `who` is to blame.
/// \throws LinearSolverSingular, NonFinite, NewtonStalled.
[[noreturn]] inline void throw_stalled(std::string const& integrator, double t, NewtonReport const& report,
                                       std::string const& who) {
  std::string const when = " at t = " + number(t) + " s";
  if (report.result == NewtonResult::singular)
    throw LinearSolverSingular(integrator + ": the tangent is singular" + when + ", first at " + who +
                               ". Look for a joint that repeats another, or a free body without inertia.");
  if (report.result == NewtonResult::not_finite)
    throw NonFinite(integrator + ": a force on " + who + " is not finite" + when +
                    ". Look at the forces applied to it, or take a smaller step.");
  throw NewtonStalled(integrator + ": Newton's method did not converge" + when + " after " +
                      std::to_string(report.iterations) + " iterations (contraction " + number(report.theta) +
                      "). Take a smaller step; the state is as before it.");
}

/// The same for a system. `bad` is the equation without a pivot, −1 where none is known; `rhs` is the right-hand side,
/// of one stage after another.
template <class = void>
[[noreturn]] void throw_stalled(std::string const& integrator, System const& system, double t,
                                NewtonReport const& report, Index bad, VecX const& rhs) {
  std::string who;
  if (report.result == NewtonResult::singular) {
    who = name_of_equation(system, std::max<Index>(bad, 0) % equations_of(system));
  } else if (report.result == NewtonResult::not_finite) {
    Index const i = first_not_finite(rhs);
    who = system.name_of((i < 0 ? rhs.size() - 1 : i) % system.size());
  }
  throw_stalled(integrator, t, report, who);
}

}  // namespace polybody::detail
