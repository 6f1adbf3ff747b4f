#include <polybody/kinematics/frame.hpp>

#include <gtest/gtest.h>

#include <numbers>

#include "support/refusal.hpp"

using namespace polybody;

namespace frame_test {

double const nan_ = std::numeric_limits<double>::quiet_NaN();

TEST(Frame, StandsInTheOriginAtRestByDefault) {
  Frame<Dual<1>> const f;
  EXPECT_EQ(values_of(f.r), Vec3::Zero());
  EXPECT_EQ(values_of(f.A), Mat3::Identity());
  EXPECT_EQ(values_of(f.v), Vec3::Zero());
  EXPECT_EQ(values_of(f.w), Vec3::Zero());
}

TEST(Worlds, OnlyTheGroundStandsInBoth) {
  EXPECT_TRUE(same_world(World::plane, World::plane));
  EXPECT_TRUE(same_world(World::space, World::space));
  EXPECT_FALSE(same_world(World::plane, World::space));
  EXPECT_FALSE(same_world(World::space, World::plane));
  for (World const w : {World::plane, World::space, World::both})
    EXPECT_TRUE(same_world(w, World::both) && same_world(World::both, w));
}

TEST(Placement, DefaultsToTheOriginAlongX) {
  Placement const p;
  EXPECT_NO_THROW(p.check("rod"));
  EXPECT_EQ(p.origin, Vec3::Zero());
  EXPECT_EQ(p.axes, Mat3::Identity());
}

TEST(Placement, InThePlaneTurnsAboutZ) {
  Placement const p = Placement::planar(2.0, -1.0, 0.5);
  EXPECT_EQ(p.origin, Vec3(2.0, -1.0, 0.0));
  EXPECT_LT((p.axes.col(0) - Vec3(std::cos(0.5), std::sin(0.5), 0.0)).norm(), 1e-15);
  EXPECT_LT((p.axes.col(2) - Vec3(0, 0, 1)).norm(), 1e-15);
}

TEST(Placement, PlanarAngleIsReadBack) {
  for (double const angle : {0.0, 1e-9, 0.5, -3.0, 3.0, std::numbers::pi / 2})
    EXPECT_NEAR(Placement::planar(0, 0, angle).planar_angle("rod"), angle, 1e-15);
  EXPECT_NEAR(Placement::planar(0, 0, 4.0).planar_angle("rod"), 4.0 - 2 * std::numbers::pi, 1e-15);
}

TEST(Placement, InSpaceTurnsByItsRotationVector) {
  Placement const p = Placement::at({1, 2, 3}, {0, 0, std::numbers::pi / 2});
  EXPECT_EQ(p.origin, Vec3(1, 2, 3));
  EXPECT_LT((p.axes.col(0) - Vec3(0, 1, 0)).norm(), 1e-15);
  EXPECT_EQ(Placement::at({1, 2, 3}).axes, Mat3::Identity());
}

TEST(Placement, RefusesAxesThatAreNotARightHandedFrame) {
  Mat3 stretched = Mat3::Identity(), skewed = Mat3::Identity(), mirrored = Mat3::Identity();
  stretched(0, 0) = 1.0 + 1e-6;
  skewed(0, 1) = 1e-6;
  mirrored(2, 2) = -1.0;
  for (Mat3 const& axes : {stretched, skewed, mirrored, Mat3(Mat3::Zero())}) {
    std::string const said = refusal([&] { Placement{Vec3::Zero(), axes}.check("rod"); });
    EXPECT_TRUE(has(said, "rod") && has(said, "orthonormal and right-handed"));
  }
}

TEST(Placement, RefusesNan) {
  EXPECT_TRUE(has(refusal([] { Placement::at({0, nan_, 0}).check("rod"); }), "rod: the placement's origin"));
  EXPECT_TRUE(has(refusal([] { Placement::at({0, 0, 0}, {nan_, 0, 0}).check("rod"); }), "rod: the placement's axes"));
  EXPECT_THROW(Placement::planar(0, nan_).planar_angle("rod"), InvalidInput);
  EXPECT_THROW(Placement::planar(0, 0, nan_).planar_angle("rod"), InvalidInput);
}

TEST(Placement, RefusesToLeaveThePlane) {
  double const tilt = 1e-3;
  for (Placement const& p :
       {Placement::at({0, 0, 0.1}), Placement::at({0, 0, 0}, {tilt, 0, 0}), Placement::at({0, 0, 0}, {0, tilt, 0.4}),
        Placement::at({0, 0, 0}, {std::numbers::pi, 0, 0})}) {
    EXPECT_NO_THROW(p.check("rod"));  // valid in space
    EXPECT_TRUE(has(refusal([&] { (void)p.planar_angle("rod"); }), "rod: a planar body must lie in the plane"));
  }
}

}  // namespace frame_test
