// All linear solvers on the same matrices, and the sinks that fill them.

#include <polybody/solvers/auto_lu.hpp>
#include <polybody/solvers/block_factor.hpp>
#include <polybody/solvers/iterative_refinement.hpp>

#include <polybody/testing/linear_solver_laws.hpp>

using namespace polybody;
using namespace polybody::laws;

namespace polybody::test {

bool const linear_solver_obey[] = {obeys<DenseLu, LinearSolvers>("DenseLu"),
                                   obeys<EigenSparseLu, LinearSolvers>("EigenSparseLu"),
                                   obeys<AutoLu, LinearSolvers>("AutoLu"),
                                   obeys<BlockLu, LinearSolvers>("BlockLu"),
                                   obeys<BlockSolver, LinearSolvers>("BlockSolver"),
                                   obeys<IterativeRefinement<BlockSolver>, LinearSolvers>("RefinedBlockSolver")};

}  // namespace polybody::test

// Masses of 1 and 1e9 in one matrix, known solution: refinement leaves a residual of the size of round-off.
TEST(IterativeRefinement, LeavesLessThanTheSolverAlone) {
  laws::Blocks const blocks{12};
  Eigen::VectorXd scale(blocks.size());
  for (Index i = 0; i < scale.size(); ++i) scale[i] = i % 3 == 0 ? 1e5 : 1.0;
  struct Scaled {
    VecX const& s;
    std::vector<std::pair<Block, MatX>> all;
    void add(Index row, Index col, BlockView const& b) {
      MatX m(b.rows, b.cols);
      for (Index i = 0; i < b.rows; ++i)
        for (Index j = 0; j < b.cols; ++j) m(i, j) = b(i, j) * s[row + i] * s[col + j];
      all.push_back({{row, col, b.rows, b.cols}, m});
    }
  } scaled{scale, {}};
  blocks.write(scaled, 1);
  auto const residual = [&](auto solver) {
    std::vector<Block> pattern;
    for (auto const& [block, m] : scaled.all) pattern.push_back(block);
    solver.analyse(blocks.size(), pattern);
    solver.begin();
    MatX a = MatX::Zero(blocks.size(), blocks.size());
    for (auto const& [block, m] : scaled.all) {
      solver.add(block.row, block.col, m);
      a.block(block.row, block.col, block.rows, block.cols) += m;
    }
    EXPECT_EQ(solver.factor(), -1);
    VecX const b = a * VecX::Ones(blocks.size());
    VecX x = b;
    solver.solve(x, x);
    return ((b - a * x).array() / (a.cwiseAbs() * x.cwiseAbs()).array()).abs().maxCoeff();
  };
  double const alone = residual(BlockSolver()), refined = residual(IterativeRefinement<BlockSolver>());
  EXPECT_LT(refined, 1e-15);
  EXPECT_LT(refined, alone);
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
