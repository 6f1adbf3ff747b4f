#pragma once
/// \file
/// What a linear solver offers: it is itself the sink into which the tangent is written.

#include <vector>

#include <polybody/math/types.hpp>

namespace polybody {

/// Place of a block in the matrix.
struct Block {
  Index row, col, rows, cols;
};

/// Records where blocks go, in the order in which they come.
struct PatternSink {
  std::vector<Block> blocks;
  template <class Derived>
  void add(Index row, Index col, Eigen::MatrixBase<Derived> const& b) {
    blocks.push_back({row, col, b.rows(), b.cols()});
  }
};

/// analyse (once, allocates) → begin → add… → factor → solve…; the blocks come in the analysed order.
template <class S>
concept LinearSolver = requires(S s, std::vector<Block> const blocks, Mat3 const block, VecX const b, VecX x) {
  s.analyse(Index(1), blocks);
  s.begin();
  s.add(Index(0), Index(0), block);
  { s.factor() } -> std::convertible_to<Index>;  // −1, or the column without a usable pivot
  s.solve(b, x);
};

}  // namespace polybody
