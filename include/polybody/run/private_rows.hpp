#pragma once
/// \file
/// Rows of G that are independent of all others because they alone reach the speeds of a body.

#include <polybody/math/sequence.hpp>
#include <polybody/math/vectors.hpp>
#include <polybody/system/layout.hpp>

namespace polybody::detail {

/// An entry of G whose rows are scaled to the norm 1.
struct RowEntry {
  Index row, speed;
  double value;
};

/// Removes, body by body, all rows that reach a body if they are independent in its speeds alone: Gᵀc = 0 then requires
/// c = 0 there. A leaf of a tree is removed first, then the body before it. The rows of loops remain. The work is
/// linear in the number of rows.
template <class = void>  // compiled where it is used
class PrivateRows {
 public:
  static constexpr std::size_t most = 12;      ///< rows of one body that are tried at once
  static constexpr double independent = 0.01;  ///< least distance of a row from the span of those before it

  PrivateRows(Sequence<BodyLayout> const& bodies, Index rows, Sequence<RowEntry> const& entries)
      : bodies_(bodies), gone_(std::size_t(rows), 0), of_row_(std::size_t(rows)), rows_of_(bodies.size()) {
    Index velocities = 0;
    for (BodyLayout const& b : bodies) velocities = std::max(velocities, b.v0 + b.velocities);
    Sequence<Index> body_of(std::size_t(velocities), -1);
    for (std::size_t b = 0; b < bodies.size(); ++b)
      std::fill_n(body_of.begin() + bodies[b].v0, bodies[b].velocities, Index(b));
    for (RowEntry const& e : entries) {
      if (e.speed >= velocities || body_of[std::size_t(e.speed)] < 0) continue;  // of no body
      of_row_[std::size_t(e.row)].push_back({body_of[std::size_t(e.speed)], e.speed, e.value});
      rows_of_[std::size_t(body_of[std::size_t(e.speed)])].push_back(e.row);
    }
    for (Sequence<Index>& of_body : rows_of_) {
      sort_once(of_body);
      count_.push_back(of_body.size());
    }
    for (std::size_t b = bodies.size(); b-- > 0;) waiting_.push_back(Index(b));
    while (!waiting_.empty()) {
      Index const b = waiting_.back();
      waiting_.pop_back();
      try_body(b);
    }
  }

  /// Whether a row is removed.
  bool operator[](Index row) const { return gone_[std::size_t(row)] != 0; }

 private:
  struct Entry {
    Index body, speed;
    double value;
  };

  void try_body(Index b) {
    std::size_t const count = count_[std::size_t(b)];
    if (count == 0 || count > most || Index(count) > bodies_[std::size_t(b)].velocities) return;
    Sequence<Index> rows;
    for (Index const r : rows_of_[std::size_t(b)])
      if (!gone_[std::size_t(r)]) rows.push_back(r);
    if (!are_independent(b, rows)) return;
    for (Index const r : rows) {
      gone_[std::size_t(r)] = 1;
      Sequence<Index> reached;
      for (Entry const& e : of_row_[std::size_t(r)]) reached.push_back(e.body);
      sort_once(reached);
      for (Index const body : reached) {
        --count_[std::size_t(body)];
        if (body != b) waiting_.push_back(body);
      }
    }
  }
  /// By the method of Gram and Schmidt, each projection twice.
  bool are_independent(Index b, Sequence<Index> const& rows) const {
    BodyLayout const& body = bodies_[std::size_t(b)];
    Sequence<VecX> basis;
    for (Index const r : rows) {
      VecX x = VecX::Zero(body.velocities);
      for (Entry const& e : of_row_[std::size_t(r)])
        if (e.body == b) x[e.speed - body.v0] += e.value;
      for (int round = 0; round < 2; ++round)
        for (VecX const& y : basis) {
          double along = 0.0;
          for (Index i = 0; i < x.size(); ++i) along += x[i] * y[i];
          for (Index i = 0; i < x.size(); ++i) x[i] -= along * y[i];
        }
      double const size = std::sqrt(squares(x));
      if (!(size >= independent)) return false;
      x /= size;
      basis.push_back(std::move(x));
    }
    return true;
  }

  Sequence<BodyLayout> const& bodies_;
  Sequence<char> gone_;
  Sequence<Sequence<Entry>> of_row_;
  Sequence<Sequence<Index>> rows_of_;  ///< by bodies, ascending
  Sequence<std::size_t> count_;        ///< of those that are left
  Sequence<Index> waiting_;            ///< bodies to try, some more than once
};

}  // namespace polybody::detail
