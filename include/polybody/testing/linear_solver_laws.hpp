#pragma once
/// \file
/// Tests of properties that every linear solver has: `LinearSolvers`.
///
/// Requires GoogleTest.

#include <cstdlib>

#include <Eigen/Dense>

#include <polybody/solvers/linear_solver.hpp>
#include <polybody/testing/laws.hpp>

namespace polybody::laws {

/// Saddle-point matrix [M, Gᵀ; G, 0] of a chain of bodies with six columns each, and joints with five constraint
/// equations each. A joint connects body 0 to the ground; the others connect neighbours. One block overlaps another (a
/// spring on body 0). The order of the blocks is fixed.
struct Blocks {
  Index bodies;                               ///< number of bodies, and of joints
  Index size() const { return 11 * bodies; }  ///< rows of the matrix: 6 per body, 5 per joint

  /// Adds all blocks to `sink`. The `seed` determines the values of the blocks, but not their positions.
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

/// Sink that adds blocks to a dense matrix, as the reference for other sinks.
struct Plain {
  MatX a;  ///< (n×n) sum of the added blocks
  /// Adds b; its first entry is at (row, col).
  void add(Index row, Index col, BlockView const& b) {
    for (Index i = 0; i < b.rows; ++i)
      for (Index j = 0; j < b.cols; ++j) a(row + i, col + j) += b(i, j);
  }
};

/// Dense matrix (n×n) of the blocks, with the values that belong to `seed`.
inline MatX plain(Blocks const& blocks, unsigned seed) {
  Plain sink{MatX::Zero(blocks.size(), blocks.size())};
  blocks.write(sink, seed);
  return sink.a;
}

/// Laws that every linear solver satisfies. All solvers are tested with the same matrices. The solver itself is the
/// case:
///
///     bool const dense_lu_obeys = obeys<DenseLu, LinearSolvers>("DenseLu");
template <class Solver>
struct LinearSolvers {
  /// Solver after the analysis of the pattern of the blocks.
  static Solver analysed(Blocks const& blocks) {
    PatternSink pattern;
    blocks.write(pattern, 1);
    Solver solver;
    solver.analyse(blocks.size(), pattern.blocks);
    return solver;
  }

  /// |x − A⁻¹b| < 1e-10 |A⁻¹b| for several matrices of one pattern, and for several b with one factorisation.
  void solve_what_full_pivoting_solves();
  /// For the zero matrix `factor` returns the index of a column. Afterwards `factor` succeeds for a regular matrix.
  void name_a_column_of_a_singular_matrix();
  /// If two joints have the same constraint equations, `factor` returns the index of a column of one of these joints. A
  /// solver may instead drop the redundant constraint equations and list them in `dropped()`.
  void name_one_of_two_equal_joints();
  /// A system without unknowns is factorised and solved.
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
    for (unsigned seed : {1u, 2u, 3u}) {  // one analysis for several matrices
      solver.begin();
      blocks.write(solver, seed);
      ASSERT_EQ(solver.factor(), -1);
      MatX const a = plain(blocks, seed);
      for (int k = 0; k < 2; ++k) {  // one factorisation for several right-hand sides
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
    Index const column = solver.factor();  // the matrix is zero
    EXPECT_GE(column, 0);
    EXPECT_LT(column, blocks.size());
    // the next matrix is regular
    solver.begin();
    blocks.write(solver, 1);
    EXPECT_EQ(solver.factor(), -1);
  }
}

// Two joints with the same constraint equations: the matrix is singular up to round-off, and a column of one joint is
// returned.
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
    if constexpr (requires { solver.dropped(); }) {  // the block solvers drop redundant constraints
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
