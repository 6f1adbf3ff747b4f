#pragma once
/// \file
/// Where the blocks of a matrix go: one type, whatever receives them, so that who writes a matrix is compiled once.

#include <atomic>
#include <concepts>
#include <cstdint>
#include <utility>

#include <polybody/math/block_view.hpp>
#include <polybody/math/sequence.hpp>

namespace polybody {

/// Place of a block in the matrix.
struct Block {
  Index row, col, rows, cols;  ///< first row and column of the block in the matrix, and its size
};

/// A part of a block and its place in a solver's storage: entry (i, j) is added to to[i stride + j]; transposed, to
/// to[j stride + i].
struct BlockPiece {
  double* to;                ///< the entry of the storage that receives the part's first entry
  int row, col, rows, cols;  ///< the part, within the block
  /// Entries of the storage from one row of the part to the next; from one column to the next if transposed.
  int stride;
  bool transposed;  ///< the storage has the part's columns as rows

  /// Adds the numbers of this part of block b to the storage.
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

/// The pieces of all blocks in the order in which they come: those of block k are [first[k], first[k + 1]).
struct BlockSlots {
  BlockPiece const* pieces = nullptr;  ///< all pieces, block after block
  /// (blocks + 1) number of the first piece of each block; null where a receiver is called for each block.
  int const* first = nullptr;
  std::uint64_t layout = 0;  ///< of the storage: another number for every other one

  /// A number that no layout has had.
  static std::uint64_t new_layout() {
    static std::atomic<std::uint64_t> last{0};
    return ++last;
  }
};

/// A receiver of blocks that is called for each of them: `add(row, col, block)`, always in the same order.
template <class S>
concept TakesBlocks = requires(S target, BlockView const& b) { target.add(Index(0), Index(0), b); };

/// A receiver that takes a block of zeros without its numbers.
template <class S>
concept SkipsZeros = requires(S target) { target.skip(Index(0), Index(0), Index(0), Index(0)); };

/// A receiver that has the numbers of some diagonal blocks already: of those of unknowns that it does not want, `skip`
/// will do.
template <class S>
concept ChoosesBlocks = requires(S target) {
  { target.wants(Index(0), Index(0)) } -> std::convertible_to<bool>;
};

/// A receiver that has laid its storage out: block k goes straight to its slots.
template <class S>
concept OffersSlots = requires(S const target) {
  { target.slots() } -> std::convertible_to<BlockSlots>;
};

/// Passes blocks on to a receiver: into its slots, or by a call for each. The receiver must outlive the sink.
class BlockSink {
 public:
  /// Passes blocks on to `target`: into its slots where it offers any, else by a call of its `add` for each.
  template <TakesBlocks S>
    requires(!std::same_as<std::remove_cvref_t<S>, BlockSink>)
  explicit BlockSink(S& target) : target_(&target) {
    if constexpr (OffersSlots<S>) slots_ = target.slots();
    if constexpr (ChoosesBlocks<S>)
      wants_ = [](void* of, Index first, Index size) -> bool { return static_cast<S*>(of)->wants(first, size); };
    add_ = [](void* to, Index row, Index col, BlockView const& b) { static_cast<S*>(to)->add(row, col, b); };
    skip_ = [](void* to, Index row, Index col, Index rows, Index cols) {
      if constexpr (SkipsZeros<S>) {
        static_cast<S*>(to)->skip(row, col, rows, cols);
      } else {
        static constexpr double zero = 0.0;
        static_cast<S*>(to)->add(row, col, BlockView(&zero, rows, cols, 0, 0));
      }
    };
  }

  /// Adds block b, whose first entry stands at (row, col) of the matrix.
  void add(Index row, Index col, BlockView const& b) {
    if (!slots_.first) return add_(target_, row, col, b);
    int const end = *++slots_.first;
    for (int k = slots_.first[-1]; k < end; ++k) slots_.pieces[k].add(b);
  }
  /// Where the blocks to come go; none where the receiver is called for each.
  BlockSlots const& slots() const { return slots_; }
  /// Whether the numbers of the diagonal block of the unknowns [first, first + size) are of use.
  bool wants(Index first, Index size) const { return !wants_ || wants_(target_, first, size); }
  /// A block of rows × cols zeros: it has its place in the matrix but does not act.
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

/// Whoever writes the blocks of a matrix into a sink: a callable of any type, which must outlive this.
class BlockWriter {
 public:
  /// Stands for f, which is called as f(sink).
  template <class F>
    requires(!std::same_as<std::remove_cvref_t<F>, BlockWriter> && std::invocable<F const&, BlockSink&>)
  BlockWriter(F const& f)  // NOLINT(google-explicit-constructor): stands for the callable
      : what_(&f), call_([](void const* what, BlockSink& sink) { (*static_cast<F const*>(what))(sink); }) {}
  void operator()(BlockSink& sink) const { call_(what_, sink); }  ///< writes all blocks into `sink`

 private:
  void const* what_;
  void (*call_)(void const*, BlockSink&);
};

/// Records where blocks go, in the order in which they come.
struct PatternSink {
  Sequence<Block> blocks;  ///< place and size of each block
  /// Records a block; its numbers are not looked at.
  void add(Index row, Index col, BlockView const& b) { blocks.push_back({row, col, b.rows, b.cols}); }
};

}  // namespace polybody
