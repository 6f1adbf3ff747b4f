#pragma once
#include <Eigen/SparseLU>
#include <memory>
#include <span>

#include <polybody/math/sequence.hpp>
#include <polybody/solvers/sparse_sink.hpp>

namespace polybody {

/// Eigen's sparse LU; the pattern is analysed once and blocks are scattered through a table, without searching. Eigen
/// itself allocates inside `factor`. \tparam Ordering one of Eigen's.
template <class Ordering>
class EigenSparseLuBy {
 public:
  using Matrix = SparseSink::Matrix;  ///< a sparse matrix by columns

  void analyse(Index size, std::span<Block const> blocks) {
    sink_.analyse(size, blocks);
    lu_->analyzePattern(sink_.matrix());
  }
  void begin() { sink_.begin(); }
  void add(Index row, Index col, BlockView const& b) { sink_.add(row, col, b); }
  /// −1, or the first column, as they are eliminated, whose pivot is below 1e-14 of the column's largest entry.
  Index factor() {
    Matrix const& a = sink_.matrix();
    if (a.cols() == 0) return -1;
    lu_->factorize(a);
    auto const& place = lu_->colsPermutation().indices();  // of a column in the order of elimination
    if (lu_->info() != Eigen::Success) {
      // Eigen tells a pivot that is exactly zero by its place, counted from one, at the end of a message.
      std::string const message = lu_->lastErrorMessage();
      std::size_t const first = message.find_last_not_of("0123456789") + 1;
      if (first == message.size()) return 0;
      for (Index i = 0; i < place.size(); ++i)
        if (place[i] + 1 == std::stol(message.substr(first))) return i;
      return 0;
    }
    auto const upper = lu_->matrixU();  // its diagonal stands in the supernodes of L
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
  /// The least pivot of the last factorisation beside the largest entry of its column.
  double least_pivot() const { return least_pivot_; }
  /// ±1, the sign of the determinant.
  double sign_of_determinant() const { return sink_.matrix().cols() == 0 ? 1.0 : lu_->signDeterminant(); }
  void solve(VecX const& b, VecX& x) const {
    if (b.size() > 0) x = lu_->solve(b);
  }
  Matrix const& matrix() const { return sink_.matrix(); }

 private:
  SparseSink sink_;
  double least_pivot_ = 1.0;
  using Lu = Eigen::SparseLU<Matrix, Ordering>;
  std::unique_ptr<Lu> lu_ = std::make_unique<Lu>();  // Eigen's does not move
};

/// Eigen's sparse LU in the order of COLAMD.
using EigenSparseLu = EigenSparseLuBy<Eigen::COLAMDOrdering<int>>;

}  // namespace polybody
