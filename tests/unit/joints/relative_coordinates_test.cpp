#include <polybody/joints/planar/joints.hpp>
#include <polybody/joints/relative_coordinates.hpp>
#include <polybody/joints/standard_joints.hpp>

#include <gtest/gtest.h>

#include <polybody/testing/joint_laws.hpp>

#include "support/refusal.hpp"

using namespace polybody;
using namespace polybody::laws;

namespace relative_coordinates_test {

struct RelativeCoordinatesCase {
  static constexpr bool planar = false;
  static constexpr int world_rows = 0;
  static RelativeCoordinates geometry() { return {.axis = {0.6, 0, -0.8}}; }
  static Mate mate(Numbers&, double) { return {.free_directions = MatX::Zero(6, 0)}; }
};

Frame<double> const a{.r = {0.2, -1, 3}, .A = exp_so3<double>(Vec3(0.3, 1, -2)), .v = {1, 2, 3}, .w = {-0.5, 0.7, 0.2}};

Frame<double> beside(Vec3 const& d, Mat3 const& turn) { return {.r = a.r + a.A * d, .A = a.A * turn}; }
Vec6 coordinates(Mat3 const& turn) {
  return constraint_function<double>(RelativeCoordinates{}, a, beside({0, 0, 0}, turn), 0.0).g;
}

// The pose consists of d, then a rotation of b by ψ about a₃ and a swing by the vector (s₁, s₂, 0).
TEST(RelativeCoordinates, AreTheSlideTheSwingAndTheTwist) {
  for (double const size : {1e-8, 1e-4, 1e-2, 0.4, 0.6, 2.0, 3.0})
    for (double const psi : {0.0, 1e-6, -1.0, 3.1}) {
      Vec3 const d(0.3, -2.0, 0.7), s = size * Vec3(0.6, -0.8, 0.0);
      Mat3 const turn = exp_so3<double>(s) * exp_so3<double>(Vec3(0, 0, psi));
      Vec6 x;
      x << d, s[0], s[1], psi;
      EXPECT_LT((constraint_function<double>(RelativeCoordinates{}, a, beside(d, turn), 0.0).g - x).norm(),
                1e-14 * (3.0 + 20.0 / (3.2 - size)));
    }
}

// For a rotation about one of the axes the coordinate is its angle. For small rotations the coordinates are those of
// the rotation vector.
TEST(RelativeCoordinates, AreAnglesAboutTheAxes) {
  for (int i = 0; i < 3; ++i)
    for (double const angle : {1e-8, -1e-4, 1e-2, 1.0, -3.0}) {
      Vec3 const phi = Vec3::Unit(i) * angle;
      EXPECT_LT((coordinates(exp_so3<double>(phi)).tail<3>() - phi).norm(), 1e-13) << i << ' ' << angle;
    }
  Vec3 const phi = Vec3(1, -2, 3) * 1e-5;
  EXPECT_LT((coordinates(exp_so3<double>(phi)).tail<3>() - phi).norm(), 10 * 1e-10);  // products of the small angles
}

// Beyond half a turn the twist restarts at −π; slides and swings are continuous.
TEST(RelativeCoordinates, TwistIsWithinHalfATurn) {
  Mat3 const swing = exp_so3<double>(Vec3(0.01, -0.02, 0));
  for (double const psi : {4.0, 7.0, 40.0, -40.0}) {
    Vec6 const x = coordinates(swing * exp_so3<double>(Vec3(0, 0, psi)));
    EXPECT_NEAR(x[5], std::remainder(psi, 2.0 * std::numbers::pi), 1e-13);
    EXPECT_LT((x.segment<2>(3) - Vec2(0.01, -0.02)).norm(), 1e-14);
  }
}

// The maps give ẋ equal to the rate of the coordinates, for any motion of the axes of a.
TEST(RelativeCoordinates, RateOfTheTwistAloneIsTheSpinAboutTheAxis) {
  Frame<double> b = beside({0, 0, 0}, exp_so3<double>(Vec3(0, 0, 2.0)));
  b.v = a.v;
  b.w = a.w + 3.0 * a.A.col(2);
  ConstraintTerms<6> const gap = constraint_function<double>(RelativeCoordinates{}, a, b, 0.0);
  Vec6 rate = gap.Ga * twist(a) + gap.Gb * twist(b);
  rate[5] -= 3.0;
  EXPECT_LT(rate.norm(), 1e-14);
}

/// Dependence of the constrained coordinates of a geometry on each of the six motions of b, in a's axes.
template <class G>
Vec6 felt() {
  ConstraintTerms<6> const gap =
      constraint_function<double>(ConstrainedCoordinates<G>{}, a, beside({0, 0, 0}, Mat3::Identity()), 0.0);
  Vec6 out;
  for (int i = 0; i < 3; ++i) {
    Vec6 along = Vec6::Zero(), about = Vec6::Zero();
    along.head<3>() = about.tail<3>() = a.A.col(i);
    out[i] = (gap.Gb * along).norm();
    out[i + 3] = (gap.Gb * about).norm();
  }
  return out;
}

TEST(ConstrainedCoordinates, LeaveFreeWhatTheGeometryLeavesFree) {
  auto const expect = [](Vec6 const& felt, std::initializer_list<double> held) {
    Vec6 expected;
    std::copy(held.begin(), held.end(), expected.data());
    EXPECT_LT((felt - expected).norm(), 1e-14);
  };
  expect(felt<Weld>(), {1, 1, 1, 1, 1, 1});
  expect(felt<RelativeCoordinates>(), {1, 1, 1, 1, 1, 1});
  expect(felt<Revolute>(), {1, 1, 1, 1, 1, 0});
  expect(felt<Prismatic>(), {1, 1, 0, 1, 1, 1});
  expect(felt<Spherical>(), {1, 1, 1, 0, 0, 0});
  expect(felt<planar::Revolute>(), {1, 1, 1, 1, 1, 0});
}

// The free directions that a geometry names agree with its constraint equations. A free motion in the six coordinates
// changes no constraint function, and each constrained motion changes one.
template <class G>
void expect_freedoms_of_the_rows() {
  ConstraintTerms<constraint_equations<G>()> const gap =
      constraint_function<double>(G{}, a, beside({0, 0, 0}, Mat3::Identity()), 0.0);
  for (int i = 0; i < 6; ++i) {
    Vec6 motion = Vec6::Zero();
    motion.segment<3>(i < 3 ? 0 : 3) = a.A.col(i % 3);
    double const moved = (gap.Gb * motion).norm();
    if (free_directions<G>()[std::size_t(i)]) {
      EXPECT_LT(moved, 1e-14) << G::name << i;
    } else {
      EXPECT_GT(moved, 0.9) << G::name << i;
    }
  }
}

TEST(ConstrainedCoordinates, FreedomsAreThoseOfTheRows) {
  expect_freedoms_of_the_rows<Weld>();
  expect_freedoms_of_the_rows<Revolute>();
  expect_freedoms_of_the_rows<Prismatic>();
  expect_freedoms_of_the_rows<Spherical>();
  expect_freedoms_of_the_rows<Cylindrical>();
  expect_freedoms_of_the_rows<PlanarJoint>();
  expect_freedoms_of_the_rows<PointOnLine>();
  expect_freedoms_of_the_rows<PointInPlane>();
  expect_freedoms_of_the_rows<ConstantOrientation>();
  expect_freedoms_of_the_rows<ParallelAxes>();
  expect_freedoms_of_the_rows<RelativeCoordinates>();
}

// For any displacement along the free directions their multipliers have no wrench: the gradient is that of the other
// coordinates (JointLaws).
template <class G>
void expect_gradient_of_the_others() {
  Numbers number;
  Frame<double> const b =
      moved<double>(beside({0.1, -0.2, 0.3}, exp_so3<double>(Vec3(0.5, 0.2, 2.5))), number.vec<6>(0.1));
  Vec6 lambda = number.vec<6>(2.0);
  Mat<double, 12, 12> const found = wrench_gradient(ConstrainedCoordinates<G>{}, a, b, 0.0, lambda);
  for (int i = 0; i < 6; ++i)
    if (free_directions<G>()[std::size_t(i)]) lambda[i] = 0.0;
  Mat<double, 12, 12> const expected = RelativeCoordinates{}.wrench_gradient(a, b, lambda);
  EXPECT_GT(expected.norm(), 1.0);
  EXPECT_LT((found - expected).norm(), 1e-13 * expected.norm()) << G::name;
}

TEST(ConstrainedCoordinates, WrenchGradientLeavesTheFreedomsFree) {
  expect_gradient_of_the_others<Revolute>();
  expect_gradient_of_the_others<Spherical>();
  expect_gradient_of_the_others<Prismatic>();
}

// A ball joint may rotate until its axis is opposite to its initial direction. There swing and twist are undefined.
TEST(ConstrainedCoordinates, OfABallJointHoldAtEveryTurn) {
  Frame<double> const b = beside({0.1, 0, 0}, Vec3(1, -1, -1).asDiagonal().toDenseMatrix());
  ConstraintTerms<6> const gap = constraint_function<double>(ConstrainedCoordinates<Spherical>{}, a, b, 0.0);
  EXPECT_TRUE(gap.Ga.allFinite() && gap.Gb.allFinite());
  EXPECT_NEAR(gap.g.norm(), 0.1, 1e-15);
}

TEST(RelativeCoordinates, RefusesAnAxisThatIsNotAUnitVector) {
  EXPECT_TRUE(
      has(refusal([] { (void)RelativeCoordinates{.axis = {0, 2, 0}}.triad(); }), "RelativeCoordinates: the axis"));
}

}  // namespace relative_coordinates_test

namespace polybody {
bool const relative_coordinates_obeys =
    obeys<relative_coordinates_test::RelativeCoordinatesCase, JointLaws>("RelativeCoordinates");
}  // namespace polybody
