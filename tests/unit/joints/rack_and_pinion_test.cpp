#include <polybody/joints/gears.hpp>

#include <gtest/gtest.h>

#include <polybody/testing/joint_laws.hpp>

#include "support/refusal.hpp"

using namespace polybody;
using namespace polybody::laws;

namespace rack_and_pinion_test {

constexpr double radius = 0.6;

Frame<double> pinion(double slide, double height, double angle) {
  return {.r = {slide, height, 0}, .A = exp_so3<double>(Vec3(0, 0, angle))};
}

// The pinion rolls along the rack and may move away from it.
struct PlanarRackCase {
  static constexpr bool planar = true;
  static constexpr int world_rows = 0;
  static RackAndPinion geometry() { return {.radius = radius}; }
  static Mate mate(Numbers& number, double) {
    double const angle = number(9.0);
    Frame<double> const b = pinion(radius * angle, number(), angle);
    Mate mate{.d = b.r, .R = b.A, .free_directions = MatX::Zero(6, 2)};
    mate.free_directions(0, 0) = radius;
    mate.free_directions(5, 0) = 1.0;
    mate.free_directions(1, 1) = 1.0;
    return mate;
  }
};

// In space it may also move along its axis, and its tilt is free.
struct RackCase {
  static constexpr bool planar = false;
  static constexpr int world_rows = 0;
  static RackAndPinion geometry() { return {.radius = radius}; }
  static Mate mate(Numbers& number, double t) {
    Mate mate = PlanarRackCase::mate(number, t);
    mate.free_directions.conservativeResizeLike(MatX::Zero(6, 5));
    for (Index j = 2; j < 5; ++j) mate.free_directions(j, j) = 1.0;
    return mate;
  }
};

// A wheel of radius 0.5 on a floor below it: after a distance s it has rotated by −s/R about z.
TEST(RackAndPinion, RollsOnAFloorByANegativeRadius) {
  RackAndPinion const floor{.radius = -0.5};
  for (double const s : {0.0, 1.0, -40.0, 500.0}) {
    EXPECT_NEAR(constraint_function<double>(floor, {}, pinion(s, 0.5, -s / 0.5), 0.0).g[0], 0.0, 1e-12) << s;
    EXPECT_NEAR(constraint_function<double>(floor, {}, pinion(s + 0.01, 0.5, -s / 0.5), 0.0).g[0], 0.01, 1e-12) << s;
  }
}

TEST(RackAndPinion, RefusesWhatCannotRoll) {
  for (double const r : {0.0, double(NAN), HUGE_VAL})
    EXPECT_TRUE(
        has(refusal([&] { RackAndPinion{.radius = r}.check("\"rack\""); }), "\"rack\": the radius must be finite"));
  EXPECT_TRUE(
      has(refusal([] { (void)RackAndPinion{.radius = 1.0, .axis = {0, 0, 1}, .direction = {0, 0, 1}}.triad(); }),
          "RackAndPinion: the two axes must be perpendicular"));
  EXPECT_TRUE(
      has(refusal([] { (void)RackAndPinion{.radius = 1.0, .axis = {0, 0, 1}, .direction = {2, 0, 0}}.triad(); }),
          "RackAndPinion: the direction must be a unit vector"));
}

}  // namespace rack_and_pinion_test

namespace polybody {
bool const rack_and_pinion_obey[] = {obeys<rack_and_pinion_test::PlanarRackCase, JointLaws>("PlanarRackAndPinion"),
                                     obeys<rack_and_pinion_test::RackCase, JointLaws>("RackAndPinion")};
}  // namespace polybody
