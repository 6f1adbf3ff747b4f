#pragma once
/// \file
/// Common parts of the adjoints of time steps: vectors of tape variables, and the solution of the transposed equations.

#include <cmath>
#include <limits>
#include <vector>

#include <polybody/math/tape.hpp>
#include <polybody/math/types.hpp>

namespace polybody::detail {

// GMRES [Saad & Schultz 1986] with one matrix-vector product per call, so that products of several systems can be
// evaluated together. It solves
//   B x = b, with B = M⁻¹ A and b = M⁻¹ r, where M is a factorised matrix close to A.
// After n products, x is the combination of b, B b, … Bⁿ⁻¹ b with the least residual. If M = A, one product is enough.
// If M differs from A by a matrix of rank r, r + 1 products are enough, even if iterative refinement with M diverges.

/// Iterative solution of one system of linear equations. The memory of the vectors is reused in the next solution.
class Gmres {
 public:
  /// Begins the solution of B x = b. \param tolerated permitted norm of the residual; \param most largest number of
  /// products
  void begin(VecX const& b, double tolerated, Index most) {
    tolerated_ = tolerated;
    most_ = most;
    count_ = 0;
    left_ = b.norm();
    set(0, b, left_);
    upper_.setZero(most, most);
    turned_.setZero(most + 1);
    turned_[0] = left_;
    cosines_.setZero(most);
    sines_.setZero(most);
  }
  /// Returns true if the residual is within the tolerance, or if the largest number of products is reached.
  bool is_done() const { return left_ <= tolerated_ || count_ == most_; }
  /// Vector to be multiplied by B next.
  VecX const& next() const { return basis_[std::size_t(count_)]; }
  /// Processes a product. \param product (n) B times `next()`; it is overwritten
  void take(VecX& product) {
    double const before = product.norm();
    Vec<double, Eigen::Dynamic> column = VecX::Zero(count_ + 2);
    for (int twice = 0; twice < 2; ++twice)  // once is not accurate enough [Giraud et al. 2005]
      for (Index i = 0; i <= count_; ++i) {
        double const along = basis_[std::size_t(i)].dot(product);
        product -= along * basis_[std::size_t(i)];
        column[i] += along;
      }
    double const rest = product.norm();
    column[count_ + 1] = rest;
    for (Index i = 0; i < count_; ++i) turn(i, column);
    double const length = std::hypot(column[count_], rest);
    cosines_[count_] = length > 0.0 ? column[count_] / length : 1.0;
    sines_[count_] = length > 0.0 ? rest / length : 0.0;
    turn(count_, column);
    upper_.col(count_).head(count_ + 1) = column.head(count_ + 1);
    turned_[count_ + 1] = -sines_[count_] * turned_[count_];
    turned_[count_] *= cosines_[count_];
    ++count_;
    left_ = rest <= 1e-15 * before ? 0.0 : std::abs(turned_[count_]);  // no new direction: the basis contains x
    set(count_, product, rest);
  }
  /// Adds the solution to x.
  void add_to(VecX& x) const {
    VecX parts = turned_.head(count_);
    upper_.topLeftCorner(count_, count_).triangularView<Eigen::Upper>().solveInPlace(parts);
    for (Index i = 0; i < count_; ++i) x += parts[i] * basis_[std::size_t(i)];
  }

 private:
  void set(Index i, VecX const& x, double length) {
    if (std::size_t(i) == basis_.size()) basis_.emplace_back();
    basis_[std::size_t(i)] = length > 0.0 ? VecX(x / length) : x;
  }
  void turn(Index i, VecX& column) const {
    double const a = column[i], b = column[i + 1];
    column[i] = cosines_[i] * a + sines_[i] * b;
    column[i + 1] = cosines_[i] * b - sines_[i] * a;
  }

  std::vector<VecX> basis_;
  MatX upper_;
  VecX turned_, cosines_, sines_;
  double tolerated_ = 0.0, left_ = 0.0;
  Index most_ = 0, count_ = 0;
};

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
