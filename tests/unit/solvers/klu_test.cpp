// SuiteSparse's KLU; this file is built if KLU is installed.

#include <polybody/solvers/block_factor.hpp>
#include <polybody/solvers/klu.hpp>

#include <polybody/testing/linear_solver_laws.hpp>

#include <array>

using namespace polybody;
using namespace polybody::laws;

namespace polybody::test {
bool const klu_obeys = obeys<Klu, LinearSolvers>("Klu");
}

namespace klu_test {

template <class Solver>
Solver analysed(Solver solver, laws::Blocks const& blocks) {
  PatternSink pattern;
  blocks.write(pattern, 1);
  solver.analyse(blocks.size(), pattern.blocks);
  return solver;
}

TEST(Klu, SolvesInAnOrderThatIsGiven) {
  laws::Blocks const blocks{8};
  auto block = analysed(BlockLdlt(), blocks);
  auto klu = analysed(Klu(block.order()), blocks);
  for (unsigned const seed : {1u, 2u}) {
    klu.begin();
    blocks.write(klu, seed);
    ASSERT_EQ(klu.factor(), -1);
    MatX const a = laws::plain(blocks, seed);
    VecX const expected = VecX::Random(blocks.size());
    VecX x = a * expected;
    klu.solve(x, x);
    EXPECT_LT((x - expected).norm(), 1e-9 * expected.norm());
  }
}

TEST(Klu, RefusesAnOrderThatIsNone) {
  EXPECT_THROW(analysed(Klu(std::vector<int>(88, 3)), laws::Blocks{8}), InvalidInput);
}

// Reused pivots that have become tiny are chosen again.
TEST(Klu, ChoosesPivotsAnewWhenTheyNoLongerServe) {
  Mat<double, 2, 2> first, second;
  first << 1.0, 0.5, 0.5, 1.0;
  second << 1e-14, 1.0, 1.0, 0.0;
  Klu klu;
  klu.analyse(2, std::array{Block{0, 0, 2, 2}});
  for (auto const& m : {first, second}) {
    klu.begin();
    klu.add(0, 0, m);
    ASSERT_EQ(klu.factor(), -1);
    VecX x = m * VecX::Ones(2);
    klu.solve(x, x);
    EXPECT_LT((x - VecX::Ones(2)).norm(), 1e-13);
  }
}

}  // namespace klu_test
