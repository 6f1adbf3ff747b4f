#pragma once
/// \file
/// What adjoints of steps have in common: vectors of recorded numbers, and the solution of their transposed equations.
///
/// Not in polybody.hpp: few programs ask for derivatives of whole runs.

#include <limits>

#include <polybody/math/recorded.hpp>
#include <polybody/math/types.hpp>

namespace polybody::detail {

/// `to` becomes independent variables of these values.
template <class = void>
void set_variables(VecX const& from, VecXOf<Recorded>& to) {
  to.resize(from.size());
  for (Index i = 0; i < from.size(); ++i) to[i] = Recorded::variable(from[i]);
}
/// Before a sweep: what a result changes by with these numbers.
template <class = void>
void add_to_slopes(Recording& recording, VecXOf<Recorded> const& numbers, VecX const& slopes) {
  for (Index i = 0; i < slopes.size(); ++i) recording.slope(numbers[i].number) += slopes[i];
}
/// After a sweep: the same.
template <class = void>
void take_slopes(Recording& recording, VecXOf<Recorded> const& numbers, VecX& slopes) {
  for (Index i = 0; i < numbers.size(); ++i) slopes[i] = recording.slope(numbers[i].number);
}

/// Aᵀ μ = y by factors of a matrix near Aᵀ, corrected until nothing changes; the last product is of the last μ. Returns
/// the last correction relative to μ. \param mu where to begin; \param product gives Aᵀ μ of the present μ; \param
/// solve solve(rhs, correction) by the factors; \param most corrections
template <class Product, class Solve>
double solve_by_products(VecX const& y, VecX& mu, Product&& product, Solve&& solve, int most) {
  VecX rhs(y.size()), correction(y.size());
  double left = std::numeric_limits<double>::infinity();
  for (int k = 0; k < most; ++k) {
    rhs = y - product();
    solve(rhs, correction);
    double const all = mu.norm(), changed = correction.norm();
    double const now = all > 0.0 ? changed / all : changed > 0.0 ? 1.0 : 0.0;
    bool const done = now <= 1e-15 || (k > 1 && now <= 1e-10 && now >= 0.3 * left);
    left = now;
    if (done) break;
    mu += correction;
  }
  return left;
}

}  // namespace polybody::detail
