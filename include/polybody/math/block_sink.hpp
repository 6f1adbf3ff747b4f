#pragma once
/// \file
/// Receivers of matrix blocks, which store or add the blocks of a sparse matrix. `BlockSink` erases the type of the
/// receiver. Code that writes a matrix is therefore compiled only once.

#include <atomic>
#include <concepts>
#include <cstdint>
#include <utility>

#include <polybody/math/sequence.hpp>
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

/// Position and size of a block in the matrix.
struct Block {
  Index row, col, rows, cols;  ///< first row, first column, number of rows and number of columns
};

/// Part of a block and its position in a solver's storage. Entry (i, j) of the part is added to `to[i * stride + j]`,
/// or to `to[j * stride + i]` if `transposed`.
struct BlockPiece {
  double* to;                ///< entry of the storage that receives the first entry of the part
  int row, col, rows, cols;  ///< position and size of the part within the block
  /// Distance between successive rows of the part in the storage, in doubles. Distance between successive columns if
  /// `transposed`.
  int stride;
  bool transposed;  ///< true if the rows of the storage hold the columns of the part

  /// Adds the values of this part of block b to the storage.
  void add(BlockView const& b) const {
    double const* const from = b.data + row * b.row_step + col * b.col_step;
    if (transposed)
      add_runs({from, cols, rows, b.col_step, b.row_step});
    else
      add_runs({from, rows, cols, b.row_step, b.col_step});
  }

 private:
  void add_runs(BlockView const& b) const {
    double* __restrict at = to;
    double const* __restrict from = b.data;
    for (Index i = 0; i < b.rows; ++i, at += stride, from += b.row_step) {
      if (b.col_step == 1)
        for (Index j = 0; j < b.cols; ++j) at[j] += from[j];
      else
        for (Index j = 0; j < b.cols; ++j) at[j] += from[j * b.col_step];
    }
  }
};

/// Positions of the parts of all blocks in a solver's storage. Block k has the parts [first[k], first[k + 1]) of
/// `pieces`.
struct BlockSlots {
  BlockPiece const* pieces = nullptr;  ///< parts of all blocks, in the order of the blocks
  /// (number of blocks + 1) index in `pieces` of the first part of each block. Null if the receiver is called for each
  /// block.
  int const* first = nullptr;
  std::uint64_t layout = 0;  ///< identifier of the storage layout, different for each layout

  /// Returns an identifier that no other layout has.
  static std::uint64_t new_layout() {
    static std::atomic<std::uint64_t> last{0};
    return ++last;
  }
};

/// Receiver with a function `add(row, col, block)`, called for each block, always in the same order.
template <class S>
concept BlockReceiver = requires(S target, BlockView const& b) { target.add(Index(0), Index(0), b); };

/// Receiver with a function `skip(row, col, rows, cols)`, which replaces `add` for a block of zeros.
template <class S>
concept ZeroSkippingReceiver = requires(S target) { target.skip(Index(0), Index(0), Index(0), Index(0)); };

/// Receiver that already contains the values of some diagonal blocks. `wants(first, size)` returns false for the
/// unknowns of such a block. The writer may then call `skip` instead of `add`.
template <class S>
concept SelectiveReceiver = requires(S target) {
  { target.wants(Index(0), Index(0)) } -> std::convertible_to<bool>;
};

/// Receiver with a fixed storage layout, `slots()`. Block k is added directly to its positions in the storage.
template <class S>
concept SlottedReceiver = requires(S const target) {
  { target.slots() } -> std::convertible_to<BlockSlots>;
};

/// Adapter that adds blocks to the storage of a receiver, or calls the receiver for each block. The receiver must
/// outlive the sink.
class BlockSink {
 public:
  /// Sink for `target`. Blocks are added to the positions `target.slots()` if this function exists, otherwise by
  /// `target.add`.
  template <BlockReceiver S>
    requires(!std::same_as<std::remove_cvref_t<S>, BlockSink>)
  explicit BlockSink(S& target) : target_(&target) {
    if constexpr (SlottedReceiver<S>) slots_ = target.slots();
    if constexpr (SelectiveReceiver<S>)
      wants_ = [](void* of, Index first, Index size) -> bool { return static_cast<S*>(of)->wants(first, size); };
    add_ = [](void* to, Index row, Index col, BlockView const& b) { static_cast<S*>(to)->add(row, col, b); };
    skip_ = [](void* to, Index row, Index col, Index rows, Index cols) {
      if constexpr (ZeroSkippingReceiver<S>) {
        static_cast<S*>(to)->skip(row, col, rows, cols);
      } else {
        static constexpr double zero = 0.0;
        static_cast<S*>(to)->add(row, col, BlockView(&zero, rows, cols, 0, 0));
      }
    };
  }

  /// Adds block b with its first entry at (row, col) of the matrix.
  void add(Index row, Index col, BlockView const& b) {
    if (!slots_.first) return add_(target_, row, col, b);
    int const end = *++slots_.first;
    for (int k = slots_.first[-1]; k < end; ++k) slots_.pieces[k].add(b);
  }
  /// Positions of the blocks that are not yet added; empty if the receiver is called for each block.
  BlockSlots const& slots() const { return slots_; }
  /// Returns true if the receiver needs the values of the diagonal block of the unknowns [first, first + size).
  bool wants(Index first, Index size) const { return !wants_ || wants_(target_, first, size); }
  /// Adds a block of rows × cols zeros at (row, col). The block belongs to the sparsity pattern.
  void skip(Index row, Index col, Index rows, Index cols) {
    if (slots_.first)
      ++slots_.first;
    else
      skip_(target_, row, col, rows, cols);
  }

 private:
  void* target_;
  void (*add_)(void*, Index, Index, BlockView const&);
  void (*skip_)(void*, Index, Index, Index, Index);
  bool (*wants_)(void*, Index, Index) = nullptr;
  BlockSlots slots_;
};

/// Type-erased reference to a callable that writes the blocks of a matrix into a sink. The callable must outlive the
/// reference.
class BlockWriter {
 public:
  /// Refers to f, which is called as f(sink).
  template <class F>
    requires(!std::same_as<std::remove_cvref_t<F>, BlockWriter> && std::invocable<F const&, BlockSink&>)
  BlockWriter(F const& f)  // NOLINT(google-explicit-constructor): reference to the callable
      : what_(&f), call_([](void const* what, BlockSink& sink) { (*static_cast<F const*>(what))(sink); }) {}
  void operator()(BlockSink& sink) const { call_(what_, sink); }  ///< writes all blocks into `sink`

 private:
  void const* what_;
  void (*call_)(void const*, BlockSink&);
};

/// Records the positions of blocks in the order of the calls.
struct PatternSink {
  Sequence<Block> blocks;  ///< position and size of each block
  /// Records the position and size of block b at (row, col); its values are not read.
  void add(Index row, Index col, BlockView const& b) { blocks.push_back({row, col, b.rows, b.cols}); }
};

}  // namespace polybody
