#pragma once
/// \file
/// Linear solver `EigenSparseLu` with Eigen's sparse LU factorisation.
/// Theory: Eq. 7.8.

#include <Eigen/SparseLU>
#include <memory>
#include <span>

#include <polybody/math/sequence.hpp>
#include <polybody/solvers/sparse_sink.hpp>

namespace polybody {

/// Eigen's sparse LU factorisation. The pattern is analysed once, and blocks are added without search, by an index
/// table. Eigen itself allocates memory in `factor`. \tparam Ordering an ordering method of Eigen
template <class Ordering>
class EigenSparseLuBy {
 public:
  using Matrix = SparseSink::Matrix;  ///< sparse matrix, stored by columns

  void analyse(Index size, std::span<Block const> blocks) {
    sink_.analyse(size, blocks);
    lu_->analyzePattern(sink_.matrix());
  }
  void begin() { sink_.begin(); }
  void add(Index row, Index col, BlockView const& b) { sink_.add(row, col, b); }
  /// Returns −1 on success, otherwise the index of the first column in elimination order with a pivot of at most 1e-14
  /// times its largest entry.
  Index factor() {
    Matrix const& a = sink_.matrix();
    if (a.cols() == 0) return -1;
    lu_->factorize(a);
    auto const& place = lu_->colsPermutation().indices();  // position of each column in the elimination order
    if (lu_->info() != Eigen::Success) {
      // For a pivot that is exactly zero, Eigen's message ends with the position of the pivot, counted from one.
      std::string const message = lu_->lastErrorMessage();
      std::size_t const first = message.find_last_not_of("0123456789") + 1;
      if (first == message.size()) return 0;
      for (Index i = 0; i < place.size(); ++i)
        if (place[i] + 1 == std::stol(message.substr(first))) return i;
      return 0;
    }
    auto const upper = lu_->matrixU();  // the diagonal of U is stored in the supernodes of L
    Index lost = -1;
    least_pivot_ = 1.0;
    for (Index i = 0; i < a.cols(); ++i) {
      double largest = 0.0, pivot = 0.0;
      for (typename Matrix::InnerIterator entry(a, i); entry; ++entry)
        largest = std::max(largest, std::abs(entry.value()));
      for (typename Lu::SCMatrix::InnerIterator entry(upper.m_mapL, place[i]); entry; ++entry)
        if (entry.index() == place[i]) {
          pivot = entry.value();
          break;
        }
      if (largest > 0.0) least_pivot_ = std::min(least_pivot_, std::abs(pivot) / largest);
      if (!(std::abs(pivot) > 1e-14 * largest) && (lost < 0 || place[i] < place[lost])) lost = i;
    }
    return lost;
  }
  /// Least ratio of a pivot of the last factorisation to the largest entry of its column.
  double least_pivot() const { return least_pivot_; }
  /// Sign of the determinant: −1 or 1; 0 for a zero pivot.
  double sign_of_determinant() const { return sink_.matrix().cols() == 0 ? 1.0 : lu_->signDeterminant(); }
  void solve(VecX const& b, VecX& x) const {
    if (b.size() > 0) x = lu_->solve(b);
  }
  Matrix const& matrix() const { return sink_.matrix(); }

 private:
  SparseSink sink_;
  double least_pivot_ = 1.0;
  using Lu = Eigen::SparseLU<Matrix, Ordering>;
  std::unique_ptr<Lu> lu_ = std::make_unique<Lu>();  // Eigen's class is not movable
};

/// Eigen's sparse LU factorisation in the COLAMD order.
using EigenSparseLu = EigenSparseLuBy<Eigen::COLAMDOrdering<int>>;

}  // namespace polybody
