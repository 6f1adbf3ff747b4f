#pragma once
/// \file
/// What adjoints of steps have in common: vectors of recorded numbers, and the solution of their transposed equations.
///
/// Not in polybody.hpp: few programs ask for derivatives of whole runs.

#include <limits>

#include <polybody/gradients/gmres.hpp>
#include <polybody/math/tape.hpp>
#include <polybody/math/types.hpp>

namespace polybody::detail {

/// `to` becomes independent variables of these values.
template <class = void>
void set_variables(VecX const& from, VecXOf<ReverseVar>& to) {
  to.resize(from.size());
  for (Index i = 0; i < from.size(); ++i) to[i] = ReverseVar::variable(from[i]);
}
/// Before a sweep: what a result changes by with these numbers.
template <class = void>
void add_to_derivatives(Tape& recording, VecXOf<ReverseVar> const& numbers, VecX const& derivatives) {
  for (Index i = 0; i < derivatives.size(); ++i) recording.slope(numbers[i].number) += derivatives[i];
}
/// After a sweep: the same.
template <class = void>
void take_derivatives(Tape& recording, VecXOf<ReverseVar> const& numbers, VecX& derivatives) {
  for (Index i = 0; i < numbers.size(); ++i) derivatives[i] = recording.slope(numbers[i].number);
}

/// Aᵀ μ = y by factors of a matrix near Aᵀ, from zero on: what is near the solution would cost a product more. Where
/// the first correction of what they give is not rounding, by GMRES. The last product is of the last μ.
class TransposedSolution {
 public:
  /// Returns the last correction relative to μ. \param product gives Aᵀ x of a given x; \param solve solve(rhs, x) by
  /// the factors; \param most products between two corrections
  template <class Product, class Solve>
  double solve(VecX const& y, VecX& mu, Product&& product, Solve&& solve, Index most) {
    mu.resize(y.size());
    correction_.resize(y.size());
    solve(y, mu);
    products_ = 0;
    double left = std::numeric_limits<double>::infinity();
    for (int cycle = 0;; ++cycle) {
      rhs_ = y - product(mu);
      ++products_;
      solve(rhs_, correction_);
      double const all = mu.norm(), before = left;
      left = all > 0.0 ? correction_.norm() / all : 0.0;
      if (left <= rounding || !(left < 0.1 * before) || cycle == cycles) return left;
      gmres_.begin(correction_, 0.01 * rounding * all, most);
      while (!gmres_.is_done()) {
        solve(product(gmres_.next()), correction_);
        gmres_.take(correction_);
        ++products_;
      }
      gmres_.add_to(mu);
    }
  }

  /// How many products the last solution took.
  int products() const { return products_; }

 private:
  static constexpr int cycles = 5;
  static constexpr double rounding = 1e-12;

  Gmres gmres_;
  int products_ = 0;
  VecX rhs_, correction_;
};

}  // namespace polybody::detail
