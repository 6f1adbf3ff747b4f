#pragma once
/// \file
/// Numbers of negative and zero eigenvalues of a sparse symmetric matrix (inertia, by Sylvester's law).

#include <cmath>

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>

#include <polybody/math/sequence.hpp>
#include <polybody/math/types.hpp>

namespace polybody::detail {

/// Signs of the eigenvalues of a sparse symmetric matrix R: the pivots D of P R Pᵀ = L D Lᵀ have these signs
/// (Sylvester's law of inertia). P is the permutation to an approximate minimum degree order. L is computed row by row
/// along the elimination tree [Davis 2006, §4.7]. A pivot below 1e-13 of the sum of its terms' magnitudes counts as
/// zero and is replaced by this sum. Both triangles of R must be stored.
class SymmetricPivots {
 public:
  static constexpr double rounding = 1e-13;        ///< largest pivot that counts as zero, relative to its terms
  static constexpr Index most_entries = 40000000;  ///< largest number of entries of L

  using Matrix = Eigen::SparseMatrix<double>;

  /// Computes the factors; false if L would have more than `most_entries`.
  template <class = void>  // compiled where it is used
  bool factor(Matrix const& r) {
    size_ = r.cols();
    Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> order;
    Eigen::AMDOrdering<int>()(r, order);  // unknown order[k] of R becomes number k
    place_.assign(std::size_t(size_), 0);
    order_.assign(std::size_t(size_), 0);
    for (Index k = 0; k < size_; ++k) {
      order_[std::size_t(k)] = order.indices()[k];
      place_[std::size_t(order.indices()[k])] = int(k);
    }
    if (!analyse(r)) return false;
    eliminate(r);
    return true;
  }
  /// Positions of the pivots that are negative beyond round-off.
  Sequence<Index> const& negative() const { return negative_; }
  Index zero() const { return zero_; }  ///< number of pivots that are zero up to round-off
  /// Vector x with xᵀR x = pivot at position k: Lᵀ P x = e_k.
  template <class = void>
  VecX direction(Index k) const {
    VecX y = VecX::Zero(size_), x(size_);
    y[k] = 1.0;
    for (Index j = k; j >= 0; --j)
      for (Index p = first_[std::size_t(j)]; p < first_[std::size_t(j)] + filled_[std::size_t(j)]; ++p)
        y[j] -= value_[std::size_t(p)] * y[row_[std::size_t(p)]];
    for (Index i = 0; i < size_; ++i) x[order_[std::size_t(i)]] = y[i];
    return x;
  }

 private:
  /// Calls `visit(i, value)` for the entries i < k of column k of P R Pᵀ. From these, the entries of row k of L are
  /// found along the elimination tree.
  template <class Visit>
  void reach(Matrix const& r, int k, Visit&& visit) {
    mark_[std::size_t(k)] = k;
    for (Matrix::InnerIterator entry(r, order_[std::size_t(k)]); entry; ++entry) {
      int i = place_[std::size_t(entry.index())];
      if (i < k) visit(i, entry.value());
    }
  }

  template <class = void>
  bool analyse(Matrix const& r) {
    std::size_t const n = std::size_t(size_);
    parent_.assign(n, -1);
    mark_.assign(n, -1);
    filled_.assign(n, 0);
    first_.assign(n + 1, 0);
    for (int k = 0; k < int(size_); ++k)
      reach(r, k, [&](int i, double) {
        for (; mark_[std::size_t(i)] != k; i = parent_[std::size_t(i)]) {
          if (parent_[std::size_t(i)] < 0) parent_[std::size_t(i)] = k;
          ++filled_[std::size_t(i)];
          mark_[std::size_t(i)] = k;
        }
      });
    for (std::size_t k = 0; k < n; ++k) first_[k + 1] = first_[k] + filled_[k];
    if (first_[n] > most_entries) return false;
    row_.assign(std::size_t(first_[n]), 0);
    value_.assign(std::size_t(first_[n]), 0.0);
    return true;
  }

  template <class = void>
  void eliminate(Matrix const& r) {
    std::size_t const n = std::size_t(size_);
    Sequence<double> y(n, 0.0), d(n, 0.0);
    Sequence<int> path(n, 0), pattern(n, 0);
    mark_.assign(n, -1);
    filled_.assign(n, 0);
    negative_.clear();
    zero_ = 0;
    for (int k = 0; k < int(size_); ++k) {
      std::size_t top = n;
      reach(r, k, [&](int i, double value) {
        y[std::size_t(i)] += value;
        std::size_t length = 0;
        for (; mark_[std::size_t(i)] != k; i = parent_[std::size_t(i)]) {
          path[length++] = i;
          mark_[std::size_t(i)] = k;
        }
        while (length > 0) pattern[--top] = path[--length];
      });
      double pivot = r.coeff(order_[std::size_t(k)], order_[std::size_t(k)]), terms = std::abs(pivot);
      for (; top < n; ++top) {
        std::size_t const i = std::size_t(pattern[top]);
        double const yi = y[i], lki = yi / d[i];
        y[i] = 0.0;
        for (Index p = first_[i]; p < first_[i] + filled_[i]; ++p)
          y[std::size_t(row_[std::size_t(p)])] -= value_[std::size_t(p)] * yi;
        pivot -= lki * yi;
        terms += std::abs(lki * yi);
        Index const at = first_[i] + filled_[i]++;
        row_[std::size_t(at)] = k;
        value_[std::size_t(at)] = lki;
      }
      if (std::abs(pivot) <= rounding * terms) {
        ++zero_;
        pivot = terms > 0.0 ? terms : 1.0;
      } else if (pivot < 0.0) {
        negative_.push_back(k);
      }
      d[std::size_t(k)] = pivot;
    }
  }

  Index size_ = 0, zero_ = 0;
  Sequence<int> order_, place_, parent_, mark_, row_;
  Sequence<Index> first_, filled_, negative_;
  Sequence<double> value_;
};

}  // namespace polybody::detail
