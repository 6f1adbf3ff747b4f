#pragma once
/// \file
/// GMRES [Saad & Schultz 1986] with one matrix-vector product per call, so that products of several systems can be
/// evaluated together. It solves
///   B x = b, with B = M⁻¹ A and b = M⁻¹ r, where M is a factorised matrix close to A.
/// After n products, x is the combination of b, B b, … Bⁿ⁻¹ b with the least residual. If M = A, one product is enough.
/// If M lacks a few blocks of A, a few more products than missing blocks are enough, even if iterative refinement with
/// M diverges.
///
/// Not in polybody.hpp: few programs need derivatives of whole runs.

#include <cmath>
#include <vector>

#include <polybody/math/types.hpp>

namespace polybody::detail {

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

}  // namespace polybody::detail
