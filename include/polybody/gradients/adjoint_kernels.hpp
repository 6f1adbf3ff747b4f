#pragma once
/// \file
/// Common parts of the adjoints of time steps: vectors of tape variables, and the solution of the transposed equations.
///
/// Not in polybody.hpp: few programs need derivatives of whole runs.

#include <limits>

#include <polybody/gradients/gmres.hpp>
#include <polybody/math/tape.hpp>
#include <polybody/math/types.hpp>

namespace polybody::detail {

/// Sets `to` to new independent variables of the tape with the values of `from`.
template <class = void>
void set_variables(VecX const& from, VecXOf<ReverseVar>& to) {
  to.resize(from.size());
  for (Index i = 0; i < from.size(); ++i) to[i] = ReverseVar::variable(from[i]);
}
/// Adds the `derivatives` of a result with respect to `numbers` to the tape. Called before a sweep.
template <class = void>
void add_to_derivatives(Tape& recording, VecXOf<ReverseVar> const& numbers, VecX const& derivatives) {
  for (Index i = 0; i < derivatives.size(); ++i) recording.slope(numbers[i].number) += derivatives[i];
}
/// Copies the derivatives of a result with respect to `numbers` from the tape to `derivatives`. Called after a sweep.
template <class = void>
void take_derivatives(Tape& recording, VecXOf<ReverseVar> const& numbers, VecX& derivatives) {
  for (Index i = 0; i < numbers.size(); ++i) derivatives[i] = recording.slope(numbers[i].number);
}

/// Solution of Aᵀ μ = y with the factorisation of a matrix close to Aᵀ. The iteration starts from μ = 0, because
/// another initial value would require one more product with Aᵀ. If the first correction exceeds round-off, GMRES
/// continues the iteration. The last computed product is Aᵀ μ of the final μ.
class TransposedSolution {
 public:
  /// Computes μ. Returns the norm of the last computed correction, relative to the norm of μ. \param product product(x)
  /// returns Aᵀ x; \param solve solve(rhs, x) solves with the factorisation; \param most largest number of products in
  /// one GMRES cycle
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

  /// Number of products with Aᵀ in the last solution.
  int products() const { return products_; }

 private:
  static constexpr int cycles = 5;
  static constexpr double rounding = 1e-12;

  Gmres gmres_;
  int products_ = 0;
  VecX rhs_, correction_;
};

}  // namespace polybody::detail
