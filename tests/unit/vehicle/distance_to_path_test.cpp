// Distances to a path of straight lines, by geometry.
#include <polybody/vehicle/track_checks.hpp>

#include <gtest/gtest.h>

#include <array>
#include <numbers>
#include <vector>

#include "support/refusal.hpp"

namespace polybody {
namespace distance_to_path_test {

// A corner at the origin, with one leg along x, 4 m long, and the other along z, 3 m.
std::array<Vec2, 3> const corner{Vec2(4.0, 0.0), Vec2(0.0, 0.0), Vec2(0.0, 3.0)};

TEST(DistanceToPath, IsAcrossALineBesideIt) {
  EXPECT_DOUBLE_EQ(distance_to_path(Vec2(2.0, -0.5), corner), 0.5);
  EXPECT_DOUBLE_EQ(distance_to_path(Vec2(-0.25, 1.0), corner), 0.25);
  EXPECT_DOUBLE_EQ(distance_to_path(Vec2(1.0, 2.0), corner), 1.0);  // between the legs: the nearer one
}

TEST(DistanceToPath, IsThatOfTheCornerBeyondALine) {
  EXPECT_DOUBLE_EQ(distance_to_path(Vec2(-3.0, -4.0), corner), 5.0);
  EXPECT_DOUBLE_EQ(distance_to_path(Vec2(7.0, 4.0), corner), 5.0);     // an end
  EXPECT_DOUBLE_EQ(distance_to_path(Vec2(-5.0, 15.0), corner), 13.0);  // the other end
}

TEST(DistanceToPath, IsZeroOnThePath) {
  EXPECT_EQ(distance_to_path(Vec2(0.0, 0.0), corner), 0.0);
  EXPECT_EQ(distance_to_path(Vec2(2.0, 0.0), corner), 0.0);
}

// 2 sin(π/n) is a side of a regular polygon on the unit circle, cos(π/n) its distance from the middle.
TEST(DistanceToPath, OfAClosedPathHasTheLastSideToo) {
  int const n = 7;
  std::vector<Vec2> polygon;
  for (int i = 0; i <= n; ++i) {
    double const angle = 2.0 * std::numbers::pi * i / n;
    polygon.emplace_back(std::cos(angle), std::sin(angle));
  }
  EXPECT_NEAR(distance_to_path(Vec2(0.0, 0.0), polygon), std::cos(std::numbers::pi / n), 1e-15);
  double const last = 2.0 * std::numbers::pi * (n - 0.5) / n;
  Vec2 const beside = std::cos(std::numbers::pi / n) * Vec2(std::cos(last), std::sin(last));
  EXPECT_NEAR(distance_to_path(beside, polygon), 0.0, 1e-15);
  polygon.pop_back();
  EXPECT_GT(distance_to_path(beside, polygon), 0.4);  // half a side is sin(π/7) = 0.43
}

TEST(DistanceToPath, TakesCornersThatCoincide) {
  std::array<Vec2, 3> const still{Vec2(1.0, 1.0), Vec2(1.0, 1.0), Vec2(1.0, 1.0)};
  EXPECT_DOUBLE_EQ(distance_to_path(Vec2(4.0, 5.0), still), 5.0);
  EXPECT_DOUBLE_EQ(distance_to_path(Vec2(4.0, 5.0), std::span(still).first(1)), 5.0);
}

TEST(DistanceToPath, RefusesAPathWithoutCorners) {
  EXPECT_TRUE(
      has(refusal([] { distance_to_path(Vec2(0.0, 0.0), std::span<Vec2 const>()); }), "the path has no corner"));
}

}  // namespace distance_to_path_test
}  // namespace polybody
