#include <polybody/joints/driving_constraints.hpp>
#include <polybody/joints/standard_joints.hpp>

#include <gtest/gtest.h>

#include <polybody/testing/joint_laws.hpp>

#include "support/refusal.hpp"

using namespace polybody;
using namespace polybody::laws;

namespace distance_test {

constexpr double length = 0.8;

/// b is anywhere at a given distance from a, with any rotation. All motions except that along d are free.
Mate at_distance(Numbers& number, double distance) {
  Vec3 const e = number.vec<3>().normalized(), f = e.unitOrthogonal();
  Mate mate{.d = distance * e, .R = exp_so3<double>(number.vec<3>(3.0)), .free_directions = MatX::Zero(6, 5)};
  mate.free_directions.topLeftCorner<3, 2>() << f, e.cross(f);
  mate.free_directions.bottomRightCorner<3, 3>().setIdentity();
  return mate;
}
Mate at_distance_in_plane(Numbers& number, double distance) {
  double const phi = number(3.0);
  Mate mate{.d = distance * Vec3(std::cos(phi), std::sin(phi), 0),
            .R = exp_so3<double>(Vec3(0, 0, number(3.0))),
            .free_directions = MatX::Zero(6, 2)};
  mate.free_directions.col(0).head<2>() << -std::sin(phi), std::cos(phi);
  mate.free_directions(5, 1) = 1.0;
  return mate;
}

struct DistanceCase {
  static constexpr bool planar = false;
  static constexpr int world_rows = 0;
  static Distance geometry() { return {.length = length}; }
  static Mate mate(Numbers& number, double) { return at_distance(number, length); }
};
struct PlanarDistanceCase : DistanceCase {
  static constexpr bool planar = true;
  static Mate mate(Numbers& number, double) { return at_distance_in_plane(number, length); }
};

using Actuator = PrescribedDistance<SmoothRamp>;
Actuator const actuator{.law = {.target = 0.6, .duration = 4.0}, .length = length};

struct ActuatorCase {
  static constexpr bool planar = false;
  static constexpr int world_rows = 0;
  static Actuator geometry() { return actuator; }
  static Mate mate(Numbers& number, double t) { return at_distance(number, length + actuator.law(t).value); }
};
struct PlanarActuatorCase : ActuatorCase {
  static constexpr bool planar = true;
  static Mate mate(Numbers& number, double t) { return at_distance_in_plane(number, length + actuator.law(t).value); }
};

// The multiplier is a force: it pulls separated points together, along d = (3, 4, 0)/5.
TEST(Distance, GapIsALengthAndItsMultiplierATension) {
  Frame<double> const a{.r = {1, 1, 1}}, b{.r = {4, 5, 1}};
  ConstraintTerms<1> const gap = constraint_function<double>(Distance{.length = 2.0}, a, b, 0.0);
  EXPECT_DOUBLE_EQ(gap.g[0], 3.0);
  EXPECT_LT((gap.Gb.head<3>() - Vec3(0.6, 0.8, 0).transpose()).norm(), 1e-15);
  EXPECT_EQ(gap.Gb.tail<3>().norm() + gap.Ga.tail<3>().norm(), 0.0);
}

// b moves around a at ω: the points keep their distance, and g̈ without accelerations is ω² L.
TEST(Distance, GammaIsTheCentripetalAcceleration) {
  Frame<double> const b{.r = {2, 0, 0}, .v = {5, 3, 0}};
  EXPECT_DOUBLE_EQ((constraint_gamma<double>(Distance{.length = 2.0}, {}, b, 0.0)[0]), 9.0 / 2.0);
}

TEST(Distance, OfPointsThatCoincideIsFinite) {
  ConstraintTerms<1> const gap = constraint_function<double>(Distance{.length = 2.0}, {}, {}, 0.0);
  EXPECT_EQ(gap.g[0], -2.0);
  EXPECT_EQ(Vec3(gap.Gb.head<3>()), Vec3(1, 0, 0));
}

TEST(Distance, RefusesALengthThatIsNone) {
  for (double const l : {0.0, -1.0, double(NAN), HUGE_VAL})
    EXPECT_TRUE(has(refusal([&] { Distance{.length = l}.check("\"rod\""); }),
                    "\"rod\": the length must be positive and finite"));
  EXPECT_TRUE(has(refusal([] { Distance{.length = 0.0}.check("\"rod\""); }), "Spherical"));
}

TEST(PrescribedDistance, RefusesWhatNoActuatorCanDo) {
  EXPECT_TRUE(
      has(refusal([] { Actuator{.law = actuator.law, .length = 0.0}.check("\"ram\""); }), "\"ram\": the length"));
  EXPECT_TRUE(has(refusal([] { Actuator{.law = {.target = 1.0, .duration = 0.0}, .length = 1.0}.check("\"ram\""); }),
                  "\"ram\": the time function: the duration"));
  PrescribedDistance<Window> const jump{.law = {.from = 1.0, .to = 2.0}, .length = 1.0};
  EXPECT_TRUE(has(refusal([&] { jump.check("\"ram\""); }),
                  "\"ram\": the time function: the value jumps from 0 to 1 at t = 1 s"));
}

TEST(PrescribedDistance, TellsTheCornersOfItsLaw) {
  PrescribedDistance<Ramp> const ramp{.law = {.target = 1.0, .duration = 2.0, .start = 0.5}, .length = 1.0};
  EXPECT_EQ(ramp.breakpoints(), (std::vector{0.5, 2.5}));
  EXPECT_TRUE(actuator.breakpoints().empty());
}

}  // namespace distance_test

namespace polybody {
bool const distance_obey[] = {obeys<distance_test::DistanceCase, JointLaws>("Distance"),
                              obeys<distance_test::PlanarDistanceCase, JointLaws>("PlanarDistance"),
                              obeys<distance_test::ActuatorCase, JointLaws>("PrescribedDistance"),
                              obeys<distance_test::PlanarActuatorCase, JointLaws>("PlanarPrescribedDistance")};
}  // namespace polybody
