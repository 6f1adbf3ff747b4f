#pragma once
#include <polybody/math/types.hpp>

namespace polybody {

/// A dense block wherever it stands in memory, also transposed. Not an Eigen expression, so that a sink is compiled
/// once and not for every shape of block.
struct BlockView {
  double const* data;                    ///< first entry of the block
  Index rows, cols, row_step, col_step;  ///< how many; how many doubles from one to the next in memory

  /// The matrix `m`, or a part or map of one, with direct access to its memory; it must outlive the view.
  template <class D>
    requires(bool(D::Flags& Eigen::DirectAccessBit))
  BlockView(Eigen::MatrixBase<D> const& m)  // NOLINT(google-explicit-constructor): a view of a matrix
      : data(m.derived().data()),
        rows(m.rows()),
        cols(m.cols()),
        row_step(D::IsRowMajor ? m.derived().outerStride() : m.derived().innerStride()),
        col_step(D::IsRowMajor ? m.derived().innerStride() : m.derived().outerStride()) {}

  /// `height` rows of `width` columns from `first` on; `down` doubles from row to row, `right` from column to column.
  BlockView(double const* first, Index height, Index width, Index down, Index right)
      : data(first), rows(height), cols(width), row_step(down), col_step(right) {}

  /// The same memory with rows and columns exchanged.
  BlockView transposed() const { return {data, cols, rows, col_step, row_step}; }
  /// Entry (i, j), counted from zero.
  double operator()(Index i, Index j) const { return data[i * row_step + j * col_step]; }
};

}  // namespace polybody
