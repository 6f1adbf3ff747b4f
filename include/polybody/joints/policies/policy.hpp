#pragma once
/// \file
/// Kinds of joint policies, and the policy `Constraint`. The assembly treats all policies of one kind with the same
/// code.
/// Theory: Eq. 5.1.

#include <polybody/joints/constraint_terms.hpp>

namespace polybody {

/// Policy that adds constraint equations with multipliers.
template <class P>
concept ConstrainingPolicy = requires { requires P::adds_constraints; };

/// Policy whose constraint equations are eliminated from a time step together with the coordinates that they determine.
/// All other evaluations of a model treat these equations as constraint equations with multipliers.
template <class P>
concept EliminatingPolicy = ConstrainingPolicy<P> && requires { requires P::eliminates; };

/// Policy whose constraint equations remain in a time step.
template <class P>
concept MultiplierPolicy = ConstrainingPolicy<P> && !EliminatingPolicy<P>;

/// Policy with a force −Gᵀλ(g, ġ) for m constraint equations; the derivative of λ is a matrix (m×m), full or diagonal.
template <class P, int m>
concept CompliantLaw = requires(P const p, Vec<double, m> const g, std::string const what) {
  p.check(what);
  { p.template multiplier<m, double>(g, g) } -> std::convertible_to<Vec<double, m>>;
  { p.template slope<m>(1.0, 1.0, g, g) } -> std::convertible_to<Mat<double, m, m>>;
  { p.template potential<m>(g) } -> std::convertible_to<double>;
};

/// Policy with a force instead of constraint equations. Some policies accept any number of equations, others one fixed
/// number.
template <class P>
concept CompliantPolicy = CompliantLaw<P, 1> || CompliantLaw<P, 2> || CompliantLaw<P, 3> || CompliantLaw<P, 4> ||
                          CompliantLaw<P, 5> || CompliantLaw<P, 6>;

/// Joint policy of exactly one kind.
template <class P>
concept Policy = (int(ConstrainingPolicy<P>) + int(CompliantPolicy<P>) == 1);

/// Ideal joint: a Lagrange multiplier enforces each constraint equation exactly. The generalised force of the joint is
/// −Gᵀλ [thesis Eq. 3.2–3.3].
struct Constraint {
  static constexpr char const* name = "Constraint";
  static constexpr bool adds_constraints = true;  ///< constraint equations with multipliers
};

}  // namespace polybody
