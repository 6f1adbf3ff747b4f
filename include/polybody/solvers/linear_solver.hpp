#pragma once
/// \file
/// What a linear solver offers: it is itself the sink into which the tangent is written.

#include <algorithm>
#include <vector>

#include <polybody/math/block_view.hpp>

namespace polybody {

/// Place of a block in the matrix.
struct Block {
  Index row, col, rows, cols;
};

/// Records where blocks go, in the order in which they come.
struct PatternSink {
  std::vector<Block> blocks;
  void add(Index row, Index col, BlockView const& b) { blocks.push_back({row, col, b.rows, b.cols}); }
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

/// Writes the matrix into the solver and factors it; twice where the solver asks for it in another order.
/// Returns −1, or the column without a usable pivot.
template <LinearSolver S, class Write>
Index write_and_factor(S& solver, Write&& write) {
  for (;;) {
    solver.begin();
    write(solver);
    Index const bad = solver.factor();
    if constexpr (requires { solver.reordered(); })
      if (bad >= 0 && solver.reordered()) continue;
    return bad;
  }
}

}  // namespace polybody
