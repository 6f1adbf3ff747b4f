#pragma once
/// \file
/// A sink between the blocks of a whole tangent and a system in which some unknowns depend on others, x = P y, and some rows are left
/// out: blocks arrive as Pᵀ b P.

#include <map>

#include <polybody/math/block_view.hpp>
#include <polybody/system/tangent.hpp>

namespace polybody {

/// Where the unknowns of a whole system go.
class UnknownMap {
 public:
  struct Target {
    Index unknown;
    double factor;
  };

  /// `targets[i]` of whole unknown i: one with factor one for most, several for a dependent one, none for one that is left out.
  explicit UnknownMap(std::vector<std::vector<Target>> targets = {}) : targets_(std::move(targets)), run_end_(targets_.size()) {
    for (std::size_t i = targets_.size(); i-- > 0;) {
      bool const goes_on = i + 1 < targets_.size() && plain(i) && plain(i + 1) &&
                           targets_[i + 1][0].unknown == targets_[i][0].unknown + 1;
      run_end_[i] = !plain(i) ? Index(i) : goes_on ? run_end_[i + 1] : Index(i) + 1;
    }
  }

  /// The first of `size` unknowns that follow one another there as here; −1 where they do not.
  Index run(Index first, Index size) const {
    return run_end_[std::size_t(first)] >= first + size ? targets_[std::size_t(first)][0].unknown : -1;
  }
  /// Of unknown i.
  std::vector<Target> const& targets(Index i) const { return targets_[std::size_t(i)]; }

  /// All unknowns that a range touches, in runs.
  struct Range {
    struct Run {
      Index first, size, local;
    };
    std::vector<Run> runs;
    std::vector<std::vector<Target>> targets;  ///< of each whole unknown, by local number
    Index size = 0;
  };
  Range range(Index first, Index size) const {
    std::map<Index, Index> local;
    for (Index i = first; i < first + size; ++i)
      for (Target const& t : targets(i)) local[t.unknown] = 0;
    Range out;
    for (auto& [unknown, number] : local) {
      number = out.size++;
      if (!out.runs.empty() && out.runs.back().first + out.runs.back().size == unknown)
        ++out.runs.back().size;
      else
        out.runs.push_back({unknown, 1, number});
    }
    for (Index i = first; i < first + size; ++i) {
      out.targets.emplace_back();
      for (Target const& t : targets(i)) out.targets.back().push_back({local.at(t.unknown), t.factor});
    }
    return out;
  }

 private:
  bool plain(std::size_t i) const { return targets_[i].size() == 1 && targets_[i][0].factor == 1.0; }
  std::vector<std::vector<Target>> targets_;
  std::vector<Index> run_end_;  // behind the last unknown of the run that i is in; i itself when it is not plain
};

/// What a mapped sink keeps from pass to pass.
struct MappedBlocks {
  std::map<std::pair<Index, Index>, UnknownMap::Range> ranges;
  MatX half, whole;
};

template <class Sink>
class MappedSink {
 public:
  MappedSink(UnknownMap const& map, MappedBlocks& kept, Sink& sink) : map_(map), kept_(kept), sink_(sink) {}

  void add(Index row, Index col, BlockView const& b) {
    Index const to_row = map_.run(row, b.rows), to_col = map_.run(col, b.cols);
    if (to_row >= 0 && to_col >= 0) {
      sink_.add(to_row, to_col, b);
      return;
    }
    UnknownMap::Range const& rows = range(row, b.rows);
    UnknownMap::Range const& cols = range(col, b.cols);
    MatX& half = kept_.half;
    MatX& whole = kept_.whole;
    half.setZero(rows.size, b.cols);
    for (Index i = 0; i < b.rows; ++i)
      for (UnknownMap::Target const& t : rows.targets[std::size_t(i)])
        for (Index j = 0; j < b.cols; ++j) half(t.unknown, j) += t.factor * b(i, j);
    whole.setZero(rows.size, cols.size);
    for (Index j = 0; j < b.cols; ++j)
      for (UnknownMap::Target const& t : cols.targets[std::size_t(j)])
        for (Index i = 0; i < rows.size; ++i) whole(i, t.unknown) += t.factor * half(i, j);
    for (auto const& r : rows.runs)
      for (auto const& c : cols.runs) sink_.add(r.first, c.first, whole.block(r.local, c.local, r.size, c.size));
  }

 private:
  /// Found in the first pass, kept for the others.
  UnknownMap::Range const& range(Index first, Index size) {
    auto const found = kept_.ranges.find({first, size});
    if (found != kept_.ranges.end()) return found->second;
    return kept_.ranges.emplace(std::pair(first, size), map_.range(first, size)).first->second;
  }

  UnknownMap const& map_;
  MappedBlocks& kept_;
  Sink& sink_;
};

}  // namespace polybody
