#include <polybody/joints/gears.hpp>

#include <gtest/gtest.h>

#include <limits>

#include <polybody/testing/joint_laws.hpp>

#include "support/refusal.hpp"

using namespace polybody;
using namespace polybody::laws;

namespace gear_test {

/// The line of centres is rotated by `line`, the wheels by `of_a` and `of_b`.
struct Wheels {
  Frame<double> a, b;
};
Wheels wheels(double line, double of_a, double of_b, double apart = 1.5) {
  auto const turned = [](double angle) { return exp_so3<double>(Vec3(0, 0, angle)); };
  return {{.A = turned(of_a)}, {.r = turned(line) * Vec3(apart, 0, 0), .A = turned(of_b)}};
}

/// A rotation of wheel a by α relative to the line of centres rotates wheel b back by α N_a/N_b.
template <int N_a, int N_b>
struct PlanarGearCase {
  static constexpr bool planar = true;
  static constexpr int world_rows = 0;
  static Gear geometry() { return {.teeth_a = N_a, .teeth_b = N_b}; }
  static Mate mate(Numbers& number, double) {
    double const line = number(3.0), alpha = number(9.0);
    Wheels const w = wheels(line, line + alpha, line - alpha * N_a / N_b);
    Mate mate{.d = w.a.A.transpose() * w.b.r, .R = w.a.A.transpose() * w.b.A, .free_directions = MatX::Zero(6, 2)};
    // b moves away from a along d. It also moves on a circle about a at 1 rad/s and rotates by 1 + N_a/N_b, like a
    // planet of a fixed sun
    mate.free_directions.col(0).head<3>() = mate.d;
    mate.free_directions.col(1).head<3>() = Vec3::UnitZ().cross(mate.d);
    mate.free_directions(5, 1) = 1.0 + double(N_a) / N_b;
    return mate;
  }
};

// In space the centres may have an offset along the axis, and the tilt of b is free.
struct GearCase {
  static constexpr bool planar = false;
  static constexpr int world_rows = 0;
  static Gear geometry() { return {.teeth_a = 3, .teeth_b = 2}; }
  static Mate mate(Numbers& number, double t) {
    Mate mate = PlanarGearCase<3, 2>::mate(number, t);
    MatX const in_plane = mate.free_directions;
    mate.free_directions = MatX::Zero(6, 5);
    mate.free_directions.leftCols<2>() = in_plane;
    for (Index j = 2; j < 5; ++j) mate.free_directions(j, j) = 1.0;
    return mate;
  }
};

double gap_of(Gear const& gear, Wheels const& w) { return constraint_function<double>(gear, w.a, w.b, 0.0).g[0]; }

TEST(Gear, IsClosedAfterAnyNumberOfTurns) {
  Gear const gear{.teeth_a = 20, .teeth_b = 50}, ring{.teeth_a = 20, .teeth_b = -50};
  for (double const alpha : {0.0, 1.0, -3.2, 50.0, 1000.0}) {
    EXPECT_NEAR(gap_of(gear, wheels(0.0, alpha, -0.4 * alpha)), 0.0, 1e-12) << alpha;
    EXPECT_NEAR(gap_of(ring, wheels(0.0, alpha, 0.4 * alpha)), 0.0, 1e-12) << alpha;
    // violation: missing rotation of b, with the opposite sign
    EXPECT_NEAR(gap_of(gear, wheels(0.0, alpha, -0.4 * alpha + 0.1)), -0.1, 1e-12) << alpha;
  }
}

// A planet on a fixed sun: if the line of centres rotates by θ, the planet rotates by (1 + N_a/N_b) θ.
TEST(Gear, RollsAPlanetAboutItsSun) {
  Gear const gear{.teeth_a = 30, .teeth_b = 12};
  for (double const theta : {0.3, 2.0, -7.0}) EXPECT_NEAR(gap_of(gear, wheels(theta, 0.0, 3.5 * theta)), 0.0, 1e-14);
}

// The multiplier is a moment on b. The tooth force, tangential at the pitch circle of b, acts on a with the same
// magnitude. With the distance d of the centres r_b = d N_b/(N_a + N_b), so f = 1/r_b for the moment 1.
TEST(Gear, PushesTheTeethWhereThePitchCirclesTouch) {
  Wheels const w = wheels(0.0, 0.0, 0.0, 2.0);
  ConstraintTerms<1> const gap = constraint_function<double>(Gear{.teeth_a = 30, .teeth_b = 10}, w.a, w.b, 0.0);
  double const r_b = 2.0 * 10 / 40, r_a = 2.0 * 30 / 40;
  Vec6 of_a, of_b;
  of_b << 0, 1 / r_b, 0, 0, 0, -1;
  of_a << 0, -1 / r_b, 0, 0, 0, -r_a / r_b;
  EXPECT_LT((gap.Ga.transpose() - of_a).norm(), 1e-14);
  EXPECT_LT((gap.Gb.transpose() - of_b).norm(), 1e-14);
}

TEST(Gear, RefusesTeethAndAxesThatCannotBeMeant) {
  auto const said = [](int a, int b) { return refusal([&] { Gear{.teeth_a = a, .teeth_b = b}.check("\"pair\""); }); };
  for (auto const& [a, b] : {std::pair{0, 20}, {20, 0}, {-20, -30}})
    EXPECT_TRUE(has(said(a, b), "\"pair\": the numbers of teeth are " + std::to_string(a) + " and "));
  for (auto const& [a, b] : {std::pair{20, -20}, {20, -10}, {-10, 20}})
    EXPECT_TRUE(has(said(a, b), "\"pair\": a ring gear must have"));
  EXPECT_TRUE(has(said(20, std::numeric_limits<int>::min()), "at most 1000000 teeth, but the number is -2147483648"));
  EXPECT_NO_THROW((Gear{.teeth_a = -50, .teeth_b = 20}.check("\"pair\"")));
  EXPECT_TRUE(
      has(refusal([] { (void)Gear{.teeth_a = 1, .teeth_b = 1, .axis = {0, 0, 1}, .centres = {0, 0, 1}}.triad(); }),
          "Gear: the two axes must be perpendicular"));
  EXPECT_TRUE(has(refusal([] { (void)Gear{.teeth_a = 1, .teeth_b = 1, .axis = {0, 0, 2}}.triad(); }),
                  "Gear: the axis must be"));
  EXPECT_TRUE(
      has(refusal([] { (void)Gear{.teeth_a = 1, .teeth_b = 1, .axis = {0, 0, 1}, .centres = {0, 2, 0}}.triad(); }),
          "Gear: the line of centres must be a unit vector"));
}

}  // namespace gear_test

namespace polybody {
bool const gear_obey[] = {obeys<gear_test::PlanarGearCase<3, 2>, JointLaws>("PlanarGear"),
                          obeys<gear_test::PlanarGearCase<2, -5>, JointLaws>("InnerPlanarGear"),
                          obeys<gear_test::GearCase, JointLaws>("Gear")};
}  // namespace polybody
