#include <polybody/joints/standard_joints.hpp>

#include <gtest/gtest.h>

#include <polybody/testing/joint_laws.hpp>

#include "support/refusal.hpp"

using namespace polybody;
using namespace polybody::laws;

namespace plane_on_plane_test {

struct PlaneOnPlaneCase {
  static constexpr bool planar = false;
  static constexpr int world_rows = 0;
  static PlanarJoint geometry() { return {}; }
  static Mate mate(Numbers& number, double) {
    Mate mate{.d = Vec3(number(2.0), number(2.0), 0),
              .R = exp_so3<double>(Vec3(0, 0, number(3.0))),
              .free_directions = MatX::Zero(6, 3)};
    mate.free_directions(0, 0) = mate.free_directions(1, 1) = mate.free_directions(5, 2) = 1.0;
    return mate;
  }
};

// b is 0.3 above the plane, tilted about a₂ by φ: b₃ = (sin φ, 0, cos φ).
TEST(PlanarJoint, RowsAreTheHeightAndTheTilt) {
  Frame<double> const b{.r = {5, -7, 0.3}, .A = exp_so3<double>(Vec3(0, 0.2, 0))};
  EXPECT_LT((constraint_function<double>(PlanarJoint{}, {}, b, 0.0).g - Vec3(0.3, std::sin(0.2), 0)).norm(), 1e-15);
}

TEST(PlanarJoint, RefusesANormalThatIsNotAUnitVector) {
  EXPECT_TRUE(
      has(refusal([] { (void)PlanarJoint{.normal = {1, 1, 0}}.triad(); }), "PlanarJoint: the normal must be a unit"));
}

}  // namespace plane_on_plane_test

namespace polybody {
bool const plane_on_plane_obeys = obeys<plane_on_plane_test::PlaneOnPlaneCase, JointLaws>("PlanarJoint");
}  // namespace polybody
