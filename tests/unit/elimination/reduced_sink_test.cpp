// Blocks of a full tangent that are added to a reduced system: PᵀBP, for any action of P on the unknowns of a block.
#include <gtest/gtest.h>

#include <polybody/elimination/reduced_sink.hpp>
#include <polybody/solvers/block_factor.hpp>
#include <polybody/solvers/linear_solver.hpp>

#include <random>

using namespace polybody;

namespace mapped_sink_test {

using Targets = Sequence<Sequence<UnknownMap::Target>>;

/// Adds blocks in place, and records their positions.
struct Plain {
  MatX a;
  std::vector<std::array<Index, 4>> calls = {};
  void add(Index row, Index col, BlockView const& b) {
    calls.push_back({row, col, b.rows, b.cols});
    for (Index i = 0; i < b.rows; ++i)
      for (Index j = 0; j < b.cols; ++j) a(row + i, col + j) += b(i, j);
  }
  void skip(Index row, Index col, Index rows, Index cols) { calls.push_back({row, col, rows, cols}); }
};
static_assert(ZeroSkippingReceiver<Plain>);

MatX matrix_of(Targets const& targets, Index size) {
  MatX p = MatX::Zero(Index(targets.size()), size);
  for (std::size_t i = 0; i < targets.size(); ++i)
    for (auto const& t : targets[i]) p(Index(i), t.unknown) += t.factor;
  return p;
}

/// Twelve unknowns. 3 … 5 are mapped to the same unknowns as 0 … 2 of their neighbour, one is omitted, and one
/// depends on two others.
Targets by_choice() {
  return {{{4, 1.0}}, {{5, 1.0}}, {{6, 1.0}}, {{0, 1.0}}, {{1, 1.0}}, {{2, 1.0}},
          {{4, 1.0}}, {},         {{3, 1.0}}, {{7, 1.0}}, {{8, 1.0}}, {{9, 1.0}}};
}
Targets by_factors() {
  Targets t = by_choice();
  t[8] = {{3, 0.5}, {9, -2.0}};
  t[2] = {{6, -1.0}};
  return t;
}

void expect_pulled(Targets const& targets) {
  Index const size = 10, full = Index(targets.size());
  UnknownMap const map(targets);
  MappedBlocks kept;
  MatX const p = matrix_of(targets, size);
  std::mt19937 random(3);
  for (int pass = 0; pass < 2; ++pass) {  // the second pass finds its ranges
    MatX all = MatX::Zero(full, full);
    Plain sink{MatX::Zero(size, size)};
    BlockSink receiver(sink);
    MappedSink mapped(map, kept, receiver);
    for (int k = 0; k < 40; ++k) {
      auto const of = [&](Index n) { return Index(random() % unsigned(n)); };
      Index const rows = 1 + of(full), cols = 1 + of(full), row = of(full - rows + 1), col = of(full - cols + 1);
      MatX const b = MatX::Random(rows, cols);
      all.block(row, col, rows, cols) += b;
      mapped.add(row, col, b);
      all.block(row, col, rows, cols) += b;
      mapped.add(row, col, MatX(b.transpose()).transpose());
    }
    EXPECT_LT((sink.a - p.transpose() * all * p).norm(), 1e-12 * all.norm());
  }
}

TEST(MappedSink, PullsBlocksWhereUnknownsAreChosen) { expect_pulled(by_choice()); }
TEST(MappedSink, PullsBlocksWhereUnknownsDependOnOthers) { expect_pulled(by_factors()); }

TEST(MappedSink, SkipsWhatItWouldAdd) {
  for (Targets const& targets : {by_choice(), by_factors()}) {
    UnknownMap const map(targets);
    MappedBlocks kept;
    Plain added{MatX::Zero(10, 10)}, skipped{MatX::Zero(10, 10)};
    BlockSink of_added(added), of_skipped(skipped);
    MappedSink adds(map, kept, of_added), skips(map, kept, of_skipped);
    for (Index row = 0; row < 12; ++row)
      for (Index rows = 1; row + rows <= 12; ++rows)
        for (Index col = 0; col < 12; ++col) {
          Index const cols = std::min<Index>(3, 12 - col);
          adds.add(row, col, MatX(MatX::Zero(rows, cols)));
          skips.skip(row, col, rows, cols);
        }
    EXPECT_EQ(added.calls, skipped.calls);
  }
}

/// Four bodies in a row. One link between them has no stiffness: its blocks are skipped, or added as zeros.
template <class Sink>
void write_chain(Sink& sink, bool skips) {
  std::srand(7);
  for (Index i = 0; i < 4; ++i) {
    Mat3 const a = Mat3::Random(), m = a * a.transpose() + Mat3::Identity(),
               c = i == 2 ? Mat3(Mat3::Zero()) : Mat3(0.1 * Mat3::Random());
    sink.add(3 * i, 3 * i, m);
    if (i == 0) continue;
    if constexpr (ZeroSkippingReceiver<Sink>)
      if (skips && i == 2) {
        sink.skip(3, 6, 3, 3);
        sink.skip(6, 3, 3, 3);
        continue;
      }
    sink.add(3 * (i - 1), 3 * i, c);
    sink.add(3 * i, 3 * (i - 1), c.transpose());
  }
}

template <class Solver>
void expect_the_same_factor() {
  PatternSink pattern;
  write_chain(pattern, true);
  VecX const b = VecX::LinSpaced(12, -1.0, 2.0);
  std::array<VecX, 2> x;
  Solver solver;
  solver.analyse(12, pattern.blocks);
  for (bool const skips : {false, true, false}) {
    solver.begin();
    write_chain(solver, skips);
    ASSERT_EQ(solver.factor(), -1);
    x[skips] = VecX::Zero(12);
    solver.solve(b, x[skips]);
  }
  Plain plain{MatX::Zero(12, 12)};
  write_chain(plain, false);
  EXPECT_EQ(x[0], x[1]);
  EXPECT_LT((plain.a * x[1] - b).norm(), 1e-12 * b.norm());
}

TEST(MappedSink, SkippedBlocksAreZerosToTheSolver) {
  static_assert(ZeroSkippingReceiver<BlockLdlt> && ZeroSkippingReceiver<BlockLu>);
  expect_the_same_factor<BlockLdlt>();
  expect_the_same_factor<BlockLu>();
  expect_the_same_factor<BlockSolver>();
}

}  // namespace mapped_sink_test
