#pragma once
/// \file
/// Linear solver that factorises constant parts of a matrix only once. Example: in a vehicle with tracks of ANCF links
/// and a hull with rotating joints, the mass matrix TᵀMT of a track is constant if linear joints eliminate the
/// dependent coordinates [thesis §3.5.4, §4.4]. With TᵀMT = L Lᵀ, the mass matrix of a whole track with its joints is
/// the identity in the coordinates p = Lᵀ e, with the independent coordinates e. Since L is constant, an explicit step
/// in p is equal to a step in e.

#include <algorithm>
#include <span>

#include <polybody/math/index_map.hpp>
#include <polybody/math/sequence.hpp>
#include <polybody/solvers/linear_solver.hpp>

namespace polybody {

/// Linear solver of a matrix that consists of parts without a block between them. The first factorisation factorises
/// the constant parts, with a separate `Solver`; later factorisations reuse these factors. A part is constant if all of
/// its unknowns are declared constant. Another `Solver` factorises the other parts. The matrix must have parts of both
/// kinds.
template <LinearSolver Solver>
class ConstantBlockCache {
 public:
  /// Declares unknowns constant. Call it before `analyse`. Returns the number of unknowns in constant parts, or zero
  /// unless the matrix has constant parts and other parts. \param constant for each unknown: true if the blocks in its
  /// row and column are constant
  /// \param blocks blocks of the matrix
  Index keep(Sequence<bool> const& constant, std::span<Block const> blocks) {
    Index const size = Index(constant.size());
    root_.clear();
    for (Index i = 0; i < size; ++i) root_.push_back(i);
    for (Block const& b : blocks) {
      Index const first = root(b.row);
      for (Index i = 0; i < b.rows; ++i) root_[std::size_t(root(b.row + i))] = root(first);
      for (Index j = 0; j < b.cols; ++j) root_[std::size_t(root(b.col + j))] = root(first);
    }
    kept_.assign(std::size_t(size), true);
    for (Index i = 0; i < size; ++i)
      if (!constant[std::size_t(i)]) kept_[std::size_t(root(i))] = false;
    for (Index i = 0; i < size; ++i) kept_[std::size_t(i)] = kept_[std::size_t(root(i))];
    kept_size_ = 0;
    place_.clear();
    of_kept_.clear();
    of_rest_.clear();
    for (Index i = 0; i < size; ++i) {
      place_.push_back(kept_[std::size_t(i)] ? kept_size_++ : i - kept_size_);
      (kept_[std::size_t(i)] ? of_kept_ : of_rest_).push_back(i);
    }
    return kept_size_ == size ? 0 : kept_size_;
  }

  void analyse(Index size, std::span<Block const> blocks) {
    kept_factored_ = false;
    Sequence<Block> of_kept, of_rest;
    in_kept_.clear();
    for (Block b : blocks) {
      bool const kept = kept_[std::size_t(b.row)];
      in_kept_.push_back(kept);
      b.row = place_[std::size_t(b.row)];
      b.col = place_[std::size_t(b.col)];
      (kept ? of_kept : of_rest).push_back(b);
    }
    kept_solver_.analyse(kept_size_, of_kept);
    rest_.analyse(size - kept_size_, of_rest);
    kept_rhs_.setZero(kept_size_);
    rest_rhs_.setZero(size - kept_size_);
    kept_x_ = kept_rhs_;
    rest_x_ = rest_rhs_;
  }
  void begin() {
    next_ = 0;
    rest_.begin();
    to_rest_ = BlockSink(rest_);
    if (kept_factored_) return;
    kept_solver_.begin();
    to_kept_ = BlockSink(kept_solver_);
  }
  void add(Index row, Index col, BlockView const& b) {
    bool const kept = in_kept_[next_++];
    if (kept && kept_factored_) return;
    (kept ? to_kept_ : to_rest_).add(place_[std::size_t(row)], place_[std::size_t(col)], b);
  }

  /// False if the unknowns from `first` on belong to constant parts that are already factorised.
  bool wants(Index first, Index) const { return !kept_factored_ || !kept_[std::size_t(first)]; }
  void skip(Index row, Index col, Index rows, Index cols) {
    if (bool const kept = in_kept_[next_++]; !kept || !kept_factored_)
      (kept ? to_kept_ : to_rest_).skip(place_[std::size_t(row)], place_[std::size_t(col)], rows, cols);
  }

  /// Returns −1 on success, otherwise the index of the unknown without a usable pivot.
  Index factor() {
    if (!kept_factored_) {
      if (Index const bad = kept_solver_.factor(); bad >= 0) return unknown(bad, true);
      kept_factored_ = true;
    }
    Index const bad = rest_.factor();
    dropped_.clear();
    if constexpr (requires { rest_.dropped(); })
      for (Index const i : rest_.dropped()) dropped_.push_back(unknown(i, false));
    return bad < 0 ? bad : unknown(bad, false);
  }
  /// x = A⁻¹ b; b and x may be the same vector.
  void solve(VecX const& b, VecX& x) {
    for (std::size_t i = 0; i < place_.size(); ++i) (kept_[i] ? kept_rhs_ : rest_rhs_)[place_[i]] = b[Index(i)];
    kept_solver_.solve(kept_rhs_, kept_x_);
    rest_.solve(rest_rhs_, rest_x_);
    x.resize(Index(place_.size()));
    for (std::size_t i = 0; i < place_.size(); ++i) x[Index(i)] = (kept_[i] ? kept_x_ : rest_x_)[place_[i]];
  }

  std::span<Index const> dropped() const { return {dropped_.data(), dropped_.size()}; }
  /// Drops these `unknowns`, except those of constant parts, in every later factorisation
  /// (`BlockFactor::mark_redundant`).
  [[gnu::cold]] void mark_redundant(std::span<Index const> unknowns) {
    if constexpr (requires { rest_.mark_redundant(unknowns); }) {
      Sequence<Index> rows;
      for (Index const i : unknowns)
        if (!kept_[std::size_t(i)]) rows.push_back(place_[std::size_t(i)]);
      rest_.mark_redundant(std::span<Index const>(rows.data(), rows.size()));
    }
  }
  /// True if a redundancy decision of the last factorisation is doubtful. \param share largest relative pivot of a
  /// doubtful decision [1], see `BlockFactor::is_doubtful`
  [[gnu::cold]] bool is_doubtful(double share) const {
    if constexpr (requires { rest_.is_doubtful(share); }) return rest_.is_doubtful(share);
    return false;
  }
  /// Computes the null vectors of the dropped equations (`BlockFactor::null_vectors`). Empty if `Solver` does not
  /// provide null vectors. \param sizes typical magnitudes of all equations
  [[gnu::cold]] Sequence<IndexMap<double>> null_vectors(VecX const& sizes) {
    if constexpr (requires { rest_.null_vectors(sizes); }) {
      for (std::size_t i = 0; i < place_.size(); ++i)
        if (!kept_[i]) rest_x_[place_[i]] = sizes[Index(i)];
      Sequence<IndexMap<double>> found;
      for (IndexMap<double> const& n : rest_.null_vectors(rest_x_)) {
        found.emplace_back();
        for (auto const& [i, value] : n) found.back()[unknown(i, false)] = value;
      }
      return found;
    }
    return {};
  }
  bool reordered() const {
    if constexpr (requires { rest_.reordered(); }) return rest_.reordered() || kept_solver_.reordered();
    return false;
  }
  std::size_t reorderings() const {
    if constexpr (requires { rest_.reorderings(); }) return rest_.reorderings();
    return 0;
  }
  void limit_reorderings(std::size_t count) noexcept {
    if constexpr (requires { rest_.limit_reorderings(count); }) rest_.limit_reorderings(count);
  }

 private:
  /// Unknown that represents the part of unknown i; all unknowns of a part have the same root.
  Index root(Index i) {
    while (root_[std::size_t(i)] != i) i = root_[std::size_t(i)] = root_[std::size_t(root_[std::size_t(i)])];
    return i;
  }
  Index unknown(Index place, bool kept) const { return (kept ? of_kept_ : of_rest_)[std::size_t(place)]; }

  Solver rest_, kept_solver_;
  Sequence<bool> kept_, in_kept_;           // kept_: for each unknown; in_kept_: for each block
  Sequence<Index> root_, place_, dropped_;  // root_, place_: for each unknown; place_: index in its solver
  Sequence<Index> of_kept_, of_rest_;       // unknown at each index of both solvers
  Index kept_size_ = 0;
  bool kept_factored_ = false;
  std::size_t next_ = 0;
  BlockSink to_rest_{rest_}, to_kept_{kept_solver_};
  VecX kept_rhs_, rest_rhs_, kept_x_, rest_x_;
};

}  // namespace polybody
