#include <polybody/kinematics/marker_kinematics.hpp>

#include <gtest/gtest.h>

#include <algorithm>

using namespace polybody;

namespace published_test {

Mat3 const axes = exp_so3<double>(Vec3(0.4, -1.1, 0.7));
Vec3 const arm(0.3, -0.2, 0.9);

MarkerKinematics<double> rigid_marker() {
  MarkerKinematics<double> p;
  p.body_axes = axes;
  p.arm = arm;
  p.shape = JacobianShape::rigid;
  p.columns = 6;
  return p;
}

Mat<double, 6, 5> const numbers =
    Mat<double, 6, 5>::NullaryExpr([](Index i, Index j) { return std::sin(3.0 * double(i) + 1.7 * double(j)); });

MarkerKinematics<double> dense_marker(double* memory) {
  MarkerKinematics<double> p;
  std::copy_n(numbers.data(), numbers.size(), memory);
  p.jacobian = memory;
  p.shape = JacobianShape::dense;
  p.columns = 5;
  return p;
}

Mat<double, 6, 3> const wrenches = (Mat<double, 6, 3>() << 1, 0, -2, 3, 0.5, 0, -1, 2, 4,  //
                                    0, 1, 0.3, -0.7, 2, 1, 5, 0, -1)
                                       .finished();

TEST(MarkerKinematics, GroundHasNoColumns) {
  MarkerKinematics<double> const ground;
  EXPECT_EQ(ground.shape, JacobianShape::ground);
  EXPECT_EQ(ground.full().cols(), 0);
  MatX out(0, 3);
  ground.pull(wrenches, out);  // no columns to write
  EXPECT_EQ(out.size(), 0);
}

// twist = [ṙ + ω × ρ; ω] for the velocities (ṙ, Ω), ω = A Ω.
TEST(MarkerKinematics, RigidJacobianIsTheTwistOfARigidBody) {
  Vec3 const rate(1.0, -2.0, 0.5), omega(0.3, 0.8, -1.2);
  Vec6 v, twist;
  v << rate, omega;
  twist << rate + (axes * omega).cross(arm), axes * omega;
  EXPECT_LT((rigid_marker().full() * v - twist).norm(), 1e-15);
}

TEST(MarkerKinematics, DenseJacobianIsTheStoredOne) {
  double memory[30];
  EXPECT_EQ(dense_marker(memory).full(), numbers);
}

TEST(MarkerKinematics, PullIsTheTransposedJacobian) {
  double memory[30];
  MarkerKinematics<double> const rigid = rigid_marker(), dense = dense_marker(memory);
  for (MarkerKinematics<double> const* p : {&rigid, &dense}) {
    MatX out(p->columns, 3);
    p->pull(wrenches, out);
    EXPECT_LT((out - p->full().transpose() * wrenches).norm(), 1e-14);
  }
}

TEST(MarkerKinematics, PullWritesIntoABlockAndNowhereElse) {
  double memory[30];
  MarkerKinematics<double> const rigid = rigid_marker(), dense = dense_marker(memory);
  for (MarkerKinematics<double> const* p : {&rigid, &dense}) {
    MatX all = MatX::Constant(9, 4, 7.0);
    p->pull(wrenches, all.block(2, 1, p->columns, 3));
    EXPECT_LT((all.block(2, 1, p->columns, 3) - p->full().transpose() * wrenches).norm(), 1e-14);
    all.block(2, 1, p->columns, 3).setConstant(7.0);
    EXPECT_EQ(all, MatX::Constant(9, 4, 7.0));
  }
}

TEST(MarkerKinematics, WorksInDualNumbers) {
  using D = Dual<1>;
  MarkerKinematics<D> p;
  p.body_axes = axes.cast<D>();
  p.arm = arm.cast<D>();
  p.arm[1].d[0] = 1.0;  // the arm moves along y
  p.shape = JacobianShape::rigid;
  p.columns = 6;
  Mat<D, 6, 3> const w = wrenches.cast<D>();
  Mat<D, 6, 3> out;
  p.pull(w, out);
  EXPECT_LT((values_of(out) - rigid_marker().full().transpose() * wrenches).norm(), 1e-14);
  for (int k = 0; k < 3; ++k) {
    Vec3 const f = wrenches.col(k).head<3>();
    Vec3 const slope = out.col(k).tail<3>().unaryExpr([](D const& x) { return x.d[0]; });
    EXPECT_LT((slope - axes.transpose() * Vec3::UnitY().cross(f)).norm(), 1e-15);
  }
}

}  // namespace published_test
