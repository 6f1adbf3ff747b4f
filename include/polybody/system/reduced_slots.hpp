#pragma once
/// \file
/// The way of whole blocks through a map of unknowns into the storage of a solver, found once: `MappedSink` looks up
/// each block and cuts it where its unknowns part, and the solver cuts it where its nodes do. What an element of a
/// cable leaves after that are some sixty pieces of one to nine entries.

#include <polybody/math/block_sink.hpp>
#include <polybody/math/sequence.hpp>

namespace polybody {

/// Receives whole blocks in the order in which it was told of them.
template <class T = double>  // compiled where it is used
class ReducedSlotsOf {
 public:
  ReducedSlotsOf() = default;
  ReducedSlotsOf(ReducedSlotsOf const&) = delete;  // its targets point to its own
  ReducedSlotsOf& operator=(ReducedSlotsOf const&) = delete;
  ReducedSlotsOf(ReducedSlotsOf&&) = default;             ///< the targets stay where they are
  ReducedSlotsOf& operator=(ReducedSlotsOf&&) = default;  ///< the targets stay where they are

  /// It has been told of all blocks that go into this layout.
  bool leads_to(std::uint64_t layout) const { return complete_ && layout_ == layout; }

  /// The first pass. \param slots of the receiver, where it begins to write
  void record(BlockSlots const& slots) {
    slots_ = slots;
    layout_ = slots.layout;
    complete_ = false;
    pieces_.clear();
    targets_.clear();
    blocks_.clear();
  }
  /// The first pass comes to the next whole block; its parts follow by `take`.
  void begin_block() { first_ = pieces_.size(); }
  /// The next block of the receiver takes the part of the whole one from (row, col) on.
  void take(Index row, Index col) {
    int const end = *++slots_.first;
    for (int k = slots_.first[-1]; k < end; ++k) {
      pieces_.push_back(slots_.pieces[k]);
      pieces_.back().row += int(row);
      pieces_.back().col += int(col);
    }
  }
  /// That was all of this block of rows×cols entries. What is cut into many small pieces is scattered entry by entry.
  void end_block(Index rows, Index cols) {
    std::size_t const count = pieces_.size() - first_;
    bool const scatters = count > 4 && std::size_t(rows * cols) < 8 * count;
    blocks_.push_back({first_, pieces_.size(), targets_.size(), scatters});
    if (!scatters) return;
    std::size_t const at = targets_.size();
    targets_.resize(at + std::size_t(rows * cols), nowhere_.data());
    for (std::size_t k = first_; k < pieces_.size(); ++k) {
      BlockPiece const& p = pieces_[k];
      for (int i = 0; i < p.rows; ++i)
        for (int j = 0; j < p.cols; ++j)
          targets_[at + std::size_t((p.row + i) * cols + p.col + j)] =
              p.to + (p.transposed ? j * p.stride + i : i * p.stride + j);
    }
    pieces_.resize(first_);
    blocks_.back().end = first_;
  }
  /// The first pass has ended: all blocks are known.
  void complete() { complete_ = true; }

  /// The blocks come anew, from the first on.
  void begin() { next_ = 0; }
  /// Adds the next block to the receiver's storage; places were found in the first pass.
  void add(Index, Index, BlockView const& b) {
    Block const& block = blocks_[next_++];
    for (std::size_t k = block.first; k < block.end; ++k) pieces_[k].add(b);
    if (!block.scatters) return;
    T* const* to = targets_.data() + block.target;
    for (Index i = 0; i < b.rows; ++i) {
      T const* from = b.data + i * b.row_step;
      for (Index j = 0; j < b.cols; ++j, from += b.col_step) *to[j] += *from;
      to += b.cols;
    }
  }
  /// The next block is zero.
  void skip(Index, Index, Index, Index) { ++next_; }

 private:
  struct Block {
    std::size_t first, end, target;  ///< pieces, or where its entries go
    bool scatters;
  };
  BlockSlots slots_;
  std::uint64_t layout_ = 0;
  bool complete_ = false;
  Sequence<Block> blocks_;
  Sequence<BlockPiece> pieces_;
  Sequence<T*> targets_;  // of entries, row by row
  Sequence<T> nowhere_ = Sequence<T>(1);
  std::size_t first_ = 0, next_ = 0;
};

using MappedSlots = ReducedSlotsOf<>;  ///< in doubles

}  // namespace polybody
