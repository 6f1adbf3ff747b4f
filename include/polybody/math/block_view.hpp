#pragma once
#include <polybody/math/types.hpp>

namespace polybody {

/// A dense block wherever it stands in memory, also transposed. Not an Eigen expression, so that a sink is compiled
/// once and not for every shape of block.
struct BlockView {
  double const* data;
  Index rows, cols, row_step, col_step;

  template <class D>
    requires(bool(D::Flags& Eigen::DirectAccessBit))
  BlockView(Eigen::MatrixBase<D> const& m)  // NOLINT(google-explicit-constructor): a view of a matrix
      : data(m.derived().data()),
        rows(m.rows()),
        cols(m.cols()),
        row_step(D::IsRowMajor ? m.derived().outerStride() : m.derived().innerStride()),
        col_step(D::IsRowMajor ? m.derived().innerStride() : m.derived().outerStride()) {}

  BlockView(double const* first, Index height, Index width, Index down, Index right)
      : data(first), rows(height), cols(width), row_step(down), col_step(right) {}

  BlockView transposed() const { return {data, cols, rows, col_step, row_step}; }
  double operator()(Index i, Index j) const { return data[i * row_step + j * col_step]; }
};

}  // namespace polybody
