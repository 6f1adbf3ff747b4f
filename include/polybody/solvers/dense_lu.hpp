#pragma once
/// \file
/// Linear solver `DenseLu`: LU factorisation of a dense matrix.
/// Theory: Eq. 7.8.

#include <algorithm>
#include <cmath>
#include <cstring>
#include <span>

#include <polybody/math/sequence.hpp>
#include <polybody/solvers/linear_solver.hpp>

namespace polybody {

/// Dense LU factorisation with partial pivoting [Golub & Van Loan 2013, Algorithm 3.4.1], for small systems and as a
/// reference for the other solvers.
class DenseLu {
 public:
  void analyse(Index size, std::span<Block const>) {
    a_.setZero(size, size);
    lu_.assign(std::size_t(size * size), 0.0);
    scale_.assign(std::size_t(size), 0.0);
    swaps_.assign(std::size_t(size), 0);
  }
  void begin() { a_.setZero(); }
  void add(Index row, Index col, BlockView const& b) {
    for (Index j = 0; j < b.cols; ++j)
      for (Index i = 0; i < b.rows; ++i) a_(row + i, col + j) += b(i, j);
  }

  /// Returns −1 on success, otherwise the index of the first column with a pivot of at most 1e-14 times its largest
  /// entry.
  Index factor() {
    Index const n = a_.cols();
    double* const lu = lu_.data();  // by rows
    least_pivot_ = 1.0;
    for (Index j = 0; j < n; ++j) {
      double largest = 0.0;
      for (Index i = 0; i < n; ++i) {
        lu[i * n + j] = a_(i, j);
        largest = std::max(largest, std::abs(a_(i, j)));
      }
      scale_[std::size_t(j)] = largest;
    }
    for (Index k = 0; k < n; ++k) {
      Index best = k;
      for (Index i = k + 1; i < n; ++i)
        if (std::abs(lu[i * n + k]) > std::abs(lu[best * n + k])) best = i;
      double const pivot = std::abs(lu[best * n + k]);
      if (!(pivot > 1e-14 * scale_[std::size_t(k)])) return k;
      least_pivot_ = std::min(least_pivot_, pivot / scale_[std::size_t(k)]);
      swaps_[std::size_t(k)] = best;
      if (best != k) std::swap_ranges(lu + k * n, lu + (k + 1) * n, lu + best * n);
      double const inverse = 1.0 / lu[k * n + k];
      for (Index i = k + 1; i < n; ++i) {
        double const f = lu[i * n + k] *= inverse;
        if (f == 0.0) continue;
        for (Index j = k + 1; j < n; ++j) lu[i * n + j] -= f * lu[k * n + j];
      }
    }
    return -1;
  }

  /// Least ratio of a pivot of the last factorisation to the largest entry of its column.
  double least_pivot() const { return least_pivot_; }
  /// Sign of the determinant: ±1.
  double sign_of_determinant() const {
    Index const n = a_.cols();
    double sign = 1.0;
    for (Index k = 0; k < n; ++k)
      if ((lu_[std::size_t(k * n + k)] < 0.0) != (swaps_[std::size_t(k)] != k)) sign = -sign;
    return sign;
  }

  void solve(VecX const& b, VecX& x) const {
    Index const n = a_.cols();
    double const* const lu = lu_.data();
    x = b;
    for (Index k = 0; k < n; ++k) std::swap(x[k], x[swaps_[std::size_t(k)]]);
    for (Index i = 1; i < n; ++i) {
      double sum = x[i];
      for (Index j = 0; j < i; ++j) sum -= lu[i * n + j] * x[j];
      x[i] = sum;
    }
    for (Index i = n - 1; i >= 0; --i) {
      double sum = x[i];
      for (Index j = i + 1; j < n; ++j) sum -= lu[i * n + j] * x[j];
      x[i] = sum / lu[i * n + i];
    }
  }
  MatX const& matrix() const { return a_; }

 private:
  MatX a_;
  Sequence<double> lu_, scale_;
  Sequence<Index> swaps_;
  double least_pivot_ = 1.0;
};

}  // namespace polybody
