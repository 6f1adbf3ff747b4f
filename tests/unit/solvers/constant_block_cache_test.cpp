#include <polybody/solvers/constant_block_cache.hpp>

#include <gtest/gtest.h>

#include <polybody/solvers/block_factor.hpp>
#include <polybody/solvers/dense_lu.hpp>

#include "support/blocks.hpp"

using namespace polybody;

namespace kept_parts_test {

MatX random_symmetric(Index n) {
  MatX const a = MatX::Random(n, n);
  return a * a.transpose() + double(n) * MatX::Identity(n, n);
}

/// Unknowns 0–1 and 5–7 are one part, 2–4 another, 8–9 a third.
struct Parts {
  Blocks blocks;
  MatX a = random_symmetric(2), b = random_symmetric(3), coupling = MatX::Random(2, 3), c = random_symmetric(3),
       d = random_symmetric(2);

  Parts() { build(); }
  void build() {
    blocks = {};
    blocks.add(0, 0, a);
    blocks.add(2, 2, c);
    blocks.add(5, 5, b);
    blocks.join(0, 5, coupling);
    blocks.add(8, 8, d);
  }
};
Sequence<bool> constant(std::vector<Index> const& unknowns) {
  Sequence<bool> out(10, false);
  for (Index const i : unknowns) out[std::size_t(i)] = true;
  return out;
}
/// Cache with these constant unknowns, and their number in constant parts.
template <class Solver = BlockSolver>
std::pair<ConstantBlockCache<Solver>, Index> kept_of(Parts const& parts, std::vector<Index> const& unknowns) {
  PatternSink pattern;
  parts.blocks.write(pattern);
  ConstantBlockCache<Solver> kept;
  Index const count = kept.keep(constant(unknowns), pattern.blocks);
  return {std::move(kept), count};
}
template <class Solver>
VecX solution(Solver& solver, Blocks const& blocks, VecX const& rhs) {
  EXPECT_EQ(write_and_factor(solver, [&](BlockSink& sink) { blocks.write(sink); }), -1);
  VecX x = VecX::Zero(rhs.size());
  solver.solve(rhs, x);
  return x;
}

TEST(ConstantBlockCache, SolveAsTheWholeDoes) {
  Parts parts;
  auto [kept, count] = kept_of(parts, {0, 1, 5, 6, 7, 8});  // 9, in the last part, is not constant
  EXPECT_EQ(count, 5);
  auto solver = parts.blocks.analysed(std::move(kept));
  VecX const rhs = VecX::LinSpaced(10, -1.0, 2.0);
  for (int time = 0; time < 3; ++time) {
    parts.c = random_symmetric(3);
    parts.d = random_symmetric(2);
    parts.build();
    VecX const x = solution(solver, parts.blocks, rhs), dense = parts.blocks.dense().lu().solve(rhs);
    EXPECT_LT((x - dense).norm(), 1e-13) << time;
  }
}

TEST(ConstantBlockCache, AreFactoredOnce) {
  Parts parts;
  auto solver = parts.blocks.analysed(kept_of<DenseLu>(parts, {0, 1, 5, 6, 7}).first);
  VecX const rhs = VecX::Ones(10), before = solution(solver, parts.blocks, rhs);
  parts.a *= 2.0;  // although it was declared constant
  parts.c *= 2.0;
  parts.build();
  VecX const after = solution(solver, parts.blocks, rhs);
  for (Index const i : {0, 1, 5, 6, 7}) EXPECT_EQ(after[i], before[i]);
  for (Index const i : {2, 3, 4}) EXPECT_NEAR(after[i], 0.5 * before[i], 1e-15);
}

TEST(ConstantBlockCache, NeedsPartsOfBothKinds) {
  for (auto const& unknowns : {std::vector<Index>{}, {0, 1}, {9}, {0, 1, 2, 3, 4, 5, 6, 7, 8, 9}})
    EXPECT_EQ(kept_of(Parts(), unknowns).second, 0);
}

TEST(ConstantBlockCache, NameTheUnknownWithoutAPivot) {
  Parts parts;
  for (auto const& [lost, first] : {std::pair<MatX Parts::*, Index>{&Parts::a, 0}, {&Parts::d, 8}}) {
    Parts singular;
    singular.*lost = MatX::Zero(2, 2);
    singular.coupling.setZero();
    singular.build();
    auto solver = singular.blocks.analysed(kept_of<DenseLu>(singular, {0, 1, 5, 6, 7}).first);
    Index const bad = write_and_factor(solver, [&](BlockSink& sink) { singular.blocks.write(sink); });
    EXPECT_GE(bad, first);
    EXPECT_LT(bad, first + 2);
  }
}

}  // namespace kept_parts_test
