#include <polybody/joints/nonholonomic.hpp>

#include <gtest/gtest.h>

#include <polybody/joints/joint.hpp>
#include <polybody/joints/policies/policy.hpp>
#include <polybody/testing/joint_laws.hpp>

#include "support/refusal.hpp"

using namespace polybody;
using namespace polybody::laws;

namespace knife_edge_test {

// Any position and any rotation. The velocities along b₁ and b₂ and all rotations are free.
struct KnifeEdgeCase {
  static constexpr bool planar = false;
  static constexpr int world_rows = 0;
  static KnifeEdge geometry() { return {.across = Vec3::UnitY()}; }
  static Mate mate(Numbers& number, double) {
    Mate mate{.d = number.vec<3>(2.0), .R = exp_so3<double>(number.vec<3>(3.0)), .free_directions = MatX::Zero(6, 5)};
    mate.free_directions.topLeftCorner<3, 2>() = mate.R.leftCols<2>();
    mate.free_directions.bottomRightCorner<3, 3>().setIdentity();
    return mate;
  }
};

// On a turntable (2 rad/s about z) the table below a blade at (3, 0, 0) moves at 6 m/s along y. A blade at rest there
// that points along x moves across its edge at −6 m/s relative to the table.
TEST(KnifeEdge, RowIsTheVelocityAcrossSeenFromTheOtherBody) {
  Frame<double> const table{.w = {0, 0, 2}};
  Frame<double> blade{.r = {3, 0, 0}};
  KnifeEdge const edge{.across = Vec3::UnitY()};
  blade.A = edge.triad();
  auto const gap = constraint_function<double>(edge, table, blade, 0.0);
  EXPECT_NEAR((gap.Ga * twist(table) + gap.Gb * twist(blade))[0], -6.0, 1e-14);
  blade.v = {7, 6, 1};  // moved along with the table, and gliding
  EXPECT_NEAR((gap.Ga * twist(table) + gap.Gb * twist(blade))[0], 0.0, 1e-14);
}

TEST(KnifeEdge, RefusesADirectionThatIsNoUnitVector) {
  EXPECT_TRUE(has(refusal([] { (void)KnifeEdge{.across = {0, 2, 0}}.triad(); }),
                  "KnifeEdge: the direction across must be a unit"));
}

static_assert(nonholonomic_equations<KnifeEdge>() == 1);
static_assert(Joint<KnifeEdge, Constraint>::rows == 1);

}  // namespace knife_edge_test

namespace polybody {
bool const knife_edge_obeys = obeys<knife_edge_test::KnifeEdgeCase, JointLaws>("KnifeEdge");
}  // namespace polybody
