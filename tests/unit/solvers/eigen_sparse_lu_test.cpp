#include <polybody/solvers/eigen_sparse_lu.hpp>

#include <gtest/gtest.h>

using namespace polybody;

namespace eigen_sparse_lu_test {

/// Diagonal blocks in sequence with the sizes of `parts`; the first two overlap in one column.
std::vector<Block> const pattern{{0, 0, 3, 3}, {2, 2, 3, 3}, {5, 0, 1, 3}, {0, 5, 3, 1}, {5, 5, 1, 1}};

struct Parts {
  Mat3 a = Mat3::Random() + 3.0 * Mat3::Identity(), b = Mat3::Random() + 3.0 * Mat3::Identity();
  Vec3 c = Vec3::Random();
  Vec<double, 1> d = Vec<double, 1>(2.0);

  void write(EigenSparseLu& lu) const {
    lu.begin();
    lu.add(0, 0, a);
    lu.add(2, 2, b);
    lu.add(5, 0, c.transpose());
    lu.add(0, 5, c);
    lu.add(5, 5, d);
  }
  MatX dense() const {
    MatX m = MatX::Zero(6, 6);
    m.block<3, 3>(0, 0) += a;
    m.block<3, 3>(2, 2) += b;
    m.block<1, 3>(5, 0) += c.transpose();
    m.block<3, 1>(0, 5) += c;
    m(5, 5) += d[0];
    return m;
  }
};

TEST(EigenSparseLu, HoldsTheSumOfItsBlocks) {
  EigenSparseLu lu;
  lu.analyse(6, pattern);
  for (int k = 0; k < 3; ++k) {
    Parts const parts;
    parts.write(lu);
    EXPECT_EQ(MatX(lu.matrix()), parts.dense());
  }
}

TEST(EigenSparseLu, StoresEachPlaceOnce) {
  EigenSparseLu lu;
  lu.analyse(6, pattern);
  EXPECT_EQ(lu.matrix().nonZeros(), 9 + 9 - 1 + 3 + 3 + 1);
}

TEST(EigenSparseLu, NamesTheColumnThatIsZero) {
  for (Index const empty : {1, 3}) {
    Parts parts;
    (empty < 2 ? parts.a.col(empty) : parts.b.col(empty - 2)).setZero();
    if (empty < 2) parts.c[empty] = 0.0;
    EigenSparseLu lu;
    lu.analyse(6, pattern);
    parts.write(lu);
    EXPECT_EQ(lu.factor(), empty);
  }
}

TEST(EigenSparseLu, SeesAPivotThatIsOnlyRounding) {
  Parts parts;
  parts.b.col(2) = 0.1 * parts.b.col(1);
  EigenSparseLu lu;
  lu.analyse(6, pattern);
  parts.write(lu);
  EXPECT_GE(lu.factor(), 0);
}

TEST(EigenSparseLu, CanBeMoved) {
  EigenSparseLu lu;
  lu.analyse(6, pattern);
  EigenSparseLu moved = std::move(lu);
  Parts const parts;
  parts.write(moved);
  ASSERT_EQ(moved.factor(), -1);
  VecX const b = VecX::Random(6);
  VecX x(6);
  moved.solve(b, x);
  EXPECT_LT((parts.dense() * x - b).norm(), 1e-13);
}

}  // namespace eigen_sparse_lu_test
