#include <polybody/forces/gravity.hpp>

#include <gtest/gtest.h>

#include "support/refusal.hpp"

using namespace polybody;

namespace gravity_test {

TEST(Gravity, IsNoneUnlessGiven) {
  EXPECT_EQ(Gravity{}.g, Vec3(0, 0, 0));
  EXPECT_EQ((Gravity{0, -9.81, 0}.g), Vec3(0, -9.81, 0));
  EXPECT_EQ(Gravity{Vec3(1, 2, 3)}.g, Vec3(1, 2, 3));
}

TEST(Gravity, RefusesNan) {
  double const nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(has(refusal([&] { Gravity(0, nan, 0); }), "Gravity must be finite"));
  EXPECT_TRUE(has(refusal([&] { Gravity{Vec3(0, 0, std::numeric_limits<double>::infinity())}; }), "Gravity"));
}

}  // namespace gravity_test
