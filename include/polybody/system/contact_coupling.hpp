#pragma once
#include <polybody/math/block_sink.hpp>
#include <polybody/math/sequence.hpp>
#include <polybody/math/types.hpp>

namespace polybody {

/// Blocks K_ab of a symmetric tangent that couple the two bodies of each contact of a contact set. Time steps do not
/// factorise these blocks, because they change with the contacts and fill in. The conjugate gradient method includes
/// them in the solution (`StepTangent`). Further memory is allocated only if an evaluation has more blocks than all
/// before.
class ContactCoupling {
 public:
  void clear() { blocks_.clear(), values_.clear(); }  ///< removes all blocks
  bool empty() const { return blocks_.empty(); }      ///< true without blocks
  /// Allocates memory for `blocks` blocks of 6 rows and 6 columns.
  void reserve(Index blocks) {
    blocks_.reserve(std::size_t(blocks));
    values_.reserve(std::size_t(36 * blocks));
  }
  /// Adds the block b and its transposed block, whose first entries are at (row, col) and (col, row) of the tangent.
  void add(Index row, Index col, BlockView const& b) {
    blocks_.push_back({row, col, b.rows, b.cols});
    for (Index i = 0; i < b.rows; ++i)
      for (Index j = 0; j < b.cols; ++j) values_.push_back(b(i, j));
  }
  /// Adds the product of all blocks and x (nv) to y (nv).
  template <class = void>  // compiled where it is used
  void add_product(VecX const& x, VecX& y) const {
    double const* value = values_.data();
    for (Block const& b : blocks_) {
      double const *const xa = x.data() + b.row, *const xb = x.data() + b.col;
      double *const ya = y.data() + b.row, *const yb = y.data() + b.col;
      for (Index i = 0; i < b.rows; ++i, value += b.cols) {
        double sum = 0.0;
        for (Index j = 0; j < b.cols; ++j) {
          sum += value[j] * xb[j];
          yb[j] += value[j] * xa[i];
        }
        ya[i] += sum;
      }
    }
  }

 private:
  Sequence<Block> blocks_;
  Sequence<double> values_;  // of all blocks, by rows
};

}  // namespace polybody
