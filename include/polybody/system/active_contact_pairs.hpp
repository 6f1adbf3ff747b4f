#pragma once
/// \file
/// Selection of the contact pairs of force groups that have blocks in a matrix.

#include <algorithm>

#include <polybody/math/sequence.hpp>
#include <polybody/math/types.hpp>

namespace polybody {

/// Selects contact pairs of force groups. Only the selected pairs have blocks in a matrix that is evaluated repeatedly.
/// A pair is selected if it was in contact in one of the last 50 evaluations. It is also selected if a marker at most
/// two places before or after its marker was in contact with the same partner. Neighbours are included because, for
/// example, links of a track come into contact one after another.
class ActiveContactPairs {
 public:
  /// Pairs of one force group. Marker i of the group's many markers and contact partner j form pair i · few + j.
  struct Group {
    Index few = 0;              ///< number of contact partners; 0 if unknown: pairs then have no neighbours
    Sequence<char> has_blocks;  ///< for each pair: nonzero if the pair has blocks in the matrix
    Sequence<long> touched;     ///< for each pair: number of the last evaluation with contact
  };

  /// Starts an evaluation of the matrix.
  void begin() {
    next_ = 0;
    lacks_ = false;
    ++writing_;
  }
  /// Returns the next group of the model. \param few number of contact partners of the group; 0 for an unknown number
  Group& group(Index few) {
    if (next_ == groups_.size()) groups_.push_back({few, {}, {}});
    return groups_[next_++];
  }
  /// Records a contact of pair k of a group in this evaluation if `touches` is true. Returns true if the pair has
  /// blocks in the matrix.
  bool note(Group& group, std::size_t k, bool touches) {
    if (k == group.has_blocks.size()) {
      group.has_blocks.push_back(0);
      group.touched.push_back(-kept);
    }
    if (touches) group.touched[k] = writing_;
    if (touches && !group.has_blocks[k]) lacks_ = true;
    return group.has_blocks[k];
  }
  /// True if a pair without blocks was in contact in the last evaluation.
  bool lacks() const { return lacks_; }
  /// Selects the pairs with recent contact, and their neighbours. This changes the sparsity pattern of the matrix.
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
  static constexpr long kept = 50;        // number of evaluations without contact after which a pair loses its blocks

  Sequence<Group> groups_;
  std::size_t next_ = 0;
  long writing_ = 0;
  bool lacks_ = false;
};

}  // namespace polybody
