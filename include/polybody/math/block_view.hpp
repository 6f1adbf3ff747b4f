#pragma once
#include <polybody/math/types.hpp>

namespace polybody {

/// View of a dense matrix block in memory, with arbitrary strides. The type does not depend on the size of the block. A
/// sink is therefore compiled once and not for each size.
struct BlockView {
  double const* data;                    ///< first entry of the block
  Index rows, cols, row_step, col_step;  ///< size; distances in memory between successive rows and columns, in doubles

  /// View of `m`: a matrix, a block of a matrix, or a map. The entries of `m` must be in memory, and `m` must outlive
  /// the view.
  template <class D>
    requires(bool(D::Flags& Eigen::DirectAccessBit))
  BlockView(Eigen::MatrixBase<D> const& m)  // NOLINT(google-explicit-constructor): a view of a matrix
      : data(m.derived().data()),
        rows(m.rows()),
        cols(m.cols()),
        row_step(D::IsRowMajor ? m.derived().outerStride() : m.derived().innerStride()),
        col_step(D::IsRowMajor ? m.derived().innerStride() : m.derived().outerStride()) {}

  /// View of `height` rows and `width` columns with the first entry at `first`. Successive rows are `down` doubles
  /// apart, successive columns `right` doubles.
  BlockView(double const* first, Index height, Index width, Index down, Index right)
      : data(first), rows(height), cols(width), row_step(down), col_step(right) {}

  /// View of the same memory with rows and columns exchanged.
  BlockView transposed() const { return {data, cols, rows, col_step, row_step}; }
  /// Entry (i, j), counted from zero.
  double operator()(Index i, Index j) const { return data[i * row_step + j * col_step]; }
};

}  // namespace polybody
