#pragma once
/// \file
/// Wrapper of linear solvers that adds one step of iterative refinement to each solution.
/// Theory: Eq. 7.10.

#include <span>

#include <polybody/math/sequence.hpp>
#include <polybody/solvers/linear_solver.hpp>

namespace polybody {

/// Linear solver that refines each solution of `Solver` by one iteration x += A⁻¹(b − A x) [Higham 2002, §12.1]. This
/// solver stores the blocks of A, and its solution costs about twice as much as with `Solver`. Use it if masses or
/// stiffnesses differ by ten orders of magnitude or more.
template <LinearSolver Solver>
class IterativeRefinement {
 public:
  void analyse(Index size, std::span<Block const> blocks) {
    blocks_ = Sequence<Block>(blocks.begin(), blocks.end());
    first_.assign(1, 0);
    for (Block const& b : blocks) first_.push_back(first_.back() + std::size_t(b.rows * b.cols));
    values_.assign(first_.back(), 0.0);
    r_ = dx_ = VecX::Zero(size);
    solver_.analyse(size, blocks);
  }
  void begin() {
    next_ = 0;
    solver_.begin();
  }
  void add(Index row, Index col, BlockView const& b) {
    double* value = values_.data() + first_[next_++];
    for (Index j = 0; j < b.cols; ++j)
      for (Index i = 0; i < b.rows; ++i) *value++ = b(i, j);
    solver_.add(row, col, b);
  }
  /// Returns −1 on success, otherwise the index of the column without a usable pivot.
  Index factor() { return solver_.factor(); }

  /// x = A⁻¹ b; b and x may be the same vector.
  void solve(VecX const& b, VecX& x) const {
    r_ = b;
    solver_.solve(b, x);
    for (std::size_t k = 0; k < blocks_.size(); ++k) {
      double const* value = values_.data() + first_[k];
      for (Index j = 0; j < blocks_[k].cols; ++j)
        for (Index i = 0; i < blocks_[k].rows; ++i) r_[blocks_[k].row + i] -= *value++ * x[blocks_[k].col + j];
    }
    solver_.solve(r_, dx_);
    x += dx_;
  }

  double least_pivot() const
    requires requires(Solver const s) { s.least_pivot(); }
  {
    return solver_.least_pivot();
  }
  bool reordered() const
    requires requires(Solver const s) { s.reordered(); }
  {
    return solver_.reordered();
  }
  std::size_t reorderings() const
    requires requires(Solver const s) { s.reorderings(); }
  {
    return solver_.reorderings();
  }
  void limit_reorderings(std::size_t count) noexcept
    requires requires(Solver s) { s.limit_reorderings(count); }
  {
    solver_.limit_reorderings(count);
  }
  /// Drops these `unknowns` in every later factorisation (`BlockFactor::mark_redundant`).
  void mark_redundant(std::span<Index const> unknowns)
    requires requires(Solver s) { s.mark_redundant(unknowns); }
  {
    solver_.mark_redundant(unknowns);
  }
  /// True if a redundancy decision of the last factorisation is doubtful for `share`: see `BlockFactor::is_doubtful`.
  bool is_doubtful(double share) const
    requires requires(Solver const s) { s.is_doubtful(share); }
  {
    return solver_.is_doubtful(share);
  }
  /// Computes the null vectors of the dropped equations (`BlockFactor::null_vectors`). \param sizes typical
  /// magnitudes of all equations
  auto null_vectors(VecX const& sizes) const
    requires requires(Solver const s) { s.null_vectors(sizes); }
  {
    return solver_.null_vectors(sizes);
  }
  std::span<Index const> dropped() const
    requires requires(Solver const s) { s.dropped(); }
  {
    return solver_.dropped();
  }

 private:
  Solver solver_;
  Sequence<Block> blocks_;
  Sequence<std::size_t> first_;  // index of each block's first value, and one past the last value
  Sequence<double> values_;
  std::size_t next_ = 0;
  mutable VecX r_, dx_;
};

}  // namespace polybody
