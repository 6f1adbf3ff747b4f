// Every linear solver, on the same matrices.

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include <polybody/solvers/auto_lu.hpp>
#include <polybody/solvers/block_lu.hpp>

using namespace polybody;

namespace {

/// Bodies of six columns in a row, joints of five rows between neighbours: [M, Gᵀ; G, 0], with blocks that
/// overlap (a second spring on body 0) and come in a fixed order.
struct Blocks {
  Index bodies;
  Index size() const { return 11 * bodies; }

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
  MatX a;
  void add(Index row, Index col, BlockView const& b) {
    for (Index i = 0; i < b.rows; ++i)
      for (Index j = 0; j < b.cols; ++j) a(row + i, col + j) += b(i, j);
  }
};

MatX plain(Blocks const& blocks, unsigned seed) {
  Plain sink{MatX::Zero(blocks.size(), blocks.size())};
  blocks.write(sink, seed);
  return sink.a;
}

template <class Solver>
struct LinearSolvers : testing::Test {
  static Solver analysed(Blocks const& blocks) {
    PatternSink pattern;
    blocks.write(pattern, 1);
    Solver solver;
    solver.analyse(blocks.size(), pattern.blocks);
    return solver;
  }
};
using Solvers = testing::Types<DenseLu, EigenSparseLu, AutoLu, BlockLu, BlockSolver>;
TYPED_TEST_SUITE(LinearSolvers, Solvers);

}  // namespace

TYPED_TEST(LinearSolvers, SolveWhatFullPivotingSolves) {
  for (Index const bodies : {1, 4, 12}) {
    Blocks const blocks{bodies};
    auto solver = this->analysed(blocks);
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

TYPED_TEST(LinearSolvers, NameAColumnOfASingularMatrix) {
  for (Index const bodies : {3, 8}) {
    Blocks const blocks{bodies};
    auto solver = this->analysed(blocks);
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
TYPED_TEST(LinearSolvers, NameOneOfTwoEqualJoints) {
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
    TypeParam solver;
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

TYPED_TEST(LinearSolvers, NothingIsSolvedAtOnce) {
  TypeParam solver;
  solver.analyse(0, {});
  solver.begin();
  EXPECT_EQ(solver.factor(), -1);
  VecX x;
  solver.solve(VecX(), x);
  EXPECT_EQ(x.size(), 0);
}

TEST(PatternSink, RecordsBlocksInTheOrderInWhichTheyCome) {
  PatternSink sink;
  Mat<double, 6, 5> const g = Mat<double, 6, 5>::Zero();
  sink.add(0, 12, g);
  sink.add(12, 0, g.transpose());
  sink.add(6, 6, MatX::Zero(3, 3).eval());
  ASSERT_EQ(sink.blocks.size(), 3u);
  std::array<Block, 3> const expected{Block{0, 12, 6, 5}, Block{12, 0, 5, 6}, Block{6, 6, 3, 3}};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(sink.blocks[i].row, expected[i].row);
    EXPECT_EQ(sink.blocks[i].col, expected[i].col);
    EXPECT_EQ(sink.blocks[i].rows, expected[i].rows);
    EXPECT_EQ(sink.blocks[i].cols, expected[i].cols);
  }
}

TEST(BlockView, SeesAMatrixWhereverItStands) {
  MatX const a = MatX::Random(7, 9);
  Eigen::Matrix<double, 4, 3, Eigen::RowMajor> const by_rows = Eigen::Matrix<double, 4, 3>::Random();
  auto const expect_view = [](auto const& m) {
    BlockView const view(m);
    ASSERT_EQ(view.rows, m.rows());
    ASSERT_EQ(view.cols, m.cols());
    for (Index i = 0; i < m.rows(); ++i)
      for (Index j = 0; j < m.cols(); ++j) EXPECT_EQ(view(i, j), m(i, j));
  };
  expect_view(a);
  expect_view(a.transpose());
  expect_view(a.block(2, 3, 4, 5));
  expect_view(a.block(2, 3, 4, 5).transpose());
  expect_view(a.row(3));
  expect_view(a.col(3).transpose());
  expect_view(by_rows);
  expect_view(by_rows.transpose());
}

static_assert(LinearSolver<DenseLu> && LinearSolver<EigenSparseLu> && LinearSolver<AutoLu>);
static_assert(!LinearSolver<PatternSink> && !LinearSolver<MatX>);
