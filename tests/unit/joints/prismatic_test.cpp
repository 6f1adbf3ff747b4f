#include <polybody/joints/planar/joints.hpp>
#include <polybody/joints/standard_joints.hpp>

#include <gtest/gtest.h>

#include <polybody/testing/joint_laws.hpp>

#include "support/refusal.hpp"

using namespace polybody;
using namespace polybody::laws;

namespace prismatic_test {

// The sliding axis is the third axis in space, the first in the plane.
template <int slide>
Mate slid(Numbers& number) {
  Mate mate{.d = Vec3::Unit(slide) * number(2.0), .free_directions = MatX::Zero(6, 1)};
  mate.free_directions(slide, 0) = 1.0;
  return mate;
}

struct PrismaticCase {
  static constexpr bool planar = false;
  static constexpr int world_rows = 0;
  static Prismatic geometry() { return {}; }
  static Mate mate(Numbers& number, double) { return slid<2>(number); }
};

struct PlanarPrismaticCase {
  static constexpr bool planar = true;
  static constexpr int world_rows = 0;
  static planar::Prismatic geometry() { return {}; }
  static Mate mate(Numbers& number, double) { return slid<0>(number); }
};

TEST(Prismatic, SlidesAlongItsAxis) {
  EXPECT_EQ((Prismatic{.axis = {0.6, 0, 0.8}}.triad().col(2)), Vec3(0.6, 0, 0.8));
  Mat3 const e = planar::Prismatic{.axis = {0.6, 0.8, 0}}.triad();
  EXPECT_EQ(e.col(0), Vec3(0.6, 0.8, 0));
  EXPECT_EQ(e.col(2), Vec3(0, 0, 1));
  EXPECT_NEAR(e.determinant(), 1.0, 1e-15);
}

TEST(Prismatic, RefusesAnAxisThatIsNotAUnitVector) {
  EXPECT_TRUE(has(refusal([] { (void)Prismatic{.axis = {0, 0, 0}}.triad(); }), "Prismatic: the axis"));
  EXPECT_TRUE(has(refusal([] { (void)planar::Prismatic{.axis = {0, 0.5, 0}}.triad(); }),
                  "planar::Prismatic: the axis must be a unit vector"));
}

TEST(Prismatic, RefusesADirectionThatLeavesThePlane) {
  EXPECT_TRUE(has(refusal([] { (void)planar::Prismatic{.axis = {0.6, 0, 0.8}}.triad(); }),
                  "planar::Prismatic: the axis must lie in the plane"));
}

}  // namespace prismatic_test

namespace polybody {
bool const prismatic_obey[] = {obeys<prismatic_test::PrismaticCase, JointLaws>("Prismatic"),
                               obeys<prismatic_test::PlanarPrismaticCase, JointLaws>("PlanarPrismatic")};
}  // namespace polybody
