#include <polybody/joints/nonholonomic.hpp>

#include <gtest/gtest.h>

#include <polybody/testing/joint_laws.hpp>

#include "support/refusal.hpp"

using namespace polybody;
using namespace polybody::laws;

namespace rolling_disc_test {

constexpr double radius = 0.7;

/// Axis and normal at an angle of 1.2 rad in the reference configuration.
RollingDisc leaning() { return {.radius = radius, .axis = {std::sin(1.2), 0, std::cos(1.2)}, .normal = {0, 0, 1}}; }

// A disc that touches the plane anywhere, with any rotation. The rotations about the contact point are free, ω with ṙ
// = −ω × ρ. In the joint's axes the normal is (0, sin 1.2, cos 1.2).
struct RollingDiscCase {
  static constexpr bool planar = false;
  static constexpr int world_rows = 0;
  static RollingDisc geometry() { return leaning(); }
  static Mate mate(Numbers& number, double) {
    Vec3 const n(0, std::sin(1.2), std::cos(1.2)), along = n.unitOrthogonal(), other = n.cross(along);
    Mate mate{.R = exp_so3<double>(number.vec<3>(3.0)), .free_directions = MatX::Zero(6, 3)};
    // the lowest point of the rim from the angle of the steepest direction: r = R (b₁ cos a + b₂ sin a)
    double const a = std::atan2(-n.dot(mate.R.col(1)), -n.dot(mate.R.col(0)));
    Vec3 const rho = radius * (mate.R.col(0) * std::cos(a) + mate.R.col(1) * std::sin(a));
    mate.d = -n * n.dot(rho) + along * number(2.0) + other * number(2.0);
    mate.free_directions.topRows<3>() = skew<double>(rho);
    mate.free_directions.bottomRows<3>().setIdentity();
    return mate;
  }
};

// Upright disc on the plane z = 0 that moves along x: the centre at 3 m/s, the disc at ω about y. The lowest point of
// the rim moves at 3 − ω R.
TEST(RollingDisc, RowsAreTheHeightOfTheRimAndTheVelocityOfTheContactPoint) {
  RollingDisc const disc{.radius = 0.5, .axis = {0, 1, 0}, .normal = {0, 0, 1}};
  Mat3 const axes = disc.triad();
  for (double const omega : {0.0, 6.0, 9.0}) {
    Frame<double> const floor{.A = axes}, b{.r = {4, 5, 0.6}, .A = axes, .v = {3, 0, -1}, .w = {0, omega, 0}};
    auto const gap = constraint_function<double>(disc, floor, b, 0.0);
    Vec3 const rate = gap.Gb * twist(b);
    EXPECT_NEAR(gap.g[0], 0.1, 1e-14);
    EXPECT_NEAR(rate[0], -1.0, 1e-14);
    EXPECT_NEAR(rate.tail<2>().norm(), std::abs(3.0 - 0.5 * omega), 1e-14);
  }
}

TEST(RollingDisc, RefusesWhatCannotRoll) {
  EXPECT_TRUE(
      has(refusal([] { (RollingDisc{.radius = 0.0}.check("\"wheel\"")); }), "\"wheel\": the radius must be positive"));
  EXPECT_TRUE(has(refusal([] { (void)RollingDisc{.radius = 1.0, .axis = {0, 0, 1}, .normal = {0, 0, 1}}.triad(); }),
                  "must not lie flat"));
  EXPECT_TRUE(has(refusal([] { (void)RollingDisc{.radius = 1.0, .axis = {0, 2, 0}, .normal = {0, 0, 1}}.triad(); }),
                  "the axis must be a unit vector"));
  EXPECT_TRUE(has(refusal([] { (void)RollingDisc{.radius = 1.0, .axis = {0, 1, 0}, .normal = {0, 0, 2}}.triad(); }),
                  "the normal must be a unit"));
}

static_assert(nonholonomic_equations<RollingDisc>() == 2);

}  // namespace rolling_disc_test

namespace polybody {
bool const rolling_disc_obeys = obeys<rolling_disc_test::RollingDiscCase, JointLaws>("RollingDisc");
}  // namespace polybody
