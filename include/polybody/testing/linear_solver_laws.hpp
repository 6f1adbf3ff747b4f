#pragma once
/// \file
/// The laws that every linear solver obeys, on the same matrices. The solver is its own case:
///
///     bool const dense_lu_obeys = obeys<DenseLu, LinearSolvers>("DenseLu");
///
/// Not in polybody.hpp: needs GoogleTest.

#include <cstdlib>

#include <Eigen/Dense>

#include <polybody/solvers/linear_solver.hpp>
#include <polybody/testing/laws.hpp>

namespace polybody::laws {

/// Bodies of six columns in a row, joints of five rows between neighbours: [M, Gᵀ; G, 0], with blocks that
/// overlap (a second spring on body 0) and come in a fixed order.
struct Blocks {
  Index bodies;                               ///< how many bodies, and joints
  Index size() const { return 11 * bodies; }  ///< rows of the matrix: 6 of a body, 5 of a joint

  /// Adds all blocks to `sink`; `seed` decides their numbers, not their places.
  template <class Sink>
  void write(Sink& sink, unsigned seed) const {
    std::srand(seed);
    using M66 = Mat<double, 6, 6>;
    for (Index i = 0; i < bodies; ++i) {
      M66 const a = M66::Random(), m = a * a.transpose() + M66::Identity();
      sink.add(6 * i, 6 * i, m);
    }
    Mat3 const extra = Mat3::Random();
    sink.add(3, 3, extra);
    for (Index i = 0; i < bodies; ++i) {
      Mat<double, 6, 5> const g = Mat<double, 6, 5>::Random();
      Index const row = 6 * bodies + 5 * i;
      sink.add(6 * i, row, g);
      sink.add(row, 6 * i, g.transpose());
      if (i == 0) continue;
      Mat<double, 6, 5> const before = Mat<double, 6, 5>::Random();
      sink.add(6 * (i - 1), row, before);
      sink.add(row, 6 * (i - 1), before.transpose());
    }
  }
};

/// Adds blocks in place: what a sink must amount to.
struct Plain {
  MatX a;  ///< (n×n) sum of the blocks so far
  /// Adds b with its first entry at (row, col).
  void add(Index row, Index col, BlockView const& b) {
    for (Index i = 0; i < b.rows; ++i)
      for (Index j = 0; j < b.cols; ++j) a(row + i, col + j) += b(i, j);
  }
};

/// The blocks, with the numbers of `seed`, as a dense matrix (n×n).
inline MatX plain(Blocks const& blocks, unsigned seed) {
  Plain sink{MatX::Zero(blocks.size(), blocks.size())};
  blocks.write(sink, seed);
  return sink.a;
}

/// The laws of linear solvers, for one solver.
template <class Solver>
struct LinearSolvers {
  /// A solver that has seen the pattern of the blocks.
  static Solver analysed(Blocks const& blocks) {
    PatternSink pattern;
    blocks.write(pattern, 1);
    Solver solver;
    solver.analyse(blocks.size(), pattern.blocks);
    return solver;
  }

  /// |x − A⁻¹b| < 1e-10 |A⁻¹b| for several matrices of one pattern, and several b of one factorisation.
  void solve_what_full_pivoting_solves();
  /// `factor` names a column of the zero matrix, and serves a sound one afterwards.
  void name_a_column_of_a_singular_matrix();
  /// Where two joints have the same rows, `factor` names a column of one; or the solver drops its rows and tells them.
  void name_one_of_two_equal_joints();
  /// A system without unknowns is factored and solved.
  void nothing_is_solved_at_once();

  static constexpr char const* suite = "LinearSolvers";
  static constexpr Law<LinearSolvers> laws[] = {
      {"SolveWhatFullPivotingSolves", &LinearSolvers::solve_what_full_pivoting_solves},
      {"NameAColumnOfASingularMatrix", &LinearSolvers::name_a_column_of_a_singular_matrix},
      {"NameOneOfTwoEqualJoints", &LinearSolvers::name_one_of_two_equal_joints},
      {"NothingIsSolvedAtOnce", &LinearSolvers::nothing_is_solved_at_once}};
};

template <class Solver>
void LinearSolvers<Solver>::solve_what_full_pivoting_solves() {
  for (Index const bodies : {1, 4, 12}) {
    Blocks const blocks{bodies};
    auto solver = analysed(blocks);
    for (unsigned seed : {1u, 2u, 3u}) {  // one analysis, many values
      solver.begin();
      blocks.write(solver, seed);
      ASSERT_EQ(solver.factor(), -1);
      MatX const a = plain(blocks, seed);
      for (int k = 0; k < 2; ++k) {  // one factorisation, many sides
        VecX const b = VecX::Random(blocks.size());
        VecX x = VecX::Zero(blocks.size());
        solver.solve(b, x);
        VecX const expected = a.fullPivLu().solve(b);
        EXPECT_LT((x - expected).norm(), 1e-10 * expected.norm());
      }
    }
  }
}

template <class Solver>
void LinearSolvers<Solver>::name_a_column_of_a_singular_matrix() {
  for (Index const bodies : {3, 8}) {
    Blocks const blocks{bodies};
    auto solver = analysed(blocks);
    solver.begin();
    Index const column = solver.factor();  // zero throughout
    EXPECT_GE(column, 0);
    EXPECT_LT(column, blocks.size());
    // and after it, a sound matrix again
    solver.begin();
    blocks.write(solver, 1);
    EXPECT_EQ(solver.factor(), -1);
  }
}

// Two joints with the same rows: singular but for rounding, and one of the two is named.
template <class Solver>
void LinearSolvers<Solver>::name_one_of_two_equal_joints() {
  for (Index const bodies : {3, 20}) {
    Index const n = 6 * bodies, size = n + 10;
    std::srand(7);
    Mat<double, 6, 5> const g = Mat<double, 6, 5>::Random();
    Mat<double, 6, 6> const a = Mat<double, 6, 6>::Random();
    Mat<double, 6, 6> const m = a * a.transpose() + Mat<double, 6, 6>::Identity();
    auto const write = [&](auto& sink) {
      for (Index i = 0; i < bodies; ++i) sink.add(6 * i, 6 * i, m);
      for (Index row : {n, n + 5}) {
        sink.add(6, row, g);
        sink.add(row, 6, g.transpose());
      }
    };
    PatternSink pattern;
    write(pattern);
    Solver solver;
    solver.analyse(size, pattern.blocks);
    solver.begin();
    write(solver);
    Index column = solver.factor();
    if constexpr (requires { solver.dropped(); }) {  // the block solvers go on without them
      ASSERT_EQ(column, -1);
      ASSERT_EQ(solver.dropped().size(), 5u);
      column = solver.dropped().front();
    }
    EXPECT_GE(column, n) << bodies;
    EXPECT_LT(column, size) << bodies;
  }
}

template <class Solver>
void LinearSolvers<Solver>::nothing_is_solved_at_once() {
  Solver solver;
  solver.analyse(0, {});
  solver.begin();
  EXPECT_EQ(solver.factor(), -1);
  VecX x;
  solver.solve(VecX(), x);
  EXPECT_EQ(x.size(), 0);
}

}  // namespace polybody::laws
