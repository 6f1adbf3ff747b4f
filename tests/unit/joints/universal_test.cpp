#include <polybody/joints/standard_joints.hpp>

#include <gtest/gtest.h>

#include <polybody/testing/joint_laws.hpp>

#include "support/refusal.hpp"

using namespace polybody;
using namespace polybody::laws;

namespace universal_test {

// b rotates about a₁ by φ, then about its own third axis by ψ: b₃ stays perpendicular to a₁.
struct UniversalCase {
  static constexpr bool planar = false;
  static constexpr int world_rows = 3;
  static Universal geometry() { return {}; }
  static Mate mate(Numbers& number, double) {
    double const phi = number(3.0), psi = number(3.0);
    Mate mate{.R = exp_so3<double>(Vec3(phi, 0, 0)) * exp_so3<double>(Vec3(0, 0, psi)),
              .free_directions = MatX::Zero(6, 2)};
    mate.free_directions.bottomRows<3>() << Vec3::UnitX(), mate.R.col(2);
    return mate;
  }
};

TEST(Universal, TakesBothArmsOfTheCross) {
  Universal const joint{.first = {0.6, 0.8, 0}, .second = {0, 0, -1}};
  Mat3 const e = joint.triad();
  EXPECT_EQ(e.col(0), Vec3(joint.first));
  EXPECT_EQ(e.col(2), Vec3(joint.second));
  EXPECT_LT((e.transpose() * e - Mat3::Identity()).norm(), 1e-15);
  EXPECT_GT(e.determinant(), 0.0);
}

// The fourth constraint function is the cosine of the angle between the arms: b is rotated about a₂ by φ, b₃ = (sin
// φ, 0, cos φ).
TEST(Universal, FourthRowIsTheCosineBetweenTheArms) {
  Frame<double> const b{.A = exp_so3<double>(Vec3(0, 0.3, 0))};
  EXPECT_NEAR((constraint_function<double>(Universal{}, {}, b, 0.0).g[3]), std::sin(0.3), 1e-15);
}

TEST(Universal, RefusesArmsThatMakeNoCross) {
  EXPECT_TRUE(has(refusal([] { (void)Universal{.first = {1, 0, 0}, .second = {0.6, 0.8, 0}}.triad(); }),
                  "Universal: the two axes must be perpendicular"));
  EXPECT_TRUE(has(refusal([] { (void)Universal{.first = {2, 0, 0}, .second = {0, 1, 0}}.triad(); }),
                  "Universal: the first axis must be a unit"));
  EXPECT_TRUE(has(refusal([] { (void)Universal{.first = {1, 0, 0}, .second = {0, 0, 0}}.triad(); }),
                  "Universal: the second axis must be a unit"));
}

}  // namespace universal_test

namespace polybody {
bool const universal_obeys = obeys<universal_test::UniversalCase, JointLaws>("Universal");
}  // namespace polybody
