#pragma once
#include <algorithm>

#include <polybody/math/sequence.hpp>
#include <polybody/math/types.hpp>

namespace polybody {

/// Which pairs of a model's force groups have blocks in a matrix that is written again and again: those that touched
/// shortly before it was laid out, and pairs of the same opponent with markers beside theirs in the order of the many,
/// as links of a track touch one after another.
class ActiveContactPairs {
 public:
  /// The pairs of one group, number i few + j for marker i of the many and opponent j.
  struct Group {
    Index few = 0;           ///< opponents; 0: not known, so nothing is beside a pair
    Sequence<char> held;     ///< by pairs: has blocks
    Sequence<long> touched;  ///< by pairs: the number of the writing in which it touched last
  };

  /// The matrix is about to be written.
  void begin() {
    next_ = 0;
    lacks_ = false;
    ++writing_;
  }
  /// The next group of the model. \param few its opponents, 0 where it does not tell
  Group& group(Index few) {
    if (next_ == groups_.size()) groups_.push_back({few, {}, {}});
    return groups_[next_++];
  }
  /// Notes whether pair k of a group touches. Returns whether it has blocks.
  bool note(Group& group, std::size_t k, bool touches) {
    if (k == group.held.size()) {
      group.held.push_back(0);
      group.touched.push_back(-kept);
    }
    if (touches) group.touched[k] = writing_;
    if (touches && !group.held[k]) lacks_ = true;
    return group.held[k];
  }
  /// A pair that touched when the matrix was written last has no blocks in it.
  bool lacks() const { return lacks_; }
  /// From now on those that touched of late have blocks, with those beside them: the matrix has another pattern.
  void hold() {
    for (Group& g : groups_) {
      std::fill(g.held.begin(), g.held.end(), char(0));
      Index const pairs = Index(g.held.size());
      for (Index k = 0; k < pairs; ++k)
        if (writing_ - g.touched[std::size_t(k)] < kept)
          for (Index i = -beside; i <= beside; ++i)
            if (Index const other = k + i * g.few; other >= 0 && other < pairs) g.held[std::size_t(other)] = 1;
    }
    lacks_ = false;
  }

 private:
  static constexpr Index beside = 2;  // markers on each side
  static constexpr long kept = 50;    // writings for which a pair that parts is held, as it may touch again

  Sequence<Group> groups_;
  std::size_t next_ = 0;
  long writing_ = 0;
  bool lacks_ = false;
};

}  // namespace polybody
