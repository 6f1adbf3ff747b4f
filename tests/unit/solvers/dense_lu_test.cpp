#include <polybody/solvers/dense_lu.hpp>

#include <gtest/gtest.h>

using namespace polybody;

namespace dense_lu_test {

DenseLu holding(MatX const& a) {
  DenseLu lu;
  lu.analyse(a.rows(), {});
  lu.begin();
  lu.add(0, 0, a);
  return lu;
}

TEST(DenseLu, BlocksAddUpAndBeginForgets) {
  DenseLu lu = holding(MatX::Constant(4, 4, 9.0));
  lu.begin();
  Mat3 const a = Mat3::Random();
  lu.add(0, 0, a);
  lu.add(1, 1, a.transpose());
  MatX expected = MatX::Zero(4, 4);
  expected.topLeftCorner<3, 3>() += a;
  expected.bottomRightCorner<3, 3>() += a.transpose();
  EXPECT_EQ(lu.matrix(), expected);
}

TEST(DenseLu, NamesTheFirstColumnWithoutAPivot) {
  MatX a = MatX::Random(6, 6);
  a.col(3) = 2.0 * a.col(1) - a.col(0);
  EXPECT_EQ(holding(a).factor(), 3);
  a.col(2).setZero();
  EXPECT_EQ(holding(a).factor(), 2);
}

// Each pivot is compared with its own column, so units that differ by 1e20 do not cause a singularity.
TEST(DenseLu, JudgesAPivotByItsColumn) {
  Mat3 const a = Vec3(1e10, 1.0, 1e-10).asDiagonal();
  EXPECT_EQ(holding(a).factor(), -1);
  Mat3 tilted;
  tilted << 1.0, 1.0, 0.0, 1.0, 1.0 + 1e-15, 0.0, 0.0, 0.0, 1.0;
  EXPECT_EQ(holding(tilted).factor(), 1);
  tilted(1, 1) = 1.0 + 1e-10;
  EXPECT_EQ(holding(tilted).factor(), -1);
}

TEST(DenseLu, NotANumberIsNoPivot) {
  MatX a = MatX::Identity(3, 3);
  a(1, 1) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_GE(holding(a).factor(), 0);
}

TEST(DenseLu, PivotsWhereTheDiagonalIsZero) {
  Mat<double, 2, 2> a;
  a << 0.0, 2.0, 4.0, 0.0;
  DenseLu lu = holding(a);
  ASSERT_EQ(lu.factor(), -1);
  VecX x(2);
  lu.solve(Vec2(2.0, 4.0), x);
  EXPECT_EQ(x, Vec2(1.0, 1.0));
}

}  // namespace dense_lu_test
