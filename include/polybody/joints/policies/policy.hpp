#pragma once
/// \file
/// The kinds of joint policy. Each kind is one path in the assembler, however many policies there are.

#include <polybody/joints/gap.hpp>

namespace polybody {

/// Rows with multipliers.
template <class P>
concept AddsRows = requires { requires P::adds_rows; };

/// Its rows leave the equations of a time step together with the coordinates that they determine; all other questions
/// to a model treat them as rows with multipliers.
template <class P>
concept Eliminates = AddsRows<P> && requires { requires P::eliminates; };

/// Its rows stay in the equations of a time step.
template <class P>
concept KeepsRows = AddsRows<P> && !Eliminates<P>;

/// Answers m rows by a force −Gᵀλ(g, ġ); the slope of λ is a matrix (m×m), full or diagonal.
template <class P, int m>
concept AnswersRows = requires(P const p, Vec<double, m> const g, std::string const what) {
  p.check(what);
  { p.template multiplier<m, double>(g, g) } -> std::convertible_to<Vec<double, m>>;
  { p.template slope<m>(1.0, 1.0, g, g) } -> std::convertible_to<Mat<double, m, m>>;
  { p.template potential<m>(g) } -> std::convertible_to<double>;
};

/// A force in place of rows. Some policies answer any number of rows, others one number only.
template <class P>
concept AddsForce = AnswersRows<P, 1> || AnswersRows<P, 2> || AnswersRows<P, 3> || AnswersRows<P, 4> ||
                    AnswersRows<P, 5> || AnswersRows<P, 6>;

/// Exactly one kind.
template <class P>
concept Policy = (int(AddsRows<P>) + int(AddsForce<P>) == 1);

}  // namespace polybody
