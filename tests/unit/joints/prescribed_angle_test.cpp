#include <polybody/joints/driving_constraints.hpp>

#include <gtest/gtest.h>

#include <polybody/testing/joint_laws.hpp>

#include "support/refusal.hpp"

using namespace polybody;
using namespace polybody::laws;

namespace prescribed_angle_test {

using Drive = PrescribedAngle<SmoothRamp>;
Drive const drive{.law = {.target = 1.1, .duration = 4.0}};

struct PlanarDriveCase {
  static constexpr bool planar = true;
  static constexpr int world_rows = 0;
  static Drive geometry() { return drive; }
  static Mate mate(Numbers& number, double t) {
    Mate mate{.d = Vec3(number(), number(), 0.0),
              .R = exp_so3<double>(Vec3(0, 0, drive.law(t).value)),
              .free_directions = MatX::Zero(6, 2)};
    mate.free_directions.topRows<2>().setIdentity();
    return mate;
  }
};

struct DriveCase {
  static constexpr bool planar = false;
  static constexpr int world_rows = 0;
  static Drive geometry() { return drive; }
  static Mate mate(Numbers& number, double t) {
    Mate mate = PlanarDriveCase::mate(number, t);
    mate.d = number.vec<3>();
    mate.free_directions = Mat<double, 6, 5>::Identity();  // all motions except the rotation about the third axis
    return mate;
  }
};

Frame<double> turned(double angle) { return {.A = exp_so3<double>(Vec3(0, 0, angle))}; }

struct Steady {
  double speed = 1.0;
  Motion operator()(double t) const { return {speed * t, speed, 0.0}; }
};

// The angle is wrapped. A driving constraint is satisfied after many rotations, and its violation is the missing
// angle.
TEST(PrescribedAngle, HoldsBeyondManyTurns) {
  PrescribedAngle<Steady> const steady{};
  for (double const t : {0.5, 3.1, 3.2, 40.0, -17.0, 1000.0}) {
    EXPECT_NEAR(constraint_function<double>(steady, turned(0.3), turned(0.3 + t), t).g[0], 0.0, 1e-12) << t;
    EXPECT_NEAR(constraint_function<double>(steady, turned(0.3), turned(0.5 + t), t).g[0], 0.2, 1e-12) << t;
  }
}

TEST(PrescribedAngle, MeasuresTheTurnAboutTheThirdAxis) {
  for (double const angle : {-3.0, -1e-8, 1e-4, 1.0, 3.0})
    EXPECT_NEAR(constraint_function<double>(PrescribedAngle<Constant>{.law = {.value = 0.0}}, turned(1.0),
                                            turned(1.0 + angle), 0.0)
                    .g[0],
                angle, 1e-15);
}

// ġ = a₃ · (ω_b − ω_a) − ψ̇ if b₁ is in the plane of a₁, a₂.
TEST(PrescribedAngle, RateIsTheRelativeAngularVelocityLessTheDrives) {
  PrescribedAngle<Steady> const steady{.law = {.speed = 2.0}};
  ConstraintTerms<1> const gap = constraint_function<double>(steady, turned(0.4), turned(1.7), 0.3);
  EXPECT_LT((gap.Gb.tail<3>() - Vec3(0, 0, 1).transpose()).norm(), 1e-15);
  EXPECT_LT((gap.Ga.tail<3>() + Vec3(0, 0, 1).transpose()).norm(), 1e-15);
  EXPECT_EQ(gap.rate[0], -2.0);
}

TEST(PrescribedAngle, TellsTheCornersOfItsLaw) {
  PrescribedAngle<Ramp> const ramp{.law = {.target = 1.0, .duration = 2.0, .start = 0.5}};
  EXPECT_EQ(ramp.breakpoints(), (std::vector{0.5, 2.5}));
  EXPECT_TRUE(drive.breakpoints().empty());
}

TEST(PrescribedAngle, RefusesALawThatCannotBeMeant) {
  PrescribedAngle<Ramp> const lame{.law = {.target = 1.0, .duration = 0.0}};
  EXPECT_TRUE(has(refusal([&] { lame.check("\"drive\""); }), "\"drive\": the time function: the duration"));
}

TEST(PrescribedAngle, RefusesALawThatJumps) {
  PrescribedAngle<Window> const jump{.law = {.from = 1.0, .to = 2.0, .value = 0.5}};
  EXPECT_TRUE(has(refusal([&] { jump.check("\"drive\""); }),
                  "\"drive\": the time function: the value jumps from 0 to 0.5 at t = 1 s"));
  EXPECT_NO_THROW(
      (PrescribedAngle<Ramp>{.law = {.target = 100.0, .duration = 1e-3, .start = 50.0}}.check("\"drive\"")));
}

TEST(PrescribedAngle, RefusesAnAxisThatIsNotAUnitVector) {
  Drive lame = drive;
  lame.axis = {0, 0, 0};
  EXPECT_TRUE(has(refusal([&] { (void)lame.triad(); }), "PrescribedAngle: the axis must be a unit vector"));
}

}  // namespace prescribed_angle_test

namespace polybody {
bool const prescribed_angle_obey[] = {
    obeys<prescribed_angle_test::DriveCase, JointLaws>("PrescribedAngle"),
    obeys<prescribed_angle_test::PlanarDriveCase, JointLaws>("PlanarPrescribedAngle")};
}  // namespace polybody
