#pragma once
/// \file
/// Destinations of full blocks in the storage of a solver, recorded once. Without them, `MappedSink` looks up each
/// block and divides it into runs of reduced unknowns, and the solver divides it among its nodes. A block of a cable
/// element becomes about sixty pieces of one to nine entries.

#include <polybody/math/block_sink.hpp>
#include <polybody/math/sequence.hpp>

namespace polybody {

/// Receiver that adds full blocks to recorded destinations, in the order of recording.
template <class T = double>  // a template, to be compiled only if it is used
class ReducedSlotsOf {
 public:
  ReducedSlotsOf() = default;
  ReducedSlotsOf(ReducedSlotsOf const&) = delete;  // targets point into `nowhere_`
  ReducedSlotsOf& operator=(ReducedSlotsOf const&) = delete;
  ReducedSlotsOf(ReducedSlotsOf&&) = default;             ///< pointers to targets remain valid
  ReducedSlotsOf& operator=(ReducedSlotsOf&&) = default;  ///< pointers to targets remain valid

  /// True if the destinations of all blocks in the storage layout `layout` are recorded.
  bool leads_to(std::uint64_t layout) const { return complete_ && layout_ == layout; }

  /// Begins the recording, in the first assembly. \param slots slots of the receiver before the first block
  void record(BlockSlots const& slots) {
    slots_ = slots;
    layout_ = slots.layout;
    complete_ = false;
    pieces_.clear();
    targets_.clear();
    blocks_.clear();
  }
  /// Begins the recording of the next full block. `take` records its parts.
  void begin_block() { first_ = pieces_.size(); }
  /// Records that the next block of the receiver is the part of the full block from (row, col) on.
  void take(Index row, Index col) {
    int const end = *++slots_.first;
    for (int k = slots_.first[-1]; k < end; ++k) {
      pieces_.push_back(slots_.pieces[k]);
      pieces_.back().row += int(row);
      pieces_.back().col += int(col);
    }
  }
  /// Ends the recording of a block of rows×cols entries. A block of many small pieces is scattered entry by entry.
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
  /// Ends the recording.
  void complete() { complete_ = true; }

  /// Begins a later assembly with the first block.
  void begin() { next_ = 0; }
  /// Adds the next block to the receiver's storage, at the recorded destinations.
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
  /// Skips the next block, which is zero.
  void skip(Index, Index, Index, Index) { ++next_; }

 private:
  struct Block {
    std::size_t first, end, target;  ///< range of pieces, and index of the first target
    bool scatters;                   ///< true if the targets are used, not the pieces
  };
  BlockSlots slots_;
  std::uint64_t layout_ = 0;
  bool complete_ = false;
  Sequence<Block> blocks_;
  Sequence<BlockPiece> pieces_;
  Sequence<T*> targets_;                  // destinations of single entries, row by row
  Sequence<T> nowhere_ = Sequence<T>(1);  // destination of entries without a piece
  std::size_t first_ = 0, next_ = 0;
};

using MappedSlots = ReducedSlotsOf<>;  ///< receiver of blocks of doubles

}  // namespace polybody
