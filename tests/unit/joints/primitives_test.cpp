#include <polybody/joints/standard_joints.hpp>

#include <gtest/gtest.h>

#include <polybody/testing/joint_laws.hpp>

#include "support/refusal.hpp"

using namespace polybody;
using namespace polybody::laws;

namespace primitives_test {

struct OrientationCase {
  static constexpr bool planar = false;
  static constexpr int world_rows = 0;
  static ConstantOrientation geometry() { return {}; }
  static Mate mate(Numbers& number, double) {
    Mate mate{.d = number.vec<3>(), .free_directions = MatX::Zero(6, 3)};
    mate.free_directions.topRows<3>().setIdentity();
    return mate;
  }
};

struct ParallelAxesCase {
  static constexpr bool planar = false;
  static constexpr int world_rows = 0;
  static ParallelAxes geometry() { return {}; }
  static Mate mate(Numbers& number, double t) {
    Mate mate = OrientationCase::mate(number, t);
    mate.R = exp_so3<double>(Vec3(0, 0, number(3.0)));
    mate.free_directions.conservativeResizeLike(MatX::Zero(6, 4));
    mate.free_directions(5, 3) = 1.0;
    return mate;
  }
};

// b rotates about a₁ by φ, then about its own third axis by ψ.
struct PerpendicularAxesCase {
  static constexpr bool planar = false;
  static constexpr int world_rows = 0;
  static PerpendicularAxes geometry() { return {}; }
  static Mate mate(Numbers& number, double t) {
    Mate mate = OrientationCase::mate(number, t);
    mate.R = exp_so3<double>(Vec3(number(3.0), 0, 0)) * exp_so3<double>(Vec3(0, 0, number(3.0)));
    mate.free_directions.conservativeResizeLike(MatX::Zero(6, 5));
    mate.free_directions.bottomRightCorner<3, 2>() << Vec3::UnitX(), mate.R.col(2);
    return mate;
  }
};

/// The frames of another geometry between the same two points, as `Model::connect` defines them. If the markers are
/// aligned with `from` in the reference configuration, both are aligned with the triad of this geometry.
template <JointGeometry G>
MatX maps(G const& geometry, Mat3 const& from, Frame<double> a, Frame<double> b) {
  Mat3 const turn = from.transpose() * geometry.triad();
  a.A *= turn;
  b.A *= turn;
  ConstraintTerms<constraint_equations<G>()> const gap = constraint_function<double>(geometry, a, b, 0.0);
  EXPECT_LT(gap.g.norm(), 1e-14) << G::name;
  MatX g(constraint_equations<G>(), 12);
  g << gap.Ga, gap.Gb;
  return g;
}

/// An orthonormal basis of the rows (Gram–Schmidt, twice); a dependent row is a failure.
MatX basis(MatX g) {
  for (Index i = 0; i < g.rows(); ++i) {
    double const before = g.row(i).norm();
    for (int again = 0; again < 2; ++again)
      for (Index j = 0; j < i; ++j) g.row(i) -= g.row(i).dot(g.row(j)) * g.row(j).eval();
    EXPECT_GT(g.row(i).norm(), 1e-3 * before);
    g.row(i).normalize();
  }
  return g;
}

/// A pose of b relative to a that satisfies the joint, in a's axes.
struct Pose {
  Vec3 d = Vec3::Zero();
  Mat3 R = Mat3::Identity();
};

/// If the joint is satisfied, it and its primitives have equally many constraint equations. These span the same space
/// of wrenches: the projectors Bᵀ B are equal.
template <JointGeometry G, JointGeometry... Primitives>
void expect_equal(G const& joint, Pose (*pose)(Numbers&), Primitives const&... primitives) {
  static_assert((constraint_equations<Primitives>() + ...) == constraint_equations<G>());
  Numbers number;
  for (int k = 0; k < 5; ++k) {
    Pose const at = pose(number);
    Frame<double> const a = number.frame();
    Frame<double> const b{.r = a.r + a.A * at.d, .A = a.A * at.R};
    MatX stacked(constraint_equations<G>(), 12);
    Index row = 0;
    auto const stack = [&](MatX const& g) {
      stacked.middleRows(row, g.rows()) = g;
      row += g.rows();
    };
    (stack(maps(primitives, joint.triad(), a, b)), ...);
    MatX const one = basis(maps(joint, joint.triad(), a, b)), other = basis(stacked);
    EXPECT_LT((one.transpose() * one - other.transpose() * other).norm(), 1e-12) << G::name;
  }
}

Vec3 const axis = Vec3(2, -1, 2) / 3.0, across = Vec3(1, 2, 0) / std::sqrt(5.0);

Mat3 turned_about(int i, Numbers& number) { return exp_so3<double>(Vec3::Unit(i) * number(3.0)); }

TEST(Primitives, MakeUpARevolute) {
  expect_equal(
      Revolute{.axis = axis}, [](Numbers& n) { return Pose{.R = turned_about(2, n)}; }, CoincidentPoints{},
      ParallelAxes{.axis = axis});
}

TEST(Primitives, MakeUpAUniversal) {
  expect_equal(
      Universal{.first = across, .second = axis},
      [](Numbers& n) { return Pose{.R = turned_about(0, n) * turned_about(2, n)}; }, CoincidentPoints{},
      PerpendicularAxes{.first = across, .second = axis});
}

TEST(Primitives, MakeUpACylindrical) {
  expect_equal(
      Cylindrical{.axis = axis}, [](Numbers& n) { return Pose{.d = Vec3(0, 0, n()), .R = turned_about(2, n)}; },
      PointOnLine{.axis = axis}, ParallelAxes{.axis = axis});
}

TEST(Primitives, MakeUpAPlaneOnPlane) {
  expect_equal(
      PlanarJoint{.normal = axis}, [](Numbers& n) { return Pose{.d = Vec3(n(), n(), 0), .R = turned_about(2, n)}; },
      PointInPlane{.normal = axis}, ParallelAxes{.axis = axis});
}

TEST(Primitives, MakeUpAPrismatic) {
  expect_equal(
      Prismatic{.axis = axis}, [](Numbers& n) { return Pose{.d = Vec3(0, 0, n())}; }, PointOnLine{.axis = axis},
      ConstantOrientation{});
}

TEST(Primitives, MakeUpAWeld) {
  expect_equal(Weld{}, [](Numbers&) { return Pose{}; }, CoincidentPoints{}, ConstantOrientation{});
}

// Decomposition into single constraint equations.
TEST(Primitives, MakeUpALineOfTwoPlanesAndAnOrientationOfThreeRightAngles) {
  expect_equal(
      PointOnLine{.axis = axis},
      [](Numbers& n) { return Pose{.d = Vec3(0, 0, n()), .R = exp_so3<double>(n.vec<3>(3.0))}; },
      PointInPlane{.normal = across}, PointInPlane{.normal = axis.cross(across)});
  expect_equal(
      ConstantOrientation{}, [](Numbers& n) { return Pose{.d = n.vec<3>()}; },
      PerpendicularAxes{.first = {1, 0, 0}, .second = {0, 1, 0}},
      PerpendicularAxes{.first = {0, 1, 0}, .second = {0, 0, 1}},
      PerpendicularAxes{.first = {0, 0, 1}, .second = {1, 0, 0}});
  expect_equal(
      ConstantOrientation{}, [](Numbers& n) { return Pose{.d = n.vec<3>()}; }, ParallelAxes{.axis = axis},
      PerpendicularAxes{.first = across, .second = axis.cross(across)});
}

TEST(Primitives, RefuseAxesThatCannotBeMeant) {
  EXPECT_TRUE(has(refusal([] { (void)PerpendicularAxes{.first = {0, 1, 0}, .second = {0, 1, 0}}.triad(); }),
                  "PerpendicularAxes: the two axes must be perpendicular"));
  EXPECT_TRUE(
      has(refusal([] { (void)ParallelAxes{.axis = {0, 2, 0}}.triad(); }), "ParallelAxes: the axis must be a unit"));
}

}  // namespace primitives_test

namespace polybody {
bool const primitives_obey[] = {obeys<primitives_test::OrientationCase, JointLaws>("ConstantOrientation"),
                                obeys<primitives_test::ParallelAxesCase, JointLaws>("ParallelAxes"),
                                obeys<primitives_test::PerpendicularAxesCase, JointLaws>("PerpendicularAxes")};
}  // namespace polybody
