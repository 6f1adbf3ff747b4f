#pragma once
/// \file
/// Size of Newton corrections relative to their tolerance, reports of steps by Newton's method, and errors of steps in
/// which it failed.

#include <algorithm>
#include <limits>

#include <polybody/integrators/integrator.hpp>
#include <polybody/math/vectors.hpp>
#include <polybody/solvers/newton.hpp>

namespace polybody::detail {

/// Mean round-off of the coordinates: ε times the root mean square of q, plus ε for directions and moment arms. The
/// size of a correction is also a root mean square. A single large coordinate, for example an angle after many
/// revolutions, therefore enters the round-off and the correction in the same way.
inline double rounding_of(VecX const& q) {
  return std::numeric_limits<double>::epsilon() * (1.0 + std::sqrt(squares(q) / double(std::max<Index>(q.size(), 1))));
}
/// Round-off of a correction y that changes q by s y.
inline double rounding_of(VecX const& q, double s) { return rounding_of(q) / s; }

/// Sets out to x, with each entry changed by ±4 `rounding_of(q)`. The signs are irregular, so that they match no
/// pattern of a model. x and out may be the same vector.
inline void perturb(VecX const& x, VecX const& q, VecX& out) {
  double const size = 4.0 * rounding_of(q);
  for (Index i = 0; i < x.size(); ++i) out[i] = x[i] + scattered_sign(i) * size;
}
/// True if a correction may be round-off, because `moved` is at most 1e10 `rounding_of(q)`. Near a singular
/// configuration, the inverse of the constraint Jacobian amplifies the round-off ε to √ε times some powers of ten. A
/// diverged iterate has a large tolerance, but changes the coordinates by metres, and is thus excluded. \param moved
/// root mean square change of the coordinates
inline bool may_be_rounding(double moved, VecX const& q) { return moved <= 1e10 * rounding_of(q); }
/// Overload for a step from q: the largest violation in phi must also be at most 1e3 `rounding_of(q)`.
inline bool may_be_rounding(VecX const& phi, double moved, VecX const& q) {
  return largest_size(phi) <= 1e3 * rounding_of(q) && may_be_rounding(moved, q);
}

/// True if the correction y with the norm `norm` consists of round-off: it changes by at least half of `norm` if
/// coordinates and constraint functions change by a few units of round-off. Near a singular configuration, the inverse
/// of the constraint Jacobian amplifies round-off many times. Light nodes amplify the round-off of strains in the same
/// way. \param moved computes the perturbed correction in y and returns true if this correction is finite \param
/// measure returns the norm of y
/// \param kept workspace; y is unchanged afterwards
template <class Moved, class Measure>
bool is_round_off(VecX& y, double norm, VecX& kept, Moved&& moved, Measure&& measure) {
  kept = y;
  bool const finite = moved();
  y -= kept;
  bool const differs = finite && measure() >= 0.5 * norm;
  y.swap(kept);
  return differs;
}

/// First-order states: the last `count` of the velocities `v`, with their rates. Each state has its own unit.
struct StatesInStep {
  Index count;
  VecX const &v, &rate;
  double s;  ///< change of the states per correction of their rates [s]

  /// Combines corrections y of the rates with those of the accelerations. The tolerance of each state is `tolerance`
  /// times (1 + |z| + |ż|), plus the round-off of z over s.
  CorrectionSize join(CorrectionSize size, double tolerance, double const* y) const {
    double worst = 0.0;
    for (Index i = v.size() - count; i < v.size(); ++i) {
      double const z = std::abs(v[i]), rounding = 30.0 * std::numeric_limits<double>::epsilon() * z / s;
      worst = std::max(worst, std::abs(y[i]) / (tolerance * (1.0 + z + std::abs(rate[i])) + rounding));
    }
    if (count > 0) size.norm = std::hypot(size.norm, worst * size.tolerated);
    return size;
  }
};

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
  step.evaluations += each * attempt.iterations + attempt.searches;
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

/// Part of a message with a remedy for a bar whose elements resist stretch far more than bending: EA > 1e8 EI/l², with
/// the length l of an element. A small rotation of an element then causes a large axial force, and Newton's method
/// follows this force instead of the motion. Empty if the model has no such bar.
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
