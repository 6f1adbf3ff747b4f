#pragma once
/// \file
/// Map from indices to values, sorted by index. It compiles fast and is intended for few entries.

#include <algorithm>
#include <cmath>
#include <utility>

#include <polybody/math/sequence.hpp>
#include <polybody/math/types.hpp>

namespace polybody {

/// Map from indices to values V, sorted by index.
template <class V>
class IndexMap {
 public:
  /// Index and its value.
  struct Entry {
    Index index;  ///< key of the entry
    V value;      ///< value of the entry
  };

  /// Value of `index`. Adds the entry with the value V() if it does not exist.
  V& operator[](Index index) {
    std::size_t const k = place(index);
    if (k == entries_.size() || entries_[k].index != index) {
      entries_.push_back({index, V()});
      for (std::size_t i = entries_.size() - 1; i > k; --i) std::swap(entries_[i], entries_[i - 1]);
    }
    return entries_[k].value;
  }
  /// Pointer to the value of `index`; null if there is no entry.
  V const* find(Index index) const {
    std::size_t const k = place(index);
    return k < entries_.size() && entries_[k].index == index ? &entries_[k].value : nullptr;
  }
  /// Removes the entry of `index` if it exists.
  void erase(Index index) {
    std::size_t const k = place(index);
    if (k == entries_.size() || entries_[k].index != index) return;
    for (std::size_t i = k; i + 1 < entries_.size(); ++i) std::swap(entries_[i], entries_[i + 1]);
    entries_.pop_back();
  }
  /// Adds `factor` times the values of `other`. The cost is linear in the number of entries of both maps.
  void add(V const& factor, IndexMap const& other) {
    Sequence<Entry> sum;
    sum.reserve(entries_.size() + other.entries_.size());
    Entry const* mine = begin();
    for (Entry const& e : other) {
      while (mine != end() && mine->index < e.index) sum.push_back(*mine++);
      sum.push_back({e.index, mine != end() && mine->index == e.index ? mine++->value : V()});
      sum.back().value += factor * e.value;
    }
    sum.append(mine, end());
    entries_.swap(sum);
  }
  /// Multiplies all values by `factor`.
  void multiply(V const& factor) {
    for (Entry& e : entries_) e.value *= factor;
  }
  bool empty() const { return entries_.empty(); }       ///< true if there are no entries
  std::size_t size() const { return entries_.size(); }  ///< number of entries
  /// First entry. The entries are sorted by ascending index.
  Entry const* begin() const { return entries_.begin(); }
  Entry const* end() const { return entries_.end(); }  ///< end of the entries

 private:
  /// Position of the first entry with an index not less than `index`.
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

/// Largest magnitude of the values of `c`; zero if `c` is empty.
inline double largest_size(IndexMap<double> const& c) {
  double largest = 0.0;
  for (auto const& [i, value] : c) largest = std::max(largest, std::abs(value));
  return largest;
}

}  // namespace polybody
