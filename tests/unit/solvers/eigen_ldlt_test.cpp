// Eigen's sparse LDLᵀ on symmetric tangents with constraint equations.

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <polybody/solvers/eigen_ldlt.hpp>

using namespace polybody;

namespace eigen_ldlt_test {

/// A chain of bodies on pins, [M, Gᵀ; G, 0], and a skew-symmetric block of body 0.
struct Chain {
  Index bodies;
  double skew = 0.0;
  Index size() const { return 11 * bodies; }

  template <class Sink>
  void write(Sink& sink) const {
    std::srand(5);
    for (Index i = 0; i < bodies; ++i) {
      Mat<double, 6, 6> const a = Mat<double, 6, 6>::Random(), m = a * a.transpose() + Mat<double, 6, 6>::Identity();
      sink.add(6 * i, 6 * i, m);
    }
    Mat3 turn;
    turn << 0, -skew, skew, skew, 0, -skew, -skew, skew, 0;
    sink.add(3, 3, turn);
    for (Index i = 0; i < bodies; ++i)
      for (Index body : {i - 1, i}) {
        if (body < 0) continue;
        Mat<double, 6, 5> const g = Mat<double, 6, 5>::Random();
        sink.add(6 * body, 6 * bodies + 5 * i, g);
        sink.add(6 * bodies + 5 * i, 6 * body, g.transpose());
      }
  }
};

EigenLdlt analysed(Chain const& chain) {
  PatternSink pattern;
  chain.write(pattern);
  EigenLdlt solver;
  solver.analyse(chain.size(), pattern.blocks);
  return solver;
}

double error(Chain const& chain) {
  EigenLdlt solver = analysed(chain);
  solver.begin();
  chain.write(solver);
  MatX a = MatX(solver.matrix());
  EXPECT_EQ(solver.factor(), -1);
  VecX const expected = VecX::Random(chain.size());
  VecX x = a * expected;
  solver.solve(x, x);
  return (x - expected).norm() / expected.norm();
}

TEST(EigenLdlt, SolvesSymmetricTangentsWithRows) {
  for (Index const bodies : {1, 8, 30}) EXPECT_LT(error({bodies}), 1e-9) << bodies;
}

TEST(EigenLdlt, RefinesSlightAsymmetryAway) { EXPECT_LT(error({.bodies = 8, .skew = 0.3}), 1e-9); }

// Iterative refinement by the factors of one half alone diverges: I − A B⁻¹ has an eigenvalue of −3.6.
TEST(EigenLdlt, IteratesAsymmetryOfALightPartAway) {
  Mat<double, 2, 2> const light{{1.0, -0.8}, {0.8, 1.0}}, heavy{{100.0, 1.0}, {1.0, 100.0}};
  std::vector<Block> const blocks{{0, 0, 2, 2}, {2, 2, 2, 2}};
  EigenLdlt solver;
  solver.analyse(4, blocks);
  solver.begin();
  solver.add(0, 0, light);
  solver.add(2, 2, heavy);
  EXPECT_EQ(solver.factor(), -1);
  VecX const expected = (VecX(4) << 1.0, 2.0, 3.0, 4.0).finished();
  VecX x = solver.matrix() * expected;
  solver.solve(x, x);
  EXPECT_LT((x - expected).norm(), 1e-13);
}

TEST(EigenLdlt, RefusesWhatIsFarFromSymmetric) {
  Chain const chain{.bodies = 3, .skew = 30.0};
  EigenLdlt solver = analysed(chain);
  solver.begin();
  chain.write(solver);
  EXPECT_THROW((void)solver.factor(), InvalidInput);
}

TEST(EigenLdlt, NamesAnUnknownOfASingularMatrix) {
  Chain const chain{.bodies = 3};
  EigenLdlt solver = analysed(chain);
  solver.begin();  // all entries are zero
  Index const bad = solver.factor();
  EXPECT_GE(bad, 0);
  EXPECT_LT(bad, chain.size());
  solver.begin();
  chain.write(solver);
  EXPECT_EQ(solver.factor(), -1);
}

TEST(EigenLdlt, NothingIsSolvedAtOnce) {
  EigenLdlt solver;
  solver.analyse(0, {});
  solver.begin();
  EXPECT_EQ(solver.factor(), -1);
  VecX x;
  solver.solve(VecX(), x);
  EXPECT_EQ(x.size(), 0);
}

}  // namespace eigen_ldlt_test
