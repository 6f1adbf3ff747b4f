#pragma once

#include <polybody/math/block_sink.hpp>
#include <polybody/math/sequence.hpp>

namespace polybody {

/// Dense matrix [TᵀKT, (G T)ᵀ; G T, 0] for the reduced velocities u (v = T u) and the remaining constraint equations.
/// It is assembled from the blocks of [K, Gᵀ; G, 0]. As a template, the class is compiled only if it is used.
template <class T = double>
class DenseReductionOf {
 public:
  DenseReductionOf() = default;
  /// \param full_velocities number of velocities of the model \param velocities number of velocities of a step
  /// \param rows number of constraint equations of a step \param row_of index of each equation of the model among the
  /// equations of a step; −1 if it is eliminated
  DenseReductionOf(Index full_velocities, Index velocities, Index rows, Sequence<Index> row_of)
      : row_of_(std::move(row_of)),
        velocities_(full_velocities),
        transposed_(MatXOf<T>::Zero(velocities, full_velocities)),
        k_(MatXOf<T>::Zero(velocities, velocities)),
        g_(MatXOf<T>::Zero(rows, velocities)),
        half_(VecXOf<T>::Zero(velocities)) {}

  /// Sets column j of T to `column` (nv of the model).
  void set_column(Index j, VecX const& column) {
    for (Index i = 0; i < column.size(); ++i) transposed_(j, i) = column[i];
  }
  /// Sets all entries to zero, but keeps T.
  void begin() {
    k_.setZero();
    g_.setZero();
  }
  /// Adds block b of the full matrix with its first entry at (row, col). Blocks of Gᵀ are ignored, because blocks of G
  /// have the same entries.
  void add(Index row, Index col, BlockView const& b) {
    if (col >= velocities_) return;  // block of Gᵀ
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
  /// Writes the blocks of the matrix into `sink`.
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

using DenseReduction = DenseReductionOf<>;  ///< dense reduction of doubles

}  // namespace polybody
