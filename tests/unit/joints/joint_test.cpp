#include <polybody/joints/joint.hpp>
#include <polybody/joints/planar/joints.hpp>
#include <polybody/joints/standard_joints.hpp>

#include <gtest/gtest.h>

using namespace polybody;

namespace joint_test {

TEST(Joint, IsAGeometryAndAPolicy) {
  using Soft = Joint<Revolute, Penalty>;
  static_assert(std::is_same_v<Soft::Geometry, Revolute> && std::is_same_v<Soft::PolicyType, Penalty>);
  Soft const soft{Revolute{.axis = {0, 1, 0}}, Penalty{.stiffness = 5.0, .damping = 0.1}};
  EXPECT_EQ(Vec3(soft.geometry.axis), Vec3(0, 1, 0));
  EXPECT_EQ(double(soft.policy.stiffness), 5.0);
}

TEST(Joint, HasTheRowsOfItsGeometryUnderEveryPolicy) {
  static_assert(Joint<Weld, Constraint>::rows == 6 && Joint<Weld, Penalty>::rows == 6);
  static_assert(Joint<planar::Revolute, Constraint>::rows == 2);
}

TEST(Joint, NeedsNoNumbersUnlessItsPolicyDoes) {
  Joint<Revolute, Constraint> const pin{};
  EXPECT_FALSE(pin.geometry.axis.given());
  static_assert(std::is_default_constructible_v<Joint<Revolute, Constraint>>);
}

// Types that do not form a joint do not compile (tests/compile_fail): a geometry instead of a policy, or numbers.
static_assert(JointGeometry<Revolute> && Policy<Constraint> && Policy<Penalty>);
static_assert(!JointGeometry<Constraint> && !Policy<Revolute> && !JointGeometry<double> && !Policy<double>);

}  // namespace joint_test
