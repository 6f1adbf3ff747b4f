#pragma once
/// \file
/// Search for pairs of shapes that are near each other, by a grid of cells (broad phase).
/// Theory: Eq. 9.69.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include <polybody/math/sequence.hpp>
#include <polybody/math/types.hpp>

namespace polybody {

/// Axis-aligned box that contains a shape. The default box is empty.
struct Extent {
  Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity());    ///< (3) lower corner, world axes [m]
  Vec3 high = Vec3::Constant(-std::numeric_limits<double>::infinity());  ///< (3) upper corner, world axes [m]

  /// Extent with the centre `centre` (3) and the half sizes `half` (3), world axes [m].
  static Extent about(Vec3 const& centre, Vec3 const& half) {
    Extent e;
    for (int i = 0; i < 3; ++i) {
      e.low[i] = centre[i] - half[i];
      e.high[i] = centre[i] + half[i];
    }
    return e;
  }
};

/// Pairs of members that may overlap, found by a grid and kept between evaluations.
///
/// A search encloses each member in its extent plus a margin, and lists all pairs whose enclosures overlap. The list
/// contains all overlapping pairs while each extent is inside of its enclosure, for any step and any velocity.
/// Otherwise the next evaluation searches again. The cost of a search grows in proportion to the number of members, if
/// their sizes are similar. A member much larger than the mean is compared with all others. The arrays grow only if a
/// search finds more pairs or cells than all searches before.
class PairSearch {
 public:
  /// Starts an evaluation of `members` members.
  void begin(std::size_t members) {
    if (enclosures_.size() == members) return;
    Extent const none;
    extents_.assign(members, none);
    enclosures_.assign(members, none);
    first_cells_.resize(members);
    entries_.reserve(8 * members);
    pairs_.reserve(12 * members);
    large_.reserve(members);
    std::size_t cells = 16;
    while (cells < 2 * members) cells *= 2;
    heads_.resize(cells);
    searched_ = false;
  }
  /// Stores the present extent of member m. Returns false if the extent leaves the enclosure of the last search, or if
  /// a coordinate is NaN.
  bool encloses(std::size_t m, Extent const& present) {
    extents_[m] = present;
    Extent const& e = enclosures_[m];
    bool inside = true;
    for (int i = 0; i < 3; ++i) inside = inside && present.low[i] >= e.low[i] && present.high[i] <= e.high[i];
    return inside;
  }
  /// True after the first search for these members.
  bool searched() const { return searched_; }
  /// Sorted keys of the pairs that may overlap; the caller defines the keys.
  Sequence<std::uint64_t>& pairs() { return pairs_; }
  /// Number of searches.
  long searches() const { return searches_; }

  /// Encloses each member, and calls emit(m, n) once for each pair of members whose enclosures overlap. A member with
  /// an empty extent has no pair.
  template <class Emit>
  void find(Emit&& emit) {
    searched_ = true;
    ++searches_;
    double const width = enclose();
    std::fill(heads_.begin(), heads_.end(), -1);
    entries_.clear();
    large_.clear();
    for (std::size_t m = 0; m < enclosures_.size(); ++m)
      if (!is_empty(enclosures_[m]) && !enter(Member(m), width, emit)) large_.push_back(Member(m));
    for (std::size_t l = 0; l < large_.size(); ++l)
      for (std::size_t m = 0; m < enclosures_.size(); ++m) {
        bool const later = std::binary_search(large_.begin(), large_.begin() + std::ptrdiff_t(l) + 1, Member(m));
        if (!later && !is_empty(enclosures_[m]) && overlap(enclosures_[std::size_t(large_[l])], enclosures_[m]))
          emit(std::size_t(large_[l]), m);
      }
  }

 private:
  using Member = std::int32_t;
  struct Cell {
    std::int32_t at[3];
    bool operator==(Cell const& other) const = default;
  };
  /// Member in a cell, with the index of the next entry in the same list; −1 for none.
  struct Entry {
    Cell cell;
    Member member;
    std::int32_t next;
  };

  static bool is_empty(Extent const& e) { return e.low[0] > e.high[0]; }  // false for NaN
  /// False only if the extents do not overlap; true for NaN.
  static bool overlap(Extent const& a, Extent const& b) {
    for (int i = 0; i < 3; ++i)
      if (a.low[i] > b.high[i] || b.low[i] > a.high[i]) return false;
    return true;
  }
  /// Computes all enclosures. Returns the width of the cells [m].
  double enclose() {
    double sum = 0.0;
    Index count = 0;
    for (std::size_t m = 0; m < extents_.size(); ++m) {
      Extent const& e = extents_[m];
      double const width = std::max({e.high[0] - e.low[0], e.high[1] - e.low[1], e.high[2] - e.low[2]});
      Extent& wide = enclosures_[m] = e;
      for (int i = 0; i < 3; ++i) {
        wide.low[i] -= margin * width;
        wide.high[i] += margin * width;
      }
      if (!(width >= 0.0 && width < farthest)) continue;
      sum += width;
      ++count;
    }
    return sum > 0.0 ? 1.5 * sum / double(count) : 1.0;
  }
  /// Adds a member to all cells of its enclosure, and emits its pairs with the members that these cells contain.
  /// Returns false if the member has too many cells.
  template <class Emit>
  bool enter(Member m, double width, Emit& emit) {
    Extent const& e = enclosures_[std::size_t(m)];
    Cell low, high;
    double cells = 1.0;
    for (int i = 0; i < 3; ++i) {
      double const from = std::floor(e.low[i] / width), to = std::floor(e.high[i] / width);
      if (!(std::abs(from) < farthest && std::abs(to) < farthest)) return false;
      low.at[i] = std::int32_t(from);
      high.at[i] = std::int32_t(to);
      cells *= to - from + 1.0;
    }
    if (cells > most_cells) return false;
    first_cells_[std::size_t(m)] = low;
    Cell c;
    for (c.at[0] = low.at[0]; c.at[0] <= high.at[0]; ++c.at[0])
      for (c.at[1] = low.at[1]; c.at[1] <= high.at[1]; ++c.at[1])
        for (c.at[2] = low.at[2]; c.at[2] <= high.at[2]; ++c.at[2]) enter_cell(m, c, emit);
    return true;
  }
  template <class Emit>
  void enter_cell(Member m, Cell const& cell, Emit& emit) {
    std::int32_t& head = heads_[list_of(cell)];
    for (std::int32_t k = head; k >= 0; k = entries_[std::size_t(k)].next) {
      Entry const& other = entries_[std::size_t(k)];
      if (!(other.cell == cell)) continue;
      if (is_first_common_cell(cell, m, other.member) &&
          overlap(enclosures_[std::size_t(m)], enclosures_[std::size_t(other.member)]))
        emit(std::size_t(other.member), std::size_t(m));
    }
    entries_.push_back({cell, m, head});
    head = std::int32_t(entries_.size()) - 1;
  }
  /// True if `cell` is the lowest cell that both members occupy, so that a pair is found once.
  bool is_first_common_cell(Cell const& cell, Member a, Member b) const {
    Cell const &of_a = first_cells_[std::size_t(a)], &of_b = first_cells_[std::size_t(b)];
    bool first = true;
    for (int i = 0; i < 3; ++i) first = first && cell.at[i] == std::max(of_a.at[i], of_b.at[i]);
    return first;
  }
  std::size_t list_of(Cell const& c) const {
    std::uint32_t const hash =
        std::uint32_t(c.at[0]) * 73856093u ^ std::uint32_t(c.at[1]) * 19349663u ^ std::uint32_t(c.at[2]) * 83492791u;
    return std::size_t(hash) & (heads_.size() - 1);
  }

  static constexpr double margin = 0.1;     // part of the width of a member
  static constexpr double most_cells = 64;  // of a member; larger members are compared with all others
  static constexpr double farthest = 1e9;   // largest number of a cell

  Sequence<Extent> extents_, enclosures_;  // present extents; extents of the last search, with margins
  Sequence<Cell> first_cells_;             // lowest cell of each member
  Sequence<std::int32_t> heads_;           // first entry of each list; −1 for none
  Sequence<Entry> entries_;
  Sequence<Member> large_;
  Sequence<std::uint64_t> pairs_;
  bool searched_ = false;
  long searches_ = 0;
};

}  // namespace polybody
