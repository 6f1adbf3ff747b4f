#pragma once
/// \file
/// Blocks of a tangent between the bodies of contacts, and friction ratios of contact points.

#include <algorithm>
#include <cmath>
#include <compare>
#include <utility>

#include <polybody/math/block_sink.hpp>
#include <polybody/math/sequence.hpp>
#include <polybody/math/types.hpp>

namespace polybody {

/// Number of a contact point: indices of its two markers, and its slot (`ContactPoint`).
struct ContactPointKey {
  Index a;   ///< index of the first marker
  Index b;   ///< index of the second marker
  int slot;  ///< slot of the point
  /// Order by markers, then by slot.
  auto operator<=>(ContactPointKey const&) const = default;
};

/// Ratios w of friction force and μ N at all contact points, as further unknowns of Newton's method, with s w = v for
/// the slip velocity v and s = √(v² + v_s²) [Chan, Golub & Mulet 1999]. This equation is nearly linear for slip
/// velocities far above v_s, where v/s jumps. Each evaluation predicts w from the linearised equation,
///   w + Δw = (v + Δv)/s − w (v·Δv)/s²,   limited to a length of 1.
/// Further memory is allocated only if an evaluation has more contact points than all before.
class FrictionRatios {
 public:
  /// Removes all ratios. The next evaluation uses w = v/s.
  void forget() {
    last_.clear(), next_.clear();
    hint_ = 0;
  }
  bool empty() const { return next_.empty(); }  ///< true if the last evaluation had no contact point with friction
  /// Allocates memory for `points` contact points.
  void reserve(Index points) {
    last_.reserve(std::size_t(points));
    next_.reserve(std::size_t(points));
  }
  /// Keeps the ratios of the last evaluation for the next one, which is the first one of a step.
  void begin_step() { begins_ = true; }
  /// Starts an evaluation.
  void begin() {
    std::swap(last_, next_);
    next_.clear();
    auto const before = [](Point const& x, Point const& y) { return x.key < y.key; };
    if (!std::is_sorted(last_.begin(), last_.end(), before)) std::sort(last_.begin(), last_.end(), before);
    hint_ = 0;
    keeps_ = std::exchange(begins_, false);
  }
  /// Returns w (3) at the contact point `key` with the slip velocity v (3) [m/s] and s [m/s]. A new contact point has
  /// w = v/s.
  Vec3 ratio(ContactPointKey const& key, Vec3 const& v, double s) {
    Point const* const known = find(key);
    Vec3 const w = !known ? Vec3(v * (1.0 / s)) : keeps_ ? known->w : predicted(*known, v);
    next_.push_back({key, v, w, s});
    return w;
  }

 private:
  struct Point {
    ContactPointKey key;
    Vec3 v;    ///< (3) slip velocity [m/s]
    Vec3 w;    ///< (3) friction ratio [1]
    double s;  ///< √(v² + v_s²) [m/s]
  };

  static Vec3 predicted(Point const& p, Vec3 const& v) {
    Vec3 w = v * (1.0 / p.s) - p.w * (p.v.dot(v - p.v) / (p.s * p.s));
    double const size2 = w.dot(w);
    if (size2 > 1.0) w *= 1.0 / std::sqrt(size2);
    return w;
  }
  Point const* find(ContactPointKey const& key) {
    if (hint_ == last_.size() || last_[hint_].key != key)
      hint_ = std::size_t(std::lower_bound(last_.begin(), last_.end(), key,
                                           [](Point const& p, ContactPointKey const& k) { return p.key < k; }) -
                          last_.begin());
    return hint_ < last_.size() && last_[hint_].key == key ? &last_[hint_++] : nullptr;
  }

  Sequence<Point> last_, next_;  // of the last evaluation, sorted by key; of this evaluation
  std::size_t hint_ = 0;         // expected position of the next point in last_
  bool begins_ = false, keeps_ = false;
};

/// Blocks K_ab and K_ba of a tangent that couple the two bodies of each contact of a contact set. Time steps do not
/// factorise these blocks, because they change with the contacts and fill in. The generalised minimal residual method
/// includes them in the solution (`StepTangent`). Further memory is allocated only if an evaluation has more blocks
/// than all before.
class ContactCoupling {
 public:
  FrictionRatios ratios;  ///< friction ratios of the contact points

  void clear() { blocks_.clear(), values_.clear(); }  ///< removes all blocks
  void begin() { clear(), ratios.begin(); }           ///< starts an evaluation
  bool empty() const { return blocks_.empty(); }      ///< true without blocks
  /// Allocates memory for `blocks` blocks of 6 rows and 6 columns.
  void reserve(Index blocks) {
    blocks_.reserve(std::size_t(blocks));
    values_.reserve(std::size_t(36 * blocks));
  }
  /// Adds the block b, whose first entry is at (row, col) of the tangent.
  void add(Index row, Index col, BlockView const& b) {
    blocks_.push_back({row, col, b.rows, b.cols});
    for (Index i = 0; i < b.rows; ++i)
      for (Index j = 0; j < b.cols; ++j) values_.push_back(b(i, j));
  }
  /// Adds the product of all blocks and x (nv) to y (nv).
  template <class = void>  // compiled where it is used
  void add_product(VecX const& x, VecX& y) const {
    double const* value = values_.data();
    for (Block const& b : blocks_) {
      double const* const from = x.data() + b.col;
      double* const to = y.data() + b.row;
      for (Index i = 0; i < b.rows; ++i, value += b.cols) {
        double sum = 0.0;
        for (Index j = 0; j < b.cols; ++j) sum += value[j] * from[j];
        to[i] += sum;
      }
    }
  }

 private:
  Sequence<Block> blocks_;
  Sequence<double> values_;  // of all blocks, by rows
};

}  // namespace polybody
