#include <polybody/joints/standard_joints.hpp>

#include <gtest/gtest.h>

#include <polybody/testing/joint_laws.hpp>

using namespace polybody;
using namespace polybody::laws;

namespace spherical_test {

struct SphericalCase {
  static constexpr bool planar = false;
  static constexpr int world_rows = 3;
  static Spherical geometry() { return {}; }
  static Mate mate(Numbers& number, double) {
    Mate mate{.R = exp_so3<double>(number.vec<3>(3.0)), .free_directions = MatX::Zero(6, 3)};
    mate.free_directions.bottomRows<3>().setIdentity();
    return mate;
  }
};

TEST(Spherical, GapLeadsFromTheFirstPointToTheSecond) {
  Frame<double> a, b;
  a.r = {1, 2, 3};
  b.r = {1.5, 1, 3};
  EXPECT_EQ(constraint_function<double>(Spherical{}, a, b, 0.0).g, Vec3(0.5, -1, 0));
}

}  // namespace spherical_test

namespace polybody {
bool const spherical_obeys = obeys<spherical_test::SphericalCase, JointLaws>("Spherical");
}  // namespace polybody
