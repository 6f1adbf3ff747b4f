#pragma once

#include <polybody/math/block_sink.hpp>
#include <polybody/math/sequence.hpp>

namespace polybody {

/// [TᵀKT, (G T)ᵀ; G T, 0] as a dense matrix from the blocks of [K, Gᵀ; G, 0]: itself the sink of these. Of the rows
/// those that stay are taken.
/// Compiled where it is used.
template <class T = double>
class DenseReductionOf {
 public:
  DenseReductionOf() = default;
  /// For `full_velocities` of a model and `velocities` of a step. \param row_of where each row of the model goes among
  /// `rows`; −1 where it is left out
  DenseReductionOf(Index full_velocities, Index velocities, Index rows, Sequence<Index> row_of)
      : row_of_(std::move(row_of)),
        velocities_(full_velocities),
        transposed_(MatXOf<T>::Zero(velocities, full_velocities)),
        k_(MatXOf<T>::Zero(velocities, velocities)),
        g_(MatXOf<T>::Zero(rows, velocities)),
        half_(VecXOf<T>::Zero(velocities)) {}

  /// Column j of T is `column` (speeds of the whole model).
  void set_column(Index j, VecX const& column) {
    for (Index i = 0; i < column.size(); ++i) transposed_(j, i) = column[i];
  }
  /// All entries are zero; T stays.
  void begin() {
    k_.setZero();
    g_.setZero();
  }
  /// Adds the block b of the whole matrix, whose first entry is at (row, col); that of Gᵀ is taken from G.
  void add(Index row, Index col, BlockView const& b) {
    if (col >= velocities_) return;  // the mirror of G
    for (Index i = 0; i < b.rows; ++i) {
      Index const at = row + i;
      Index const to = at < velocities_ ? at : row_of_[std::size_t(at - velocities_)];
      if (to < 0) continue;
      half_.setZero();  // row i of b T
      for (Index j = 0; j < b.cols; ++j)
        if (double const e = b(i, j); e != 0.0) half_ += e * transposed_.col(col + j);
      if (at >= velocities_) {
        for (Index j = 0; j < half_.size(); ++j) g_(to, j) += half_[j];
        continue;
      }
      for (Index j = 0; j < half_.size(); ++j)
        if (double const e = half_[j]; e != 0.0) k_.col(j) += e * transposed_.col(at);
    }
  }
  /// The matrix, block by block.
  void write(BlockSink& sink) const {
    sink.add(0, 0, k_);
    if (g_.rows() == 0) return;
    sink.add(0, k_.rows(), g_.transpose());
    sink.add(k_.rows(), 0, g_);
  }

 private:
  Sequence<Index> row_of_;
  Index velocities_ = 0;
  MatXOf<T> transposed_, k_, g_;
  VecXOf<T> half_;
};

using DenseReduction = DenseReductionOf<>;  ///< in doubles

}  // namespace polybody
