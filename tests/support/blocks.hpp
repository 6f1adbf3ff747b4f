#pragma once
/// \file A matrix in blocks, for the tests and benchmarks of solvers.

#include <algorithm>
#include <utility>
#include <vector>

#include <polybody/solvers/linear_solver.hpp>

namespace polybody {

/// A matrix of blocks that are written repeatedly in the same order.
struct Blocks {
  std::vector<std::pair<Block, MatX>> all;
  Index size = 0;

  void add(Index row, Index col, MatX const& m) {
    all.push_back({{row, col, m.rows(), m.cols()}, m});
    size = std::max({size, row + m.rows(), col + m.cols()});
  }
  /// G at (row, col) and its transpose.
  void join(Index row, Index col, MatX const& g) {
    add(row, col, g);
    add(col, row, g.transpose());
  }
  template <class Sink>
  void write(Sink& sink) const {
    for (auto const& [b, m] : all) sink.add(b.row, b.col, m);
  }
  MatX dense() const {
    MatX a = MatX::Zero(size, size);
    for (auto const& [b, m] : all) a.block(b.row, b.col, b.rows, b.cols) += m;
    return a;
  }
  /// The solver after the analysis of the block pattern.
  template <class Solver>
  Solver analysed(Solver solver = {}) const {
    PatternSink pattern;
    write(pattern);
    solver.analyse(size, pattern.blocks);
    return solver;
  }
};

}  // namespace polybody
