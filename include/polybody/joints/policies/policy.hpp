#pragma once
/// \file
/// The kinds of joint policy. Each kind is one path in the assembler, however many policies there are.

#include <polybody/joints/constraint_terms.hpp>

namespace polybody {

/// Rows with multipliers.
template <class P>
concept ConstrainingPolicy = requires { requires P::adds_constraints; };

/// Its rows leave the equations of a time step together with the coordinates that they determine; all other questions
/// to a model treat them as rows with multipliers.
template <class P>
concept EliminatingPolicy = ConstrainingPolicy<P> && requires { requires P::eliminates; };

/// Its rows stay in the equations of a time step.
template <class P>
concept MultiplierPolicy = ConstrainingPolicy<P> && !EliminatingPolicy<P>;

/// Answers m rows by a force −Gᵀλ(g, ġ); the slope of λ is a matrix (m×m), full or diagonal.
template <class P, int m>
concept CompliantLaw = requires(P const p, Vec<double, m> const g, std::string const what) {
  p.check(what);
  { p.template multiplier<m, double>(g, g) } -> std::convertible_to<Vec<double, m>>;
  { p.template slope<m>(1.0, 1.0, g, g) } -> std::convertible_to<Mat<double, m, m>>;
  { p.template potential<m>(g) } -> std::convertible_to<double>;
};

/// A force in place of rows. Some policies answer any number of rows, others one number only.
template <class P>
concept CompliantPolicy = CompliantLaw<P, 1> || CompliantLaw<P, 2> || CompliantLaw<P, 3> || CompliantLaw<P, 4> ||
                          CompliantLaw<P, 5> || CompliantLaw<P, 6>;

/// Exactly one kind.
template <class P>
concept Policy = (int(ConstrainingPolicy<P>) + int(CompliantPolicy<P>) == 1);

}  // namespace polybody
