#pragma once
/// \file
/// Wrapper of linear solvers that drops redundant constraint equations.
/// Theory: Eqs. 7.11, 7.12.

#include <algorithm>
#include <span>
#include <type_traits>

#include <polybody/math/sequence.hpp>
#include <polybody/solvers/block_factor.hpp>

namespace polybody {

/// Linear solver that drops redundant constraint equations and lists them.
template <class S>
concept RedundancyAwareSolver = LinearSolver<S> && requires(S const s) {
  { s.dropped() } -> std::convertible_to<std::span<Index const>>;
};

/// Linear solver for [A, Gᵀ; G, 0] that uses `Solver` and also accepts redundant constraint equations. It drops
/// redundant equations, so that their multipliers are zero. `BlockSolver` determines the redundant equations. For this
/// purpose `BlockSolver` factorises the matrix if `Solver` finds no pivot or a weak pivot (`least_pivot`, if `Solver`
/// provides it), and in every later factorisation as long as equations are dropped. `Solver` then factorises the
/// matrix, in which a one on the diagonal replaces the row and the column of each dropped equation. If this fails
/// (`EigenLdlt` for thin rods, whose M is singular), `BlockSolver` solves the equations. The wrapper stores a copy of
/// the blocks.
template <LinearSolver Solver>
class RedundancyDropping {
 public:
  /// Value of `Solver::least_pivot` below which a pivot is weak. For LU solvers, it is usually the ratio of the pivot
  /// to the largest entry of its column. A row of G at the distance σ from the span of other rows has one pivot of σ²
  /// or two pivots of σ, depending on the elimination order. `BlockSolver` drops the row if σ² ≤ 1e-9.
  static constexpr double weak = 1e-3;

  void analyse(Index size, std::span<Block const> blocks) {
    blocks_ = Sequence<Block>(blocks.begin(), blocks.end());
    first_.assign(1, 0);
    for (Block const& b : blocks) first_.push_back(first_.back() + std::size_t(b.rows * b.cols));
    values_.assign(first_.back(), 0.0);
    out_.assign(std::size_t(size), char(0));
    dropped_.clear();
    left_out_.clear();
    judges_ = false;
    rhs_.setZero(size);
    solver_.analyse(size, blocks);
  }
  void begin() { next_ = 0; }
  void add(Index, Index, BlockView const& b) {
    double* value = values_.data() + first_[next_++];
    for (Index j = 0; j < b.cols; ++j)
      for (Index i = 0; i < b.rows; ++i) *value++ = b(i, j);
  }

  /// Returns −1 on success, otherwise the index of the column without a usable pivot.
  Index factor() {
    by_judge_ = false;
    bool judged = !dropped_.empty() && check_step();
    if (!judged) drop({});
    Index bad = factor_without_dropped();
    if (!judged && (bad >= 0 || is_weak())) {
      judged = check_step();
      if (judged && !dropped_.empty()) bad = factor_without_dropped();
    }
    by_judge_ = judged && bad >= 0;
    return by_judge_ ? -1 : bad;
  }

  /// x = A⁻¹ b; b and x may be the same vector.
  void solve(VecX const& b, VecX& x) const {
    if (by_judge_) return judge_.solve(b, x);
    if (dropped_.empty()) return solver_.solve(b, x);
    rhs_ = b;
    for (Index const i : dropped_) rhs_[i] = 0.0;
    solver_.solve(rhs_, x);
  }
  std::span<Index const> dropped() const { return {dropped_.data(), dropped_.size()}; }

  /// Drops these `unknowns` in every later factorisation (`BlockFactor::mark_redundant`).
  [[gnu::cold]] void mark_redundant(std::span<Index const> unknowns) {
    left_out_ = Sequence<Index>(unknowns.begin(), unknowns.end());
    if (judges_) judge_.mark_redundant(unknowns);
    drop(unknowns);
  }
  /// True if equations are dropped and this decision is doubtful. \param share largest relative pivot of a doubtful
  /// decision [1], see `BlockFactor::is_doubtful`
  bool is_doubtful(double share) const { return !dropped_.empty() && judge_.is_doubtful(share); }
  /// Computes the null vectors of the dropped equations (`BlockFactor::null_vectors`). \param sizes typical
  /// magnitudes of all equations
  Sequence<IndexMap<double>> null_vectors(VecX const& sizes) const { return judge_.null_vectors(sizes); }

 private:
  bool is_weak() const {
    if constexpr (requires { solver_.least_pivot(); })
      return solver_.least_pivot() < weak;
    else
      return false;
  }
  BlockView view(std::size_t k) const {
    return {values_.data() + first_[k], blocks_[k].rows, blocks_[k].cols, 1, blocks_[k].rows};
  }

  /// Determines the redundant rows with the block solver. Returns false if its factorisation fails.
  [[gnu::cold]] bool check_step() {
    if (!judges_) {
      judge_.analyse(rhs_.size(), blocks_);
      judge_.mark_redundant({left_out_.data(), left_out_.size()});
    }
    judges_ = true;
    Index const bad = write_and_factor(judge_, [this](BlockSink& sink) {
      for (std::size_t k = 0; k < blocks_.size(); ++k) sink.add(blocks_[k].row, blocks_[k].col, view(k));
    });
    if (bad < 0) drop(judge_.dropped());
    return bad < 0;
  }
  /// Replaces the list of dropped equations by `rows`.
  void drop(std::span<Index const> rows) {
    if (std::equal(rows.begin(), rows.end(), dropped_.begin(), dropped_.end())) return;
    dropped_ = Sequence<Index>(rows.begin(), rows.end());
    std::fill(out_.begin(), out_.end(), char(0));
    Sequence<Block> all = blocks_;
    for (Index const i : dropped_) {
      out_[std::size_t(i)] = 1;
      all.push_back({i, i, 1, 1});
    }
    solver_.analyse(rhs_.size(), all);
  }
  bool holds(std::size_t k) const {
    Block const& b = blocks_[k];
    auto const any = [&](Index from, Index n) {
      char const* const first = out_.data() + from;
      return std::find(first, first + n, char(1)) != first + n;
    };
    return any(b.row, b.rows) || any(b.col, b.cols);
  }
  Index factor_without_dropped() {
    return write_and_factor(solver_, [this](BlockSink& sink) {
      for (std::size_t k = 0; k < blocks_.size(); ++k) {
        Block const& b = blocks_[k];
        if (dropped_.empty() || !holds(k)) {
          sink.add(b.row, b.col, view(k));
          continue;
        }
        part_.clear();
        part_.append(values_.data() + first_[k], values_.data() + first_[k + 1]);
        for (Index j = 0; j < b.cols; ++j)
          for (Index i = 0; i < b.rows; ++i)
            if (out_[std::size_t(b.row + i)] || out_[std::size_t(b.col + j)]) part_[std::size_t(j * b.rows + i)] = 0.0;
        sink.add(b.row, b.col, BlockView(part_.data(), b.rows, b.cols, 1, b.rows));
      }
      static constexpr double one = 1.0;
      for (Index const i : dropped_) sink.add(i, i, BlockView(&one, 1, 1, 1, 1));
    });
  }

  Solver solver_;
  BlockSolver judge_;
  bool judges_ = false;    // judge_ is analysed
  bool by_judge_ = false;  // `solve` uses judge_
  Sequence<Block> blocks_;
  Sequence<std::size_t> first_;  // index of each block's first value, and one past the last value
  Sequence<double> values_, part_;
  Sequence<char> out_;  // for each unknown: 1 if it is dropped
  Sequence<Index> dropped_, left_out_;
  std::size_t next_ = 0;
  mutable VecX rhs_;
};

/// Linear solver of time steps: `Solver` if it drops redundant equations; otherwise `RedundancyDropping<Solver>`.
template <LinearSolver Solver>
using StepSolver = std::conditional_t<RedundancyAwareSolver<Solver>, std::type_identity<Solver>,
                                      std::type_identity<RedundancyDropping<Solver>>>::type;

}  // namespace polybody
