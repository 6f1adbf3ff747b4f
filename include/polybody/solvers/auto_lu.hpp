#pragma once
#include <polybody/solvers/dense_lu.hpp>
#include <polybody/solvers/sparse_lu.hpp>

namespace polybody {

/// Dense LU up to `dense_limit` unknowns, sparse LU above: the default.
class AutoLu {
 public:
  static constexpr Index dense_limit = 64;

  void analyse(Index size, std::vector<Block> const& blocks) {
    small_ = size <= dense_limit;
    if (small_)
      dense_.analyse(size, blocks);
    else
      sparse_.analyse(size, blocks);
  }
  void begin() { small_ ? dense_.begin() : sparse_.begin(); }
  void add(Index row, Index col, BlockView const& b) {
    small_ ? dense_.add(row, col, b) : sparse_.add(row, col, b);
  }
  Index factor() { return small_ ? dense_.factor() : sparse_.factor(); }
  void solve(VecX const& b, VecX& x) const { small_ ? dense_.solve(b, x) : sparse_.solve(b, x); }

 private:
  bool small_ = true;
  DenseLu dense_;
  SparseLu sparse_;
};

static_assert(LinearSolver<AutoLu>);

}  // namespace polybody
