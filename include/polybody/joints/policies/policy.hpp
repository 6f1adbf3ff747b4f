#pragma once
/// \file
/// The kinds of joint policy. Each kind is one path in the assembler, however many policies there are.

#include <polybody/joints/gap.hpp>

namespace polybody {

/// Rows with multipliers.
template <class P>
concept AddsRows = requires { requires P::adds_rows; };

/// A force −Gᵀλ(g, ġ) in place of rows.
template <class P>
concept AddsForce = requires(P const p, Vec<double, 3> const g, std::string const what) {
  p.check(what);
  { p.template multiplier<3, double>(g, g) } -> std::convertible_to<Vec<double, 3>>;
  { p.template slope<3>(1.0, 1.0) } -> std::convertible_to<Vec<double, 3>>;
  { p.template potential<3>(g) } -> std::convertible_to<double>;
};

/// Exactly one kind.
template <class P>
concept Policy = (int(AddsRows<P>) + int(AddsForce<P>) == 1);

}  // namespace polybody
