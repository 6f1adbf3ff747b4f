// The block solvers against full pivoting, for partly singular matrices and for redundant constraints.
#include <polybody/solvers/block_factor.hpp>

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <random>

#include "support/blocks.hpp"

using namespace polybody;

namespace block_factor_test {

struct Draw {
  std::mt19937 engine{3};
  MatX matrix(Index m, Index n) {
    std::uniform_real_distribution<double> d(-1.0, 1.0);
    return MatX::NullaryExpr(m, n, [&] { return d(engine); });
  }
  MatX definite(Index n) {
    MatX const a = matrix(n, n);
    return a * a.transpose() + MatX::Identity(n, n);
  }
};

/// A chain of bodies with n columns that hangs from the ground, on joints with m constraint equations.
Blocks chain(Index bodies, Index n, Index m, Draw& draw) {
  Blocks b;
  for (Index i = 0; i < bodies; ++i) b.add(n * i, n * i, draw.definite(n));
  for (Index i = 0; i < bodies; ++i) {
    b.join(n * bodies + m * i, n * i, draw.matrix(m, n));
    if (i > 0) b.join(n * bodies + m * i, n * (i - 1), draw.matrix(m, n));
  }
  return b;
}

/// Largest |A x − b| relative to |b| for a random b.
template <class Solver>
double residual(Blocks const& blocks, Solver const& solver, Draw& draw) {
  MatX const a = blocks.dense();
  VecX const b = draw.matrix(blocks.size, 1);
  VecX x = VecX::Zero(blocks.size);
  solver.solve(b, x);
  return (a * x - b).norm() / (b.norm() + a.norm() * x.norm());
}

template <class Solver>
struct BlockSolvers : testing::Test {
  Draw draw;
  /// Analyses, factorises, and expects success and a small residual.
  Solver solved(Blocks const& blocks, double tolerance = 1e-13) {
    Solver solver = blocks.analysed<Solver>();
    EXPECT_EQ(write_and_factor(solver, [&](BlockSink& s) { blocks.write(s); }), -1);
    EXPECT_LT(residual(blocks, solver, draw), tolerance);
    return solver;
  }
};
using All = testing::Types<BlockLdlt, BlockLu, BlockSolver>;
TYPED_TEST_SUITE(BlockSolvers, All);

TYPED_TEST(BlockSolvers, SolveChainsOfEveryBlockSize) {
  for (auto const& [n, m] : {std::pair{6, 5}, {6, 3}, {3, 2}, {3, 1}, {4, 2}, {7, 6}, {12, 6}, {1, 1}})
    for (Index const bodies : {1, 2, 9}) this->solved(chain(bodies, n, m, this->draw));
}

// Two constraint equations of each joint are nearly redundant, as near a singular configuration. The residual of a
// moderate solution is about a tenth of the residual that the multipliers of such joints would cause (8e-11).
TYPED_TEST(BlockSolvers, LoseNothingToRowsThatNearlyRepeatOthers) {
  Draw& draw = this->draw;
  Blocks b;
  Index const bodies = 9, n = 6, m = 5;
  for (Index i = 0; i < bodies; ++i) b.add(n * i, n * i, draw.definite(n));
  for (Index i = 0; i < bodies; ++i)
    for (Index k = 0; k < (i > 0 ? 2 : 1); ++k) {
      MatX rows = draw.matrix(m, n);
      rows.row(3) = rows.row(1) + 1e-4 * rows.row(3);
      b.join(n * bodies + m * i, n * (i - k), rows);
    }
  TypeParam const solver = this->solved(b, 1e-10);
  MatX const a = b.dense();
  VecX const moderate = draw.matrix(b.size, 1), rhs = a * moderate;
  VecX x = VecX::Zero(b.size);
  solver.solve(rhs, x);
  EXPECT_LT((a * x - rhs).norm(), 1e-11 * (rhs.norm() + a.norm() * x.norm()));
}

// Elements share nodes; joints are at the ends and within an element.
TYPED_TEST(BlockSolvers, SolveFlexibleBodies) {
  Draw& draw = this->draw;
  Blocks b;
  for (Index e = 0; e < 5; ++e) b.add(4 * e, 4 * e, draw.definite(8));            // 24 columns
  for (Index e = 0; e < 3; ++e) b.add(24 + 3 * e, 24 + 3 * e, draw.definite(6));  // 12 more columns
  MatX at_start = draw.matrix(2, 8);
  at_start.rightCols(4).setZero();  // a marker on a node: the other node of its element does not move it
  b.join(36, 0, at_start);
  b.join(38, 16, draw.matrix(3, 8));  // a joint of both bodies
  b.join(38, 24, draw.matrix(3, 6));
  MatX at_end = draw.matrix(2, 6);
  at_end.leftCols(3).setZero();
  b.join(41, 30, at_end);  // closes the loop
  this->solved(b);
}

// A welded body cannot move relative to the body that carries it. A constraint equation between it and the ground
// constrains both bodies.
TYPED_TEST(BlockSolvers, KeepARowOfTheGroundOnABodyThatHangsOnAnother) {
  Draw& draw = this->draw;
  Blocks b;
  for (Index i = 0; i < 5; ++i) b.add(6 * i, 6 * i, draw.definite(6));
  Index row = 30;
  // the first body has the most joints: it is the root
  for (auto const& [from, to] : {std::pair{0, 1}, {0, 3}, {0, 4}, {1, 2}}) {
    b.join(row, 6 * from, draw.matrix(6, 6));
    b.join(row, 6 * to, draw.matrix(6, 6));
    row += 6;
  }
  b.join(row, 12, draw.matrix(1, 6));
  EXPECT_TRUE(this->solved(b, 1e-11).dropped().empty());
}

// It cannot move relative to the point of the bar that carries it, but the other points of the bar can. Both ends of
// the bar are fixed.
TYPED_TEST(BlockSolvers, KeepASecondJointToAnotherPointOfABar) {
  Draw& draw = this->draw;
  Blocks b;
  for (Index const element : {0, 6}) b.add(element, element, draw.definite(12));
  b.add(18, 18, draw.definite(6));
  b.join(24, 0, draw.matrix(6, 6));
  b.join(30, 12, draw.matrix(6, 6));
  b.join(36, 0, draw.matrix(6, 6));
  b.join(36, 18, draw.matrix(6, 6));
  b.join(42, 6, draw.matrix(3, 6));
  b.join(42, 18, draw.matrix(3, 6));
  EXPECT_TRUE(this->solved(b, 1e-11).dropped().empty());
}

// A marker on the second node of its element: the first node alone cannot carry the joint.
TYPED_TEST(BlockSolvers, FindThePivotOfAJointOnTheOtherNode) {
  Draw& draw = this->draw;
  Blocks b;
  for (Index e = 0; e < 3; ++e) b.add(3 * e, 3 * e, draw.definite(6));
  MatX g = draw.matrix(2, 6);
  g.leftCols(3).setZero();
  b.join(12, 6, g);
  this->solved(b);
}

// Springs connect bodies across the tree: more fill, the same solution.
TYPED_TEST(BlockSolvers, SolveWithSpringsBetweenBodies) {
  Draw& draw = this->draw;
  Blocks b = chain(12, 6, 5, draw);
  for (auto const& [i, j] : {std::pair{0, 7}, {3, 11}, {2, 9}}) {
    MatX const both = 0.3 * draw.definite(12);
    b.add(6 * i, 6 * i, both.topLeftCorner(6, 6));
    b.add(6 * j, 6 * j, both.bottomRightCorner(6, 6));
    b.join(6 * i, 6 * j, both.topRightCorner(6, 6));
  }
  this->solved(b);
}

// The chain is not connected to the ground: the tree starts at one of its own bodies.
TYPED_TEST(BlockSolvers, SolveWhatDoesNotTouchTheGround) {
  Draw& draw = this->draw;
  Blocks b;
  for (Index i = 0; i < 5; ++i) b.add(6 * i, 6 * i, draw.definite(6));
  for (Index i = 1; i < 5; ++i) {
    b.join(25 + 5 * i, 6 * i, draw.matrix(5, 6));
    b.join(25 + 5 * i, 6 * (i - 1), draw.matrix(5, 6));
  }
  this->solved(b);
}

// Thin rods (no inertia about their axis) and point masses: constraint equations constrain the motions without mass.
TYPED_TEST(BlockSolvers, SolveSingularMasses) {
  Draw& draw = this->draw;
  for (Index const bodies : {1, 3, 40}) {
    Blocks b = chain(bodies, 6, 5, draw);
    for (Index i = 0; i < bodies; ++i) {
      Vec6 thin;
      thin << 2, 2, 2, 0, 0.3, 0.3;
      b.all[std::size_t(i)].second = thin.asDiagonal();
    }
    TypeParam const solver = this->solved(b);
    EXPECT_LT(solver.nodes(), 2 * bodies);  // body and joint are merged
  }
  // Euler parameters: seven columns, a mass matrix that is singular along p, and the constraint row pᵀ of the norm
  Blocks b;
  VecX const p = draw.matrix(4, 1).normalized();
  MatX const q = draw.matrix(4, 4);
  MatX const across = MatX::Identity(4, 4) - p * p.transpose();
  for (Index i = 0; i < 3; ++i) {
    MatX m = MatX::Identity(7, 7);
    m.bottomRightCorner(4, 4) = across * (q * q.transpose() + MatX::Identity(4, 4)) * across;
    b.add(7 * i, 7 * i, m);
  }
  for (Index i = 0; i < 3; ++i) {
    MatX norm = MatX::Zero(1, 7);
    norm.rightCols(4) = p.transpose();
    b.join(21 + i, 7 * i, norm);
    b.join(24 + 3 * i, 7 * i, draw.matrix(3, 7));
    if (i > 0) b.join(24 + 3 * i, 7 * (i - 1), draw.matrix(3, 7));
  }
  this->solved(b);
}

// A doubled joint: its constraint equations are dropped, and the velocities and forces remain correct.
TYPED_TEST(BlockSolvers, DropRowsThatRepeatOthers) {
  Draw& draw = this->draw;
  for (Index const bodies : {2, 30}) {
    Blocks b = chain(bodies, 6, 5, draw);
    Index const row = b.size;
    // the joint that closes the loop repeats the last joint of the chain, with its constraint equations combined
    MatX const dense = b.dense(), mix = draw.matrix(5, 5);
    Index const last = 6 * bodies + 5 * (bodies - 1);
    b.join(row, 6 * (bodies - 1), mix * dense.block(last, 6 * (bodies - 1), 5, 6));
    b.join(row, 6 * (bodies - 2), mix * dense.block(last, 6 * (bodies - 2), 5, 6));
    TypeParam solver = b.analysed<TypeParam>();
    ASSERT_EQ(write_and_factor(solver, [&](BlockSink& s) { b.write(s); }), -1);
    ASSERT_EQ(solver.dropped().size(), 5u);
    for (Index const i : solver.dropped()) EXPECT_GE(i, row);
    // a right-hand side that is consistent with the redundant constraints
    MatX const a = b.dense();
    VecX const y = draw.matrix(b.size, 1), rhs = a * y;
    VecX x = VecX::Zero(b.size);
    solver.solve(rhs, x);
    EXPECT_LT((x - y).head(6 * bodies).norm(), 1e-9 * y.norm());  // velocities
    EXPECT_LT((a * x - rhs).norm(), 1e-9 * rhs.norm());           // Gᵀλ is correct as well
    for (Index const i : solver.dropped()) EXPECT_EQ(x[i], 0.0);
  }
}

// Square roots of the diagonal of the masses, and of G D⁻¹ Gᵀ with this diagonal D.
VecX sizes_of(Blocks const& blocks, Index velocities) {
  MatX const a = blocks.dense();
  VecX sizes = a.diagonal();
  for (Index i = velocities; i < a.rows(); ++i)
    for (Index j = 0; j < velocities; ++j) sizes[i] += a(i, j) * a(i, j) / a(j, j);
  return sizes.cwiseSqrt();
}
/// Largest error of the null vectors of the dropped equations, relative to 1: A n = 0 in all other rows, n = 1 at its
/// own equation and 0 at the other dropped ones. Sets `entries` to the number of all entries.
template <class Solver>
double error_of_null_vectors(Blocks const& blocks, Solver const& solver, Index velocities, std::size_t& entries) {
  auto const vectors = solver.null_vectors(sizes_of(blocks, velocities));
  EXPECT_EQ(vectors.size(), solver.dropped().size());
  MatX const a = blocks.dense();
  double worst = 0.0;
  entries = 0;
  for (std::size_t k = 0; k < vectors.size(); ++k) {
    VecX n = VecX::Zero(blocks.size);
    for (auto const& [i, value] : vectors[k]) n[i] = value;
    entries += vectors[k].size();
    VecX left = a * n;
    for (Index const i : solver.dropped()) {
      worst = std::max(worst, std::abs(n[i] - (i == solver.dropped()[k] ? 1.0 : 0.0)));
      left[i] = 0.0;
    }
    worst = std::max(worst, largest_size(left));
  }
  return worst;
}
// Each joint of a chain is doubled. A null vector of a repeated equation has two entries in a chain of any length.
TYPED_TEST(BlockSolvers, FindTheNullVectorsOfADoubledChainByTwoEntries) {
  Draw& draw = this->draw;
  for (Index const bodies : {2, 9, 24}) {
    Blocks b;
    for (Index i = 0; i < bodies; ++i) b.add(6 * i, 6 * i, draw.definite(6));
    for (Index i = 0; i < bodies; ++i) {
      MatX const own = draw.matrix(3, 6), other = draw.matrix(3, 6);
      for (Index copy = 0; copy < 2; ++copy) {
        b.join(6 * bodies + 3 * (2 * i + copy), 6 * i, own);
        if (i > 0) b.join(6 * bodies + 3 * (2 * i + copy), 6 * (i - 1), other);
      }
    }
    TypeParam solver = b.analysed<TypeParam>();
    ASSERT_EQ(write_and_factor(solver, [&](BlockSink& s) { b.write(s); }), -1);
    ASSERT_EQ(solver.dropped().size(), std::size_t(3 * bodies));
    std::size_t entries = 0;
    EXPECT_LT(error_of_null_vectors(b, solver, 6 * bodies, entries), 1e-9);
    EXPECT_EQ(entries, 2 * solver.dropped().size());
  }
}
// A loop of random joints, closed by combinations of the equations of one of them: null vectors with several entries.
// Two bodies are so heavy that entries without their scale would be lost.
TYPED_TEST(BlockSolvers, FindTheNullVectorsOfCombinedRows) {
  Draw& draw = this->draw;
  Blocks b = chain(12, 6, 5, draw);
  MatX const dense = b.dense(), mix = draw.matrix(5, 5);
  Index const row = b.size, joint = 6 * 12 + 5 * 7;
  b.join(row, 6 * 7, mix * dense.block(joint, 6 * 7, 5, 6));
  b.join(row, 6 * 6, mix * dense.block(joint, 6 * 6, 5, 6));
  for (Index const heavy : {2, 7}) b.add(6 * heavy, 6 * heavy, 1e6 * MatX::Identity(6, 6));
  TypeParam solver = b.analysed<TypeParam>();
  ASSERT_EQ(write_and_factor(solver, [&](BlockSink& s) { b.write(s); }), -1);
  ASSERT_EQ(solver.dropped().size(), 5u);
  std::size_t entries = 0;
  EXPECT_LT(error_of_null_vectors(b, solver, 72, entries), 1e-8);
  EXPECT_EQ(entries, 5u * 6u);
}

TYPED_TEST(BlockSolvers, SolveSeveralSidesAtOnce) {
  Blocks const b = chain(7, 6, 5, this->draw);
  TypeParam const solver = this->solved(b);
  MatX const sides = this->draw.matrix(b.size, 3);
  MatX x = MatX::Zero(b.size, 3);
  solver.solve(sides, x);
  EXPECT_LT((b.dense() * x - sides).norm(), 1e-11 * sides.norm());
  // solution in place
  VecX y = sides.col(1);
  solver.solve(y, y);
  EXPECT_EQ(y, x.col(1));
}

TYPED_TEST(BlockSolvers, RepeatToTheLastBit) {
  Blocks const b = chain(20, 6, 5, this->draw);
  TypeParam solver = this->solved(b);
  VecX const side = VecX::Ones(b.size);
  VecX first = side, second = side;
  solver.solve(side, first);
  write_and_factor(solver, [&](BlockSink& s) { b.write(s); });
  solver.solve(side, second);
  EXPECT_EQ(first, second);
}

// Operations and fill per link are independent of the length of the chain.
TYPED_TEST(BlockSolvers, GrowLinearlyWithAChain) {
  auto const solver_of = [&](Index bodies) { return chain(bodies, 6, 5, this->draw).template analysed<TypeParam>(); };
  auto const short_one = solver_of(64), long_one = solver_of(1024);
  EXPECT_NEAR(long_one.flops() / short_one.flops(), 16.0, 0.5);
  EXPECT_NEAR(double(long_one.fill()) / double(short_one.fill()), 16.0, 0.5);
}

// A loop costs a border of the closing joint, not a dense matrix.
TYPED_TEST(BlockSolvers, CloseALoopAtTheCostOfABorder) {
  Blocks open = chain(256, 6, 5, this->draw), closed = open;
  closed.join(closed.size, 6 * 255, this->draw.matrix(1, 6));
  EXPECT_LT(closed.analysed<TypeParam>().flops(), 2.0 * open.analysed<TypeParam>().flops());
}

// The elimination order that a matrix has caused can be restored. Then other matrices have bitwise identical results.
TYPED_TEST(BlockSolvers, GoBackToAnEarlierOrder) {
  Blocks const sound = chain(5, 6, 5, this->draw);
  Blocks thin = sound;
  for (std::size_t i = 0; i < 5; ++i) {
    thin.all[i].second.row(3).setZero();
    thin.all[i].second.col(3).setZero();
  }
  TypeParam solver = this->solved(sound);
  VecX const side = VecX::Ones(sound.size);
  VecX first = side, thinned = side, x = side;
  solver.solve(side, first);
  auto const order = solver.order();
  EXPECT_EQ(solver.reorderings(), 0u);

  write_and_factor(solver, [&](BlockSink& s) { thin.write(s); });
  solver.solve(side, thinned);
  EXPECT_GT(solver.reorderings(), 0u);
  EXPECT_NE(solver.order(), order);
  solver.limit_reorderings(0);
  EXPECT_EQ(solver.reorderings(), 0u);
  solver.solve(side, x);
  EXPECT_EQ(x, thinned);  // the factor remains until the next one is begun
  write_and_factor(solver, [&](BlockSink& s) { sound.write(s); });
  EXPECT_EQ(solver.order(), order);
  solver.solve(side, x);
  EXPECT_EQ(x, first);
  // the solver changes its order again
  write_and_factor(solver, [&](BlockSink& s) { thin.write(s); });
  solver.solve(side, x);
  EXPECT_EQ(x, thinned);
}

TYPED_TEST(BlockSolvers, SayWhichUnknownIsNotFinite) {
  Blocks b = chain(4, 6, 5, this->draw);
  b.all[2].second(1, 1) = std::numeric_limits<double>::quiet_NaN();
  TypeParam solver = b.analysed<TypeParam>();
  solver.begin();
  b.write(solver);
  EXPECT_GE(solver.factor(), 0);
  EXPECT_FALSE(solver.reordered());
}

TEST(BlockSolver, TakesTheHalfOfTheWorkOnlyWhenItMay) {
  Draw draw;
  Blocks b = chain(6, 6, 5, draw);
  BlockSolver solver = b.analysed<BlockSolver>();
  solver.begin();
  b.write(solver);
  ASSERT_EQ(solver.factor(), -1);
  EXPECT_TRUE(solver.was_symmetric());
  b.all[3].second += 0.2 * draw.matrix(6, 6);
  solver.begin();
  b.write(solver);
  ASSERT_EQ(solver.factor(), -1);
  EXPECT_FALSE(solver.was_symmetric());
  EXPECT_LT(residual(b, solver, draw), 1e-13);
}

TEST(BlockLu, SolvesUnsymmetricTangents) {
  Draw draw;
  for (Index const bodies : {1, 8, 40}) {
    Blocks b = chain(bodies, 6, 5, draw);
    for (auto& [block, m] : b.all)
      if (block.row == block.col) m += 0.3 * draw.matrix(6, 6);
    auto solver = b.analysed<BlockLu>();
    ASSERT_EQ(write_and_factor(solver, [&](BlockSink& s) { b.write(s); }), -1);
    EXPECT_LT(residual(b, solver, draw), 1e-13);
  }
}

/// A row of elements with twelve unknowns each. The next element shares the four unknowns at the end of a link, which
/// are not in sequence among its own eight.
Blocks cables(Index links, Draw& draw) {
  Blocks b;
  for (Index i = 0; i < links; ++i) {
    MatX const k = draw.definite(12);
    auto const add = [&](Index row, Index rows, Index from_row, Index col, Index cols, Index from_col) {
      b.add(row, col, k.block(from_row, from_col, rows, cols));
    };
    bool const last = i + 1 == links;
    std::vector<std::array<Index, 3>> parts{{8 * i, 8, 0}};  // first, size, position in k
    if (!last) parts.push_back({8 * (i + 1), 3, 8});
    if (!last) parts.push_back({8 * (i + 1) + 4, 1, 11});
    for (auto const& r : parts)
      for (auto const& c : parts) add(r[0], r[1], r[2], c[0], c[1], c[2]);
  }
  return b;
}

// Unknowns of a body that touch the same unknowns are eliminated together: two nodes per link, not five.
TYPED_TEST(BlockSolvers, JoinsWhatTouchesTheSame) {
  Blocks const b = cables(9, this->draw);
  TypeParam const solver = this->solved(b);
  EXPECT_LE(solver.nodes(), 18);
}

// A body of 24 unknowns is divided into four nodes of six, for kernels with constant sizes.
TYPED_TEST(BlockSolvers, DividesLargeBodies) {
  Blocks const b = chain(5, 24, 5, this->draw);
  TypeParam const solver = this->solved(b);
  EXPECT_EQ(solver.nodes(), 5 * 4 + 5);
}

}  // namespace block_factor_test
