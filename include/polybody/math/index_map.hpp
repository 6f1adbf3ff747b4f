#pragma once
/// \file
/// Few values by an index; costs a compiler little.

#include <utility>

#include <polybody/math/sequence.hpp>
#include <polybody/math/types.hpp>

namespace polybody {

/// In the order of the indices.
template <class V>
class IndexMap {
 public:
  /// An index and where it leads.
  struct Entry {
    Index index;  ///< key of the entry
    V value;      ///< what stands under the index
  };

  /// That of an index; a new one is V().
  V& operator[](Index index) {
    std::size_t const k = place(index);
    if (k == entries_.size() || entries_[k].index != index) {
      entries_.push_back({index, V()});
      for (std::size_t i = entries_.size() - 1; i > k; --i) std::swap(entries_[i], entries_[i - 1]);
    }
    return entries_[k].value;
  }
  /// What stands at `index`; null where there is none.
  V const* find(Index index) const {
    std::size_t const k = place(index);
    return k < entries_.size() && entries_[k].index == index ? &entries_[k].value : nullptr;
  }
  /// Removes the entry of an index, if there is one.
  void erase(Index index) {
    std::size_t const k = place(index);
    if (k == entries_.size() || entries_[k].index != index) return;
    for (std::size_t i = k; i + 1 < entries_.size(); ++i) std::swap(entries_[i], entries_[i + 1]);
    entries_.pop_back();
  }
  /// First entry; entries come in ascending order of their indices.
  Entry const* begin() const { return entries_.begin(); }
  Entry const* end() const { return entries_.end(); }  ///< end of the entries

 private:
  /// The first entry that is not before an index.
  std::size_t place(Index index) const {
    std::size_t from = 0, to = entries_.size();
    while (from < to) {
      std::size_t const middle = (from + to) / 2;
      if (entries_[middle].index < index)
        from = middle + 1;
      else
        to = middle;
    }
    return from;
  }

  Sequence<Entry> entries_;
};

}  // namespace polybody
