#pragma once
/// \file
/// Local tests for redundant rows of the constraint Jacobian G. A set of rows is independent of all others if no other
/// row has entries in the velocities of a certain body, and if the entries of the set in these velocities are linearly
/// independent. Such rows are called private. Rows between the same bodies can depend on each other.

#include <algorithm>

#include <polybody/math/index_map.hpp>
#include <polybody/math/sequence.hpp>
#include <polybody/math/vectors.hpp>
#include <polybody/system/layout.hpp>

namespace polybody::detail {

/// Entry of G, whose rows are scaled to the norm 1.
struct RowEntry {
  Index row, velocity;
  double value;
};

/// Redundant row and its null vector: Gᵀc = 0 for the scaled rows, with c = 1 at the redundant row.
struct RowRelation {
  Index row = -1;
  IndexMap<double> c = {};  ///< nonzero coefficients by index of the row
};

/// Finds rows that depend on earlier rows between the same bodies, by Gram–Schmidt orthogonalisation. The cost is
/// linear in the number of rows.
template <class = void>  // compiled only if used
class RepeatedRows {
 public:
  static constexpr std::size_t most = 12;  ///< largest number of basis rows of a group of bodies

  /// \param threshold a row is redundant if its distance from the span of the earlier rows is smaller
  RepeatedRows(Sequence<BodyLayout> const& bodies, Index rows, Sequence<RowEntry> const& entries, double threshold)
      : threshold_(threshold) {
    Index velocities = 0;
    for (RowEntry const& e : entries) velocities = std::max(velocities, e.velocity + 1);
    Sequence<Index> body_of(std::size_t(velocities), -1);
    for (std::size_t b = 0; b < bodies.size(); ++b)
      for (Index j = bodies[b].v0; j < std::min(velocities, bodies[b].v0 + bodies[b].velocities); ++j)
        body_of[std::size_t(j)] = Index(b);
    Sequence<Row> all;
    all.resize(std::size_t(rows));
    for (Index i = 0; i < rows; ++i) all[std::size_t(i)].row = i;
    for (RowEntry const& e : entries) {
      all[std::size_t(e.row)].bodies.push_back(body_of[std::size_t(e.velocity)]);
      all[std::size_t(e.row)].entries[e.velocity] += e.value;
    }
    for (Row& row : all) sort_once(row.bodies);
    std::stable_sort(all.begin(), all.end(), [](Row const& a, Row const& b) {
      return std::lexicographical_compare(a.bodies.begin(), a.bodies.end(), b.bodies.begin(), b.bodies.end());
    });
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (i == 0 || !(all[i].bodies == all[i - 1].bodies)) basis_.clear();
      take(all[i]);
    }
    std::sort(relations_.begin(), relations_.end(),
              [](RowRelation const& a, RowRelation const& b) { return a.row < b.row; });
  }

  Sequence<RowRelation> const& relations() const { return relations_; }  ///< one for each redundant row, ascending

 private:
  struct Row {
    Index row = -1;
    Sequence<Index> bodies = {};
    IndexMap<double> entries = {};
  };
  /// Orthonormal basis vector q_k, with row_k = Σ_j r_jk q_j.
  struct Direction {
    Index row;
    IndexMap<double> q;
    Sequence<double> r;
  };

  void take(Row const& row) {
    if (row.bodies.empty() || basis_.size() == most) return;
    Direction next{row.row, row.entries, Sequence<double>(basis_.size() + 1, 0.0)};
    for (int round = 0; round < 2; ++round)
      for (std::size_t k = 0; k < basis_.size(); ++k) {
        double along = 0.0;
        for (auto const& [j, value] : basis_[k].q)
          if (double const* const x = next.q.find(j)) along += value * *x;
        for (auto const& [j, value] : basis_[k].q) next.q[j] -= along * value;
        next.r[k] += along;
      }
    double squared = 0.0;
    for (auto const& [j, value] : next.q) squared += value * value;
    double const left = std::sqrt(squared);
    if (left < threshold_) return relate(next);
    next.r.back() = left;
    IndexMap<double> q;
    for (auto const& [j, value] : next.q) q[j] = value / left;
    next.q = std::move(q);
    basis_.push_back(std::move(next));
  }
  /// Computes the null vector c of a redundant row from R c = −r, with the coefficients r of the row in the basis.
  void relate(Direction& repeated) {
    RowRelation out{repeated.row};
    out.c[repeated.row] = 1.0;
    for (std::size_t k = basis_.size(); k-- > 0;) {
      double const x = repeated.r[k] / basis_[k].r[k];
      for (std::size_t j = 0; j < k; ++j) repeated.r[j] -= basis_[k].r[j] * x;
      if (x != 0.0) out.c[basis_[k].row] = -x;
    }
    relations_.push_back(std::move(out));
  }

  double threshold_;
  Sequence<Direction> basis_;  // of the rows between the current bodies
  Sequence<RowRelation> relations_;
};

/// Removes, body by body, all rows with entries in the velocities of a body, if these entries are linearly independent:
/// Gᵀc = 0 then requires c = 0 for these rows. The rows of a leaf of a tree are removed first, then those of the next
/// body towards the root. The rows of loops remain. The cost is linear in the number of rows.
template <class = void>  // compiled only if used
class PrivateRows {
 public:
  static constexpr std::size_t most = 12;      ///< largest number of rows of one body that are tested
  static constexpr double independent = 0.01;  ///< least distance of a row from the span of the rows before it

  PrivateRows(Sequence<BodyLayout> const& bodies, Index rows, Sequence<RowEntry> const& entries)
      : bodies_(bodies), removed_(std::size_t(rows), 0), of_row_(std::size_t(rows)), rows_of_(bodies.size()) {
    Index velocities = 0;
    for (BodyLayout const& b : bodies) velocities = std::max(velocities, b.v0 + b.velocities);
    Sequence<Index> body_of(std::size_t(velocities), -1);
    for (std::size_t b = 0; b < bodies.size(); ++b)
      std::fill_n(body_of.begin() + bodies[b].v0, bodies[b].velocities, Index(b));
    for (RowEntry const& e : entries) {
      if (e.velocity >= velocities || body_of[std::size_t(e.velocity)] < 0) continue;  // belongs to no body
      of_row_[std::size_t(e.row)].push_back({body_of[std::size_t(e.velocity)], e.velocity, e.value});
      rows_of_[std::size_t(body_of[std::size_t(e.velocity)])].push_back(e.row);
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

  /// True if a row is removed.
  bool operator[](Index row) const { return removed_[std::size_t(row)] != 0; }

 private:
  struct Entry {
    Index body, velocity;
    double value;
  };

  void try_body(Index b) {
    std::size_t const count = count_[std::size_t(b)];
    if (count == 0 || count > most || Index(count) > bodies_[std::size_t(b)].velocities) return;
    Sequence<Index> rows;
    for (Index const r : rows_of_[std::size_t(b)])
      if (!removed_[std::size_t(r)]) rows.push_back(r);
    if (!are_independent(b, rows)) return;
    for (Index const r : rows) {
      removed_[std::size_t(r)] = 1;
      Sequence<Index> reached;
      for (Entry const& e : of_row_[std::size_t(r)]) reached.push_back(e.body);
      sort_once(reached);
      for (Index const body : reached) {
        --count_[std::size_t(body)];
        if (body != b) waiting_.push_back(body);
      }
    }
  }
  /// Tests `rows` of body b by Gram–Schmidt orthogonalisation; each projection is done twice.
  bool are_independent(Index b, Sequence<Index> const& rows) const {
    BodyLayout const& body = bodies_[std::size_t(b)];
    Sequence<VecX> basis;
    for (Index const r : rows) {
      VecX x = VecX::Zero(body.velocities);
      for (Entry const& e : of_row_[std::size_t(r)])
        if (e.body == b) x[e.velocity - body.v0] += e.value;
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
  Sequence<char> removed_;
  Sequence<Sequence<Entry>> of_row_;
  Sequence<Sequence<Index>> rows_of_;  ///< rows of each body, ascending
  Sequence<std::size_t> count_;        ///< number of remaining rows of each body
  Sequence<Index> waiting_;            ///< bodies to test, some more than once
};

}  // namespace polybody::detail
