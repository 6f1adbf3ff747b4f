// Rods, gears and driving constraints in the plane: point pendulum of IFToMM A01 (R1), the vehicle's sprocket of
// Wallin 2016 (C8), and motions in closed form.

#include <gtest/gtest.h>

#include <polybody/bodies/rigid/planar_rigid.hpp>
#include <polybody/integrators/runge_kutta.hpp>
#include <polybody/joints/driving_constraints.hpp>
#include <polybody/joints/gears.hpp>
#include <polybody/joints/planar/joints.hpp>
#include <polybody/joints/standard_joints.hpp>
#include <polybody/run/probe.hpp>
#include <polybody/run/simulate.hpp>

#include "support/held.hpp"
#include "support/refusal.hpp"
#include "support/solver_instances.hpp"

using namespace polybody;

namespace joints_plane_test {

template <JointGeometry G>
using Ideal = Joint<G, Constraint>;
using Pin = Ideal<planar::Revolute>;
using Rod = Ideal<Distance>;
using Ram = Ideal<PrescribedDistance<SmoothRamp>>;
using Motor = Ideal<PrescribedRate<SmoothRamp>>;
using Hand = Ideal<PrescribedTranslation<SmoothRamp>>;
using Plane = Model<Bodies<planar::Rigid>, Joints<Pin, Rod, Ram, Motor, Ideal<Gear>, Ideal<PointInPlane>, Hand>>;

constexpr double g = 9.81;

DormandPrince<Projection> precise() { return {.relative_tolerance = 1e-11, .absolute_tolerance = 1e-11}; }
void run_to(Plane const& model, State& x, double t) {
  simulate(model, x, precise(), {.end_time = t, .step = 0.01}).run();
}

/// Checks for a number and a vector in closed form.
void exact(char const* case_id, char const* what, char const* source, char const* joint, double value, double reference,
           double tolerance, double t) {
  held({case_id, what, By::closed_form, source, std::string(joint) + ", Dormand–Prince"}, value, reference, tolerance,
       {equals("t", t), 1.0});
}
void within(char const* case_id, char const* what, char const* source, char const* joint, double error,
            double tolerance, double t, double scale) {
  held_within({case_id, what, By::closed_form, source, std::string(joint) + ", Dormand–Prince"}, error, tolerance,
              {equals("t", t), scale});
}

TEST(DistanceInThePlane, SwingsAPointWhereThePublishedSolutionIs) {
  struct {
    double t, x, y;
  } const r1[] = {{0.5, -0.3910487915505464, -0.9203699487851922},
                  {1, 0.9862917511318753, -0.1650108531255412},
                  {10, -0.2750874625761169, -0.9614192050991251}};
  Plane model{Gravity{0, -g, 0}};
  auto const mass = model.add(planar::Rigid(2.0, 0.1, Placement::planar(-1, 0)), "mass");
  model.connect(Rod{{.length = 1.0}, {}}, model.ground().at({0, 0, 0}), mass.at({0, 0}), "rod");
  State x = model.reference_state();
  for (auto const& p : r1) {
    run_to(model, x, p.t);
    within("R1", "place of the point mass on a rod [m]", "elliptic functions", "Distance in the plane",
           (position(model, x, mass.at({0, 0})) - Vec3(p.x, p.y, 0)).norm(), 1e-8, p.t, 1.0);
  }
}

// A rod between coincident points is refused, and the error names the rod. `assemble` separates the points.
TEST(DistanceInThePlane, OfPointsThatCoincideDoesNotStart) {
  Plane model{Gravity{0, -g, 0}};
  auto const mass = model.add(planar::Rigid(2.0, 0.1), "mass");
  model.connect(Rod{{.length = 1.0}, {}}, model.ground().at({0, 0, 0}), mass.at({0, 0}), "rod");
  State x = model.reference_state();
  EXPECT_TRUE(has(message_of<InconsistentInitialConditions>([&] { run_to(model, x, 1.0); }), "rod"));
  assemble(model, x);
  EXPECT_NEAR(position(model, x, mass.at({0, 0})).norm(), 1.0, 1e-12);
  auto const ground = model.ground().at({0, 0, 0});
  EXPECT_TRUE(has(refusal([&] { model.connect(Rod{{.length = 0.0}, {}}, ground, mass.at({0, 0}), "short"); }),
                  "\"short\": the length must be positive"));
}

// Weight lowered on a ram with the stroke of SmoothRamp. The ram carries m (g − ẍ).
TEST(PrescribedDistanceInThePlane, LetsDownAWeight) {
  double const m = 3.0;
  SmoothRamp const stroke{.target = 0.8, .duration = 2.0};
  Plane model{Gravity{0, -g, 0}};
  auto const weight = model.add(planar::Rigid(m, 0.1, Placement::planar(0, -1)), "weight");
  auto const ram =
      model.connect(Ram{{.law = stroke, .length = 1.0}, {}}, model.ground().at({0, 0, 0}), weight.at({0, 0}), "ram");
  State x = model.reference_state();
  for (double const t : {0.5, 1.2, 3.0}) {
    run_to(model, x, t);
    double const y = std::min(1.0, 0.5 * t), value = 0.8 * y * y * y * (10.0 - 15.0 * y + 6.0 * y * y);
    double const acceleration = 0.8 * 60.0 * y * (1.0 - 3.0 * y + 2.0 * y * y) / 4.0;
    within("closed forms", "place of a weight let down on a ram [m]", "polynomial of degree five", "PrescribedDistance",
           (position(model, x, weight.at({0, 0})) - Vec3(0, -1.0 - value, 0)).norm(), 1e-9, t, 1.0 + value);
    within("closed forms", "force of a ram that lets down a weight [N]", "m (g − ẍ)", "PrescribedDistance",
           (reaction(model, x, ram).f - Vec3(0, m * (g - acceleration), 0)).norm(), 1e-7, t, m * g);
  }
}

/// Sprocket of Wallin 2016 (C8): at rest for one second, then accelerated to 25 rad/s at 8 s.
Motor const motor{{.law = {{.target = 25.0, .duration = 7.0, .start = 1.0}}}, {}};
double speed(double t) {
  double const y = std::clamp((t - 1.0) / 7.0, 0.0, 1.0);
  return 25.0 * y * y * y * (10.0 - 15.0 * y + 6.0 * y * y);
}
double growth(double t) {
  double const y = std::clamp((t - 1.0) / 7.0, 0.0, 1.0);
  return 25.0 * 30.0 * y * y * (1.0 - 2.0 * y + y * y) / 7.0;
}

// A wheel of 20 teeth drives one of 50: ω_b = −0.4 ω_a through 20 revolutions. The moment of the motor is (J_a + 0.4²
// J_b) ω̇. Inside a ring of 50 teeth both rotate in the same direction.
TEST(Gear, HandsOnTheSprocketsRunUp) {
  double const of_a = 0.2, of_b = 0.9;
  for (int const sign : {1, -1}) {
    Plane model{};
    auto const a = model.add(planar::Rigid(1.0, of_a), "driver");
    auto const b = model.add(planar::Rigid(1.0, of_b, Placement::planar(0.0, 1.5)), "driven");
    model.connect(Pin{}, model.ground().at({0, 0, 0}), a.at({0, 0}), "pin of the driver");
    model.connect(Pin{}, model.ground().at({0, 1.5, 0}), b.at({0, 0}), "pin of the driven");
    Gear const gear{.teeth_a = 20, .teeth_b = 50 * sign, .centres = Vec3::UnitY()};
    model.connect(Ideal<Gear>{gear, {}}, a.at({0, 0}), b.at({0, 0}), "gear");
    auto const drive = model.connect(motor, model.ground().at({0, 0, 0}), a.at({0, 0}), "motor");
    State x = model.reference_state();
    char const* const law = "polynomial of degree five from 1 s to 8 s";
    char const* const pair = sign > 0 ? "Gear" : "Gear in a ring";
    for (double const t : {2.0, 4.5, 10.0, 15.0, 20.0}) {
      run_to(model, x, t);
      exact("C8", "speed of the sprocket [rad/s]", law, pair, x.v[2], speed(t), 1e-8, t);
      exact("C8", "speed of the driven wheel [rad/s]", "ratio of the teeth", pair, x.v[5], -0.4 * sign * speed(t), 1e-8,
            t);
      exact("C8", "moment of the motor [N m]", "(J_a + (20/50)² J_b) ω̇", pair, reaction(model, x, drive).m[2],
            (of_a + 0.16 * of_b) * growth(t), 1e-8, t);
      if (t < 10.0) continue;
      double const angle = 87.5 + 25.0 * (t - 8.0);  // half of 25 · 7, plus the steady part
      exact("C8", "angle of the sprocket [rad]", law, pair, x.q[2], angle, 1e-7, t);
      exact("C8", "angle of the driven wheel [rad]", "ratio of the teeth", pair, x.q[5], -0.4 * sign * angle, 1e-7, t);
    }
  }
}

// Planet of 12 teeth on the pin of an arm. It rolls on a fixed sun of 30: ω_planet = (1 + 30/12) ω_arm. The ground is
// the sun.
TEST(Gear, RollsAPlanetOnAFixedSun) {
  Plane model{};
  auto const arm = model.add(planar::Rigid(1.0, 0.3, Placement::planar(0.7, 0.0)), "arm");
  auto const planet = model.add(planar::Rigid(0.5, 0.1, Placement::planar(1.4, 0.0)), "planet");
  auto const ground = model.ground().at({0, 0, 0});
  model.connect(Pin{}, ground, arm.at({-0.7, 0}), "pin of the arm");
  model.connect(Pin{}, arm.at({0.7, 0}), planet.at({0, 0}), "pin of the planet");
  model.connect(Ideal<Gear>{{.teeth_a = 30, .teeth_b = 12, .centres = Vec3::UnitX()}, {}}, ground, planet.at({0, 0}),
                "gear");
  model.connect(motor, ground, arm.at({-0.7, 0}), "motor");
  State x = model.reference_state();
  for (double const t : {2.0, 4.5, 9.0}) {
    run_to(model, x, t);
    exact("closed forms", "speed of a planet on a fixed sun [rad/s]", "(1 + 30/12) ω of the arm", "Gear", x.v[5],
          3.5 * speed(t), 1e-7, t);
  }
  exact("closed forms", "angle of a planet on a fixed sun [rad]", "1 + 30/12 of the arm's", "Gear", x.q[5], 3.5 * 112.5,
        1e-6, 9.0);
}

// Ladder of 2 m from the wall x = 0 to the floor y = 0, constrained by two points on lines. The lower end is pushed
// to x = 1.2. The upper end moves from 2 to 1.6.
TEST(PointInPlane, HoldsALadderToWallAndFloor) {
  double const quarter = 0.5 * std::numbers::pi;
  SmoothRamp const push{.target = 1.2, .duration = 1.0};
  Plane model{Gravity{0, -g, 0}};
  auto const ladder = model.add(planar::Rigid(4.0, 4.0 / 3.0, Placement::planar(0.0, 1.0, quarter)), "ladder");
  auto const ground = model.ground().at({0, 0, 0});
  auto const head = ladder.at({1, 0}), foot = ladder.at({-1, 0});
  model.connect(Ideal<PointInPlane>{{.normal = Vec3::UnitX()}, {}}, ground, head, "wall");
  auto const floor = model.connect(Ideal<PointInPlane>{{.normal = Vec3::UnitY()}, {}}, ground, foot, "floor");
  auto const hand = model.connect(Hand{{.law = push, .axis = Vec3::UnitX()}, {}}, ground, foot, "hand");
  State x = model.reference_state();
  run_to(model, x, 2.0);
  within("closed forms", "head of a ladder pushed to the wall [m]", "√(2² − 1.2²)", "PointInPlane",
         (position(model, x, head) - Vec3(0, 1.6, 0)).norm(), 1e-9, 2.0, 1.6);
  within("closed forms", "foot of a ladder pushed to the wall [m]", "1.2", "PrescribedTranslation",
         (position(model, x, foot) - Vec3(1.2, 0, 0)).norm(), 1e-9, 2.0, 1.2);
  // at rest: the floor carries m g, and the force of the hand against the wall is m g · 0.6/1.6
  within("closed forms", "force of the floor on a ladder [N]", "m g", "PointInPlane",
         (reaction(model, x, floor).f - Vec3(0, 4.0 * g, 0)).norm(), 1e-7, 2.0, 4.0 * g);
  within("closed forms", "force of the hand on a ladder [N]", "m g · 0.6/1.6", "PrescribedTranslation",
         (reaction(model, x, hand).f + Vec3(4.0 * g * 0.375, 0, 0)).norm(), 1e-7, 2.0, 4.0 * g * 0.375);
}

}  // namespace joints_plane_test
