#include <polybody/joints/constraint_terms.hpp>

#include <gtest/gtest.h>

#include <polybody/testing/differences.hpp>

using namespace polybody;
using namespace polybody::laws;

namespace gap_test {

using D = Dual<1>;

Mat3 slope(Mat<D, 3, 3> const& m) {
  return m.unaryExpr([](D const& x) { return x.d[0]; });
}
Vec3 slope(Vec<D, 3> const& v) {
  return v.unaryExpr([](D const& x) { return x.d[0]; });
}

TEST(ConstraintTerms, IsClosedAndStillByDefault) {
  ConstraintTerms<4, D> const gap;
  EXPECT_EQ(values_of(gap.g).norm() + values_of(gap.rate).norm(), 0.0);
  EXPECT_EQ(values_of(gap.Ga).norm() + values_of(gap.Gb).norm(), 0.0);
}

TEST(Twist, StandsVelocityOverAngularVelocity) {
  Vec6 expected;
  expected << 1, 2, 3, 4, 5, 6;
  EXPECT_EQ(twist(Frame<double>{.v = {1, 2, 3}, .w = {4, 5, 6}}), expected);
}

TEST(RelativeMotion, IsSeenFromTheFirstFrame) {
  Frame<double> const a{.r = {1, 0, 0}, .A = exp_so3<double>(Vec3(0, 0, std::numbers::pi / 2))};
  Frame<double> const b{.r = {1, 2, 0}, .v = {0, 3, 0}, .w = {5, 0, 0}};
  RelativeMotion<double> const seen = relative(a, b);
  EXPECT_LT((seen.d - Vec3(2, 0, 0)).norm(), 1e-15);  // world y is a's x
  EXPECT_LT((seen.R - a.A.transpose()).norm(), 1e-15);
  EXPECT_LT((seen.v - Vec3(3, 0, 0)).norm(), 1e-15);
  EXPECT_LT((seen.w - Vec3(0, -5, 0)).norm(), 1e-15);
}

// ḋ = v and Ṙ = w̃ R, all in a's axes.
TEST(RelativeMotion, TwistIsTheRateOfThePose) {
  Numbers number;
  for (int k = 0; k < 3; ++k) {
    Frame<double> const a = number.frame(), b = number.frame();
    RelativeMotion<double> const seen = relative(a, b);
    D const time = D::variable(0.0, 0);
    RelativeMotion<D> const moving = relative(later<D>(a, time), later<D>(b, time));
    EXPECT_LT((slope(moving.d) - seen.v).norm(), 1e-13);
    EXPECT_LT((slope(moving.R) - skew<double>(seen.w) * seen.R).norm(), 1e-13);
  }
}

TEST(RelativeMotion, DoesNotSeeARigidMotionOfBothFrames) {
  Numbers number;
  Frame<double> const a = number.frame(), b = number.frame();
  Mat3 const turn = exp_so3<double>(number.vec<3>(2.0));
  Vec3 const shift = number.vec<3>(5.0), v0 = number.vec<3>(), omega = number.vec<3>();
  auto const carry = [&](Frame<double> f) {
    f = carried(f, turn, shift);
    f.v += v0 + omega.cross(f.r);
    f.w += omega;
    return f;
  };
  RelativeMotion<double> const before = relative(a, b), after = relative(carry(a), carry(b));
  EXPECT_LT((after.d - before.d).norm() + (after.R - before.R).norm(), 1e-13);
  EXPECT_LT((after.v - before.v).norm() + (after.w - before.w).norm(), 1e-13);
}

// --- concept of a joint geometry, and each of its requirements ------------------------------------------------

struct Whole {
  static constexpr char const* name = "Whole";
  static constexpr int rows = 1;
  static constexpr MarkerKind needs = MarkerKind::point;
  static constexpr World world = World::space;
  Mat3 triad() const { return Mat3::Identity(); }
  template <StateScalar T>
  ConstraintTerms<1, T> constraint_function(Frame<T> const&, Frame<T> const&, double) const {
    return {};
  }
  template <StateScalar T>
  Vec<T, 1> gamma(Frame<T> const&, Frame<T> const&, double) const {
    return Vec<T, 1>::Zero();
  }
};
struct NoRows : Whole {
  static constexpr int rows = 0;
};
struct SevenRows : Whole {
  static constexpr int rows = 7;
  template <StateScalar T>
  ConstraintTerms<7, T> constraint_function(Frame<T> const&, Frame<T> const&, double) const {
    return {};
  }
  template <StateScalar T>
  Vec<T, 7> gamma(Frame<T> const&, Frame<T> const&, double) const {
    return Vec<T, 7>::Zero();
  }
};
struct GapOfOtherRows : Whole {
  static constexpr int rows = 2;
};
struct NoTriad : Whole {
  void triad() const {}
};
struct NoGamma {
  static constexpr char const* name = "NoGamma";
  static constexpr int rows = 1;
  static constexpr MarkerKind needs = MarkerKind::point;
  static constexpr World world = World::space;
  Mat3 triad() const { return Mat3::Identity(); }
  template <StateScalar T>
  ConstraintTerms<1, T> constraint_function(Frame<T> const&, Frame<T> const&, double) const {
    return {};
  }
};
static_assert(JointGeometry<Whole>);
static_assert(!JointGeometry<NoRows> && !JointGeometry<SevenRows>);
static_assert(!JointGeometry<GapOfOtherRows> && !JointGeometry<NoTriad> && !JointGeometry<NoGamma>);
static_assert(!JointGeometry<int>);

}  // namespace gap_test
