#include <polybody/joints/standard_joints.hpp>

#include <gtest/gtest.h>

#include <polybody/testing/joint_laws.hpp>

#include "support/refusal.hpp"

using namespace polybody;
using namespace polybody::laws;

namespace screw_test {

double const pi = std::numbers::pi;
constexpr double p = 0.7;

Frame<double> nut(double slide, double angle) { return {.r = {0, 0, slide}, .A = exp_so3<double>(Vec3(0, 0, angle))}; }

// Rotations of up to ±9 rad, more than one turn.
struct ScrewCase {
  static constexpr bool planar = false;
  static constexpr int world_rows = 0;
  static Screw geometry() { return {.pitch = p}; }
  static Mate mate(Numbers& number, double) {
    double const angle = number(9.0);
    Frame<double> const b = nut(p * angle, angle);
    Mate mate{.d = b.r, .R = b.A, .free_directions = MatX::Zero(6, 1)};
    mate.free_directions(2, 0) = p;
    mate.free_directions(5, 0) = 1.0;
    return mate;
  }
};

TEST(Screw, CountsItsTurnsByTheSlide) {
  for (double const pitch : {0.7, -0.02})
    for (double const angle : {0.0, 1.0, 3.1, 3.2, -40.0, 1000.0}) {
      Screw const screw{.pitch = pitch};
      EXPECT_NEAR(constraint_function<double>(screw, {}, nut(pitch * angle, angle), 0.0).g[4], 0.0, 1e-12) << angle;
      EXPECT_NEAR(constraint_function<double>(screw, {}, nut(pitch * angle + 0.01, angle), 0.0).g[4], 0.01, 1e-12)
          << angle;
    }
}

// A translation by one lead 2π p without rotation leads to the next thread.
TEST(Screw, IsClosedOnEveryThread) {
  EXPECT_NEAR((constraint_function<double>(Screw{.pitch = p}, {}, nut(2.0 * pi * p, 0.0), 0.0).g[4]), 0.0, 1e-14);
  EXPECT_NEAR((constraint_function<double>(Screw{.pitch = p}, {}, nut(0.9 * pi * p, 0.0), 0.0).g[4]), 0.9 * pi * p,
              1e-14);
}

TEST(Screw, RefusesAPitchThatCannotBeMeant) {
  EXPECT_TRUE(has(refusal([] { Screw{.pitch = 0.0}.check("\"thread\""); }),
                  "\"thread\": the pitch must be finite and not zero"));
  EXPECT_TRUE(has(refusal([] { Screw{.pitch = NAN}.check("\"thread\""); }), "pitch"));
  EXPECT_NO_THROW(Screw{.pitch = -0.1}.check("\"thread\""));
  EXPECT_TRUE(has(refusal([] { (void)Screw{.pitch = p, .axis = {0, 0, 0}}.triad(); }),
                  "Screw: the axis must be a unit vector"));
}

}  // namespace screw_test

namespace polybody {
bool const screw_obeys = obeys<screw_test::ScrewCase, JointLaws>("Screw");
}  // namespace polybody
