#pragma once
#include <algorithm>

#include <polybody/math/sequence.hpp>
#include <polybody/math/types.hpp>

namespace polybody {

/// Selection of the pairs of a model's force groups that have blocks in a matrix with many evaluations. A pair is
/// selected if it touched in a recent evaluation, or if such a pair has the same contact partner and a neighbouring
/// marker. Neighbours are included because, for example, links of a track touch one after another.
class ActiveContactPairs {
 public:
  /// Pairs of one group. The pair of marker i of the many and partner j has the number i few + j.
  struct Group {
    Index few = 0;              ///< number of partners; 0 if unknown: pairs then have no neighbours
    Sequence<char> has_blocks;  ///< for each pair: it has blocks
    Sequence<long> touched;     ///< for each pair: number of the last evaluation in which it touched
  };

  /// Starts an evaluation of the matrix.
  void begin() {
    next_ = 0;
    lacks_ = false;
    ++writing_;
  }
  /// Returns the next group of the model. \param few number of its partners, 0 if unknown
  Group& group(Index few) {
    if (next_ == groups_.size()) groups_.push_back({few, {}, {}});
    return groups_[next_++];
  }
  /// Records the contact `touches` of pair k of a group. Returns true if the pair has blocks.
  bool note(Group& group, std::size_t k, bool touches) {
    if (k == group.has_blocks.size()) {
      group.has_blocks.push_back(0);
      group.touched.push_back(-kept);
    }
    if (touches) group.touched[k] = writing_;
    if (touches && !group.has_blocks[k]) lacks_ = true;
    return group.has_blocks[k];
  }
  /// In the last evaluation a pair without blocks touched.
  bool lacks() const { return lacks_; }
  /// Selects the pairs that touched recently and their neighbours. This changes the sparsity pattern of the matrix.
  void hold() {
    for (Group& g : groups_) {
      std::fill(g.has_blocks.begin(), g.has_blocks.end(), char(0));
      Index const pairs = Index(g.has_blocks.size());
      for (Index k = 0; k < pairs; ++k)
        if (writing_ - g.touched[std::size_t(k)] < kept)
          for (Index i = -neighbours; i <= neighbours; ++i)
            if (Index const other = k + i * g.few; other >= 0 && other < pairs) g.has_blocks[std::size_t(other)] = 1;
    }
    lacks_ = false;
  }

 private:
  static constexpr Index neighbours = 2;  // neighbouring markers on each side
  static constexpr long kept = 50;        // evaluations for which a separated pair keeps its blocks: it may touch again

  Sequence<Group> groups_;
  std::size_t next_ = 0;
  long writing_ = 0;
  bool lacks_ = false;
};

}  // namespace polybody
