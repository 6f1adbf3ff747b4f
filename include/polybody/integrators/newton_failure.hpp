#pragma once
/// \file
/// Reports of steps by Newton's method, and errors of steps in which it failed.

#include <polybody/integrators/correction_size.hpp>
#include <polybody/integrators/integrator.hpp>

namespace polybody::detail {

/// Last linear equations of Newton's method in a step; the equations of several stages follow each other.
struct StepEquations {
  Index bad;  ///< equation without a pivot; −1 if unknown
  VecX const &rhs, &solution;
};

/// Returns the report `step` with the cost of an `attempt` added. \param each number of force evaluations per iteration
template <class = void>
StepReport with_attempt(NewtonReport const& attempt, StepReport step, int each = 1) {
  step.iterations += attempt.iterations;
  step.factorisations += attempt.factorisations;
  step.evaluations += each * attempt.iterations;
  return step;
}
/// Report of a step of length h [s], from the `last` attempt. \param each number of force evaluations per iteration
/// \param before cost of earlier attempts
template <class = void>
StepReport report_of(double h, NewtonReport const& last, int each = 1, StepReport const& before = {}) {
  StepReport step = with_attempt(last, before, each);
  step.taken = step.next = h;
  step.contraction = last.theta;
  step.left = last.left;
  return step;
}

/// Repeats a step by `again()`. Returns the report of `again`, which includes the cost of the failed `attempt`. If
/// `again` throws, this cost is added to `failed`.
template <class Again>
StepReport retried(AttemptCost& failed, NewtonReport const& attempt, Again&& again) {
  return count_if_failed(failed, with_attempt(attempt, {}), [&] { return with_attempt(attempt, again()); });
}

/// Part of a message with a remedy for friction; empty if no force element of the model dissipates energy.
template <class = void>
[[gnu::cold]] std::string remedy_of_friction(System const& system) {
  for (ForceLayout const& force : system.layout().forces)
    if (!force.lossless && !force.is_load)
      return sentence_of({", or a larger slip speed if \"", force.name, "\" has friction"});
  return "";
}

/// Part of a message with a remedy for a bar whose elements resist stretch far more than bending. A small rotation of
/// an element then causes a large axial force, and Newton's method follows this force instead of the motion. Empty if
/// the model has no such bar.
template <class = void>
[[gnu::cold]] std::string remedy_of_stretch(System const& system) {
  for (BodyLayout const& body : system.layout().bodies)
    if (body.stretch_ratio > 1e8)  // strains are negligible already at 1e8
      return sentence_of({", or an axial stiffness EA of \"", body.name,
                          "\" of at most 1e8 EI/l², with the length l of its elements (now ", body.stretch_ratio,
                          " EI/l²)"});
  return "";
}

/// Throws the error of a step of `integrator` to time t in which Newton's method failed. The message names the reason
/// and the body, joint or force element. If each equation has a pivot but the solution is not finite, the message names
/// the body with the non-finite motion. \throws SingularMatrix, NonFiniteValue, NewtonConvergenceFailure.
template <class = void>
[[noreturn, gnu::cold]] void throw_convergence_failure(std::string const& integrator, System const& system, double t,
                                                       NewtonReport const& report, StepEquations const& last) {
  auto const owner = [&](VecX const& x) {
    Index const i = first_not_finite(x);
    return system.name_of((i < 0 ? x.size() - 1 : i) % system.size());
  };
  if (report.result == NewtonResult::singular && last.bad >= 0) {
    require_finite_place(system);
    throw SingularMatrix("newton.singular",
                         {integrator, ": the tangent is singular", " at t = ", ErrorTime{t}, " s, first at ",
                          ErrorObject{name_of_equation(system, last.bad % equations_of(system))},
                          ". Check for a redundant joint, or for a free body without inertia."});
  }
  if (report.result == NewtonResult::singular)
    throw NonFiniteValue(
        "motion.not_finite",
        {integrator, ": the motion of ", ErrorObject{owner(last.solution)}, " is not finite", " at t = ", ErrorTime{t},
         " s. Check its velocity and the forces on it before this time, or take a smaller step.",
         and_whose_force(system)});
  if (report.result == NewtonResult::not_finite)
    throw NonFiniteValue("force.not_finite", {integrator, ": a force on ", ErrorObject{owner(last.rhs)},
                                              " is not finite", " at t = ", ErrorTime{t}, " s", whose_force(system),
                                              ". Check the forces applied to it, or take a smaller step."});
  throw NewtonConvergenceFailure(
      "newton.not_converged",
      {ErrorObject{integrator}, ": Newton's method did not converge", " at t = ", ErrorTime{t}, " s after ",
       report.iterations, " iterations (contraction rate ", report.theta, "). Take a smaller step",
       remedy_of_friction(system), remedy_of_stretch(system), ". The state is unchanged."});
}

}  // namespace polybody::detail
