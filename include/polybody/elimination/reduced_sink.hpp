#pragma once
/// \file
/// Sink that adds the blocks b of a full tangent to a reduced system as Pᵀ b P. P relates the full unknowns x to the
/// reduced unknowns y, x = P y. The rows of P for omitted unknowns are zero.

#include <algorithm>
#include <list>

#include <polybody/math/block_sink.hpp>
#include <polybody/math/sequence.hpp>

namespace polybody {

// Destinations of full blocks in the storage of a solver, recorded once. Without them, `MappedSink` looks up each
// block and divides it into runs of reduced unknowns, and the solver divides it among its nodes. A block of a cable
// element becomes about sixty pieces of one to nine entries.

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
  /// Ends the recording of a block of rows×cols entries. A block of more than four pieces with a mean of fewer than
  /// eight entries is scattered entry by entry.
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
    bool scatters;                   ///< true if entries are added one by one, through the targets
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

/// Map from the unknowns of the full system to those of the reduced system.
template <class T = double>  // a template, to be compiled only if it is used
class UnknownMapOf {
 public:
  /// Unknown and its factor.
  struct Target {
    Index unknown;  ///< index in the reduced system
    T factor;       ///< entry of P
  };

  /// `targets[i]` are the reduced unknowns of full unknown i. Most unknowns have one target with factor one. Dependent
  /// unknowns have several targets, and omitted unknowns have none.
  explicit UnknownMapOf(Sequence<Sequence<Target>> targets = {})
      : targets_(std::move(targets)), run_end_(targets_.size()) {
    for (std::size_t i = targets_.size(); i-- > 0;) {
      bool const goes_on = i + 1 < targets_.size() && plain(i) && plain(i + 1) &&
                           targets_[i + 1][0].unknown == targets_[i][0].unknown + 1;
      run_end_[i] = !plain(i) ? Index(i) : goes_on ? run_end_[i + 1] : Index(i) + 1;
    }
  }

  /// Target of full unknown `first` if the `size` unknowns from `first` on have consecutive targets with factor one;
  /// otherwise −1.
  Index run(Index first, Index size) const {
    return run_end_[std::size_t(first)] >= first + size ? targets_[std::size_t(first)][0].unknown : -1;
  }
  /// Number of full unknowns.
  Index size() const { return Index(targets_.size()); }
  /// Reduced unknowns of full unknown i, with their factors.
  Sequence<Target> const& targets(Index i) const { return targets_[std::size_t(i)]; }

  /// Range of full unknowns with their reduced unknowns, which have local numbers 0, 1, … in ascending order.
  struct Range {
    /// Consecutive reduced unknowns of the range.
    struct Run {
      Index first, size, local;  ///< first reduced unknown, number of unknowns, local number of the first
    };
    /// Consecutive full unknowns with consecutive targets and factor one.
    struct Part {
      Index first, size, source;  ///< first target, number of unknowns, index of the first full unknown in the range
    };
    Index full_size = 0, size = 0;       ///< number of full unknowns, and of reduced unknowns
    Sequence<Run> runs;                  ///< all reduced unknowns of the range, ascending
    Sequence<Sequence<Target>> targets;  ///< targets of each full unknown, by local number
    Sequence<Part> parts;                ///< all unknowns with targets, if `copied` is true
    bool copied = false;  ///< true if each full unknown of the range has at most one target, with factor one
  };
  /// Range of the `size` full unknowns from `first` on. Searches and allocates.
  Range range(Index first, Index size) const {
    Sequence<Index> touched;
    for (Index i = first; i < first + size; ++i)
      for (Target const& t : targets(i)) touched.push_back(t.unknown);
    sort_once(touched);
    auto const local = [&](Index unknown) {
      return Index(std::lower_bound(touched.begin(), touched.end(), unknown) - touched.begin());
    };
    Range out;
    for (Index const unknown : touched) {
      Index const number = out.size++;
      if (!out.runs.empty() && out.runs.back().first + out.runs.back().size == unknown)
        ++out.runs.back().size;
      else
        out.runs.push_back({unknown, 1, number});
    }
    out.copied = true;
    for (Index i = first; i < first + size; ++i) {
      out.targets.emplace_back();
      for (Target const& t : targets(i)) out.targets.back().push_back({local(t.unknown), t.factor});
      out.copied = out.copied && (targets(i).empty() || plain(std::size_t(i)));
    }
    out.full_size = size;
    for (Index i = 0; i < size && out.copied; ++i) {
      if (targets(first + i).empty()) continue;
      Index const to = targets(first + i)[0].unknown;
      if (!out.parts.empty() && out.parts.back().source + out.parts.back().size == i &&
          out.parts.back().first + out.parts.back().size == to)
        ++out.parts.back().size;
      else
        out.parts.push_back({to, 1, i});
    }
    return out;
  }

 private:
  bool plain(std::size_t i) const { return targets_[i].size() == 1 && targets_[i][0].factor == 1.0; }
  Sequence<Sequence<Target>> targets_;
  Sequence<Index> run_end_;  // end of the run (see `run`) that contains unknown i; i if no run contains it
};

/// Cache that reduced sinks reuse in every assembly: ranges of unknowns, and workspace for blocks, by rows.
template <class T = double>
struct ReducedBlocksOf {
  Sequence<std::list<typename UnknownMapOf<T>::Range>> ranges;  ///< previous ranges by their first full unknown
  Sequence<T> half, full;                                       ///< Pᵀ b; Pᵀ b P

  /// Sets the first `size` entries of `workspace` to zero and returns them. The workspace grows if
  /// necessary.
  static T* zeros(Sequence<T>& workspace, Index size) {
    if (workspace.size() < std::size_t(size)) workspace.resize(std::size_t(size));
    std::fill_n(workspace.begin(), size, 0.0);
    return workspace.data();
  }
};

/// Sink that adds blocks of the full system to the matrix of a time step's reduced unknowns.
template <class T = double>
class ReducedSinkOf {
  using Map = UnknownMapOf<T>;
  using Kept = ReducedBlocksOf<T>;
  using Range = typename Map::Range;
  using Target = typename Map::Target;

 public:
  /// \param slots recorder of the destinations of all blocks; null if they are not recorded
  ReducedSinkOf(Map const& map, Kept& kept, BlockSink& sink, ReducedSlotsOf<T>* slots = nullptr)
      : map_(map), kept_(kept), sink_(sink), slots_(slots) {
    kept_.ranges.resize(std::size_t(map.size()));
  }

  /// Adds Pᵀ b P for a block b of the full system whose first entry is at (row, col).
  void add(Index row, Index col, BlockView const& b) {
    if (slots_) [[unlikely]]
      record(row, col, b.rows, b.cols);
    Index const to_row = map_.run(row, b.rows), to_col = map_.run(col, b.cols);
    if (to_row >= 0 && to_col >= 0) {
      sink_.add(to_row, to_col, b);
      return;
    }
    Range const& rows = range(row, b.rows);
    Range const& cols = range(col, b.cols);
    if (rows.size == 0 || cols.size == 0) return;
    if (rows.copied && cols.copied) {
      for (auto const& r : rows.parts)
        for (auto const& c : cols.parts)
          sink_.add(r.first, c.first,
                    {b.data + r.source * b.row_step + c.source * b.col_step, r.size, c.size, b.row_step, b.col_step});
      return;
    }
    double* const full = Kept::zeros(kept_.full, rows.size * cols.size);
    multiply(b, rows, cols, full);
    for (auto const& r : rows.runs)
      for (auto const& c : cols.runs)
        sink_.add(r.first, c.first, BlockView(full + r.local * cols.size + c.local, r.size, c.size, cols.size, 1));
  }
  /// True if the slots have recorded all blocks. This requires that every block is copied without factors.
  bool recorded() const { return slots_ && copies_; }
  /// True if the receiver needs the values of the diagonal block of the full unknowns [first, first + size).
  bool wants(Index first, Index size) {
    if (Index const to = map_.run(first, size); to >= 0) return sink_.wants(to, size);
    auto const& runs = range(first, size).runs;
    return runs.empty() || sink_.wants(runs[0].first, runs[0].size);
  }
  /// Adds a block of height × width zeros at (row, col).
  void skip(Index row, Index col, Index height, Index width) {
    if (slots_) [[unlikely]]
      record(row, col, height, width);
    Index const to_row = map_.run(row, height), to_col = map_.run(col, width);
    if (to_row >= 0 && to_col >= 0) return sink_.skip(to_row, to_col, height, width);
    Range const &rows = range(row, height), &cols = range(col, width);
    if (rows.copied && cols.copied)
      skip_all(rows.parts, cols.parts);
    else
      skip_all(rows.runs, cols.runs);
  }

 private:
  [[gnu::cold]] void record(Index row, Index col, Index height, Index width) {
    if (!copies_) return;
    slots_->begin_block();
    if (map_.run(row, height) >= 0 && map_.run(col, width) >= 0) {
      slots_->take(0, 0);
    } else {
      Range const &rows = range(row, height), &cols = range(col, width);
      copies_ = (rows.copied && cols.copied) || rows.size == 0 || cols.size == 0;
      if (!copies_) return;
      for (auto const& r : rows.parts)
        for (auto const& c : cols.parts) slots_->take(r.source, c.source);
    }
    slots_->end_block(height, width);
  }
  template <class Ranges>
  void skip_all(Ranges const& rows, Ranges const& cols) {
    for (auto const& r : rows)
      for (auto const& c : cols) sink_.skip(r.first, c.first, r.size, c.size);
  }
  void multiply(BlockView const& b, Range const& rows, Range const& cols, double* full) {
    double* const half = Kept::zeros(kept_.half, rows.size * b.cols);
    for (Index i = 0; i < b.rows; ++i)
      for (Target const& t : rows.targets[std::size_t(i)])
        for (Index j = 0; j < b.cols; ++j) half[t.unknown * b.cols + j] += t.factor * b(i, j);
    for (Index j = 0; j < b.cols; ++j)
      for (Target const& t : cols.targets[std::size_t(j)])
        for (Index i = 0; i < rows.size; ++i) full[i * cols.size + t.unknown] += t.factor * half[i * b.cols + j];
  }

  /// Range of unknowns, computed in the first assembly and cached for later ones.
  Range const& range(Index first, Index size) {
    auto& known = kept_.ranges[std::size_t(first)];
    for (Range const& r : known)
      if (r.full_size == size) return r;
    return known.emplace_back(map_.range(first, size));
  }

  Map const& map_;
  Kept& kept_;
  BlockSink& sink_;
  ReducedSlotsOf<T>* slots_;
  bool copies_ = true;
};

using UnknownMap = UnknownMapOf<>;       ///< map with factors in doubles
using MappedBlocks = ReducedBlocksOf<>;  ///< cache with blocks of doubles
using MappedSink = ReducedSinkOf<>;      ///< sink with blocks of doubles

}  // namespace polybody
