// Angles and translations of joints in a state, their rates, and full turns over a run.
#include <polybody/run/probe.hpp>

#include <gtest/gtest.h>

#include <numbers>
#include <polybody/bodies/ancf/ancf_cable.hpp>
#include <polybody/bodies/rigid/planar_rigid.hpp>
#include <polybody/bodies/rigid/rigid.hpp>
#include <polybody/integrators/runge_kutta.hpp>
#include <polybody/joints/driving_constraints.hpp>
#include <polybody/joints/planar/joints.hpp>
#include <polybody/joints/standard_joints.hpp>
#include <polybody/run/initial_conditions.hpp>
#include <polybody/run/marker_frames.hpp>
#include <polybody/run/simulate.hpp>

#include "support/refusal.hpp"

using namespace polybody;

namespace joint_position_test {

constexpr double pi = std::numbers::pi;

Mat3 inertia(double x, double y, double z) { return Vec3(x, y, z).asDiagonal(); }

/// Disk in the plane on a pin at its centre, with constant rate.
struct Disk {
  using Pin = Joint<planar::Revolute, Constraint>;
  Model<Bodies<planar::Rigid>, Joints<Pin>> model;
  BodyHandle<planar::Rigid> disk = model.add(planar::Rigid(2.0, 0.5, Placement::planar(0.2, 0.1, 0.4)), "disk");
  ElementHandle<Pin> pin = model.connect(Pin{}, model.ground().at({0.2, 0.1, 0}), disk.centre(), "pin");
  State x = model.reference_state();

  explicit Disk(double rate) {
    x.v[2] = rate;
    x.t = 0.0;
  }
};

// The reference configuration has the angle zero, also for a body that is placed at an angle.
TEST(JointAngle, OfARotatingDiskIsRateTimesTimeWithinHalfATurn) {
  for (double const rate : {3.0, -3.0}) {
    Disk d(rate);
    EXPECT_EQ(joint_angle(d.model, d.x, d.pin), 0.0);
    for (State const& now : simulate(d.model, d.x, RungeKutta4<Projection>{}, {.end_time = 4.0, .step = 0.05})) {
      double const angle = joint_angle(d.model, now, d.pin), off = angle - rate * now.t;
      EXPECT_NEAR(off, 2.0 * pi * std::nearbyint(off / (2.0 * pi)), 1e-9);
      EXPECT_LE(std::abs(angle), pi);
      EXPECT_NEAR(joint_angle_rate(d.model, now, d.pin), rate, 1e-12);
    }
  }
}

// Turns are counted in each step, and at constant rate also over several turns between states.
TEST(TurnCounter, CountsTurnsOfARotatingDisk) {
  for (double const rate : {30.0, -30.0})
    for (int const every : {1, 5, 70}) {
      Disk d(rate);
      TurnCounter turns(d.model, d.pin);
      int step = 0;
      for (State const& now : simulate(d.model, d.x, RungeKutta4<Projection>{}, {.end_time = 7.0, .step = 0.01})) {
        if (step++ % every != 0) continue;
        EXPECT_NEAR(turns.record(now), rate * now.t, 1e-8) << every;
        EXPECT_NEAR(turns.angle(), rate * now.t, 1e-8);
        EXPECT_NEAR(turns.rate(), rate, 1e-10);
      }
      EXPECT_NEAR(std::abs(turns.angle()) / (2.0 * pi), 33.4, 0.1) << every;
      EXPECT_NEAR(turns.start(d.x), joint_angle(d.model, d.x, d.pin), 0.0);
    }
}

TEST(TurnCounter, RefusesStatesOfThePastAndOtherModels) {
  Disk d(1.0), longer(1.0);
  TurnCounter turns(d.model, d.pin);
  State later = d.x;
  later.t = 1.0;
  turns.record(later);
  EXPECT_TRUE(has(refusal([&] { turns.record(d.x); }), "t = 0 s is earlier than the last one at t = 1 s"));
  EXPECT_NO_THROW(turns.start(d.x));
  longer.model.add(planar::Rigid(1.0, 1.0));
  EXPECT_TRUE(has(refusal([&] { turns.record(longer.model.reference_state()); }), "does not fit"));
  EXPECT_TRUE(has(refusal([&] { TurnCounter(longer.model, d.pin); }), "handle of another model"));
}

// Pendulum of a thin rod, released from the horizontal: θ̇² = 3 (g/l) sin of the fall.
TEST(JointAngle, AndRateOfAPendulumKeepTheEnergy) {
  double const l = 0.8, g = 9.81;
  using Pin = Joint<Revolute, Constraint>;
  Model<Bodies<Rigid<>>, Joints<Pin>> model{Gravity{0, 0, -g}};
  auto const rod =
      model.add(Rigid<>(1.5, inertia(1e-3, 1.5 * l * l / 12, 1.5 * l * l / 12), Placement::at({0.5 * l, 0, 0})), "rod");
  auto const pin =
      model.connect(Pin{Revolute{.axis = {0, 1, 0}}}, model.ground().at({0, 0, 0}), rod.at({-0.5 * l, 0, 0}), "pin");
  State x = model.reference_state();
  for (State const& now : simulate(model, x, RungeKutta4<Projection>{}, {.end_time = 0.6, .step = 1e-3})) {
    double const fall = joint_angle(model, now, pin), rate = joint_angle_rate(model, now, pin);
    EXPECT_NEAR(rate * rate, 3.0 * g / l * std::sin(fall), 1e-8);
    EXPECT_NEAR(position(model, now, rod.centre())[2], -0.5 * l * std::sin(fall), 1e-10);
  }
  EXPECT_GT(joint_angle(model, x, pin), 1.5);
}

// Nut on a thread and a cylindrical joint beside it: s = p θ over many turns.
TEST(JointTranslation, OfAScrewIsPitchTimesAngle) {
  using Thread = Joint<Screw, Constraint>;
  using Guide = Joint<Cylindrical, Constraint>;
  double const pitch = 0.02;
  Vec3 const axis = Vec3(1, 2, 2) / 3.0;
  Model<Bodies<Rigid<>>, Joints<Thread, Guide>> model;
  auto const nut = model.add(Rigid<>(1.0, inertia(0.1, 0.2, 0.3)), "nut");
  auto const thread =
      model.connect(Thread{Screw{.pitch = pitch, .axis = axis}}, model.ground().at({0, 0, 0}), nut.centre(), "thread");
  auto const guide =
      model.connect(Guide{Cylindrical{.axis = axis}}, model.ground().at({0, 0, 0}), nut.centre(), "guide");
  State x = model.reference_state();
  model.set_velocity(x, nut, 12.0 * pitch * axis, 12.0 * axis);
  TurnCounter turns(model, thread);
  for (State const& now : simulate(model, x, RungeKutta4<Projection>{}, {.end_time = 3.0, .step = 2e-3})) {
    double const angle = turns.record(now);
    EXPECT_NEAR(joint_translation(model, now, thread), pitch * angle, 1e-9);
    EXPECT_NEAR(joint_translation(model, now, guide), pitch * angle, 1e-9);
    EXPECT_NEAR(joint_translation_rate(model, now, guide), pitch * turns.rate(), 1e-10);
    EXPECT_NEAR(joint_angle(model, now, guide), joint_angle(model, now, thread), 1e-10);
  }
  EXPECT_GT(turns.angle(), 4.0 * pi);
}

// A slider on an arm that rotates: s = u·(r_b − r_a), and ṡ is its derivative.
TEST(JointTranslation, RateIsRelativeToTheRotatingArm) {
  using Slide = Joint<planar::Prismatic, Constraint>;
  Model<Bodies<planar::Rigid>, Joints<Slide>> model;
  auto const arm = model.add(planar::Rigid(1.0, 1.0), "arm"), block = model.add(planar::Rigid(1.0, 1.0), "block");
  auto const slide = model.connect(Slide{{.axis = {0.6, 0.8, 0}}, {}}, arm.at(Vec2(0.1, 0)), block.at(Vec2(0.1, 0)));
  State x = model.reference_state();
  auto const at = [&](double t) {  // arm at the angle 0.5 t, block at s(t) = 0.3 + 0.2 t² along it
    double const s = 0.3 + 0.2 * t * t, angle = 0.5 * t, rate = 0.5;
    Vec2 const u(0.6 * std::cos(angle) - 0.8 * std::sin(angle), 0.8 * std::cos(angle) + 0.6 * std::sin(angle)),
        n(-u[1], u[0]);
    x.q << 0, 0, angle, s * u[0], s * u[1], angle;
    x.v << 0, 0, rate, 0.4 * t * u[0] + s * rate * n[0], 0.4 * t * u[1] + s * rate * n[1], rate;
  };
  for (double const t : {0.0, 0.7, 2.0}) {
    at(t);
    EXPECT_NEAR(joint_translation(model, x, slide), 0.3 + 0.2 * t * t, 1e-14);
    EXPECT_NEAR(joint_translation_rate(model, x, slide), 0.4 * t, 1e-14);
  }
}

// Driving constraints measure the angle and the translation that they prescribe.
TEST(JointAngle, OfADriveIsItsFunctionOfTime) {
  auto const law = [](double t) { return Motion{0.3 * t + t * t, 0.3 + 2.0 * t, 2.0}; };
  using Pin = Joint<planar::Revolute, Constraint>;
  using Turn = Joint<PrescribedAngle<decltype(law)>, Constraint>;
  using Slide = Joint<PrescribedTranslation<decltype(law)>, Constraint>;
  Model<Bodies<planar::Rigid>, Joints<Pin, Turn, Slide>> model;
  auto const crank = model.add(planar::Rigid(1.0, 1.0), "crank"), cart = model.add(planar::Rigid(1.0, 1.0), "cart");
  auto const ground = model.ground().at({0, 0, 0});
  model.connect(Pin{}, ground, crank.centre(), "pin");
  auto const turn = model.connect(Turn{{.law = law}, {}}, ground, crank.centre(), "motor");
  auto const slide = model.connect(Slide{{.law = law, .axis = {1, 0, 0}}, {}}, ground, cart.centre(), "pusher");
  State x = model.reference_state();
  TurnCounter turns(model, turn);
  for (State const& now : simulate(model, x, RungeKutta4<Projection>{}, {.end_time = 4.0, .step = 0.01})) {
    Motion const m = law(now.t);
    EXPECT_NEAR(turns.record(now), m.value, 1e-9);
    EXPECT_NEAR(turns.rate(), m.rate, 1e-9);
    EXPECT_NEAR(joint_translation(model, now, slide), m.value, 1e-9);
    EXPECT_NEAR(joint_translation_rate(model, now, slide), m.rate, 1e-9);
  }
  EXPECT_GT(turns.angle(), 4.0 * pi);
}

// A cable provides only its tangent, so its rotation about a pin along it is not known. A universal joint permits two
// rotations.
TEST(JointAngle, RefusesJointsWithoutASingleAngle) {
  Bar const bar{
      .length = 1.0,
      .constants = BarConstants{.EA = 90, .EI = 4, .mass_per_length = 2.0, .GA = 30, .GJ = 3, .rotary_inertia = 0.05}};
  using Pin = Joint<Revolute, Constraint>;
  using Cross = Joint<Universal, Constraint>;
  Model<Bodies<AncfCable<>, Rigid<>>, Joints<Pin, Cross>> model;
  auto const cable = model.add(AncfCable<>::from(bar, 2), "cable");
  auto const end = model.add(Rigid<>(1.0, inertia(1, 1, 1)), "end");
  auto const pin = model.connect(Pin{Revolute{.axis = {1, 0, 0}}}, model.ground().at({0, 0, 0}), cable.at(0.0), "grip");
  auto const cross = model.connect(Cross{Universal{.first = {1, 0, 0}, .second = {0, 1, 0}}},
                                   model.ground().at({0, 0, 0}), end.centre(), "cross");
  State const x = model.reference_state();
  EXPECT_TRUE(has(refusal([&] { (void)joint_angle(model, x, pin); }), "\"grip\" has no angle"));
  EXPECT_TRUE(
      has(refusal([&] { (void)joint_angle(model, x, cross); }), "\"cross\" does not permit exactly one rotation"));
  EXPECT_TRUE(
      has(refusal([&] { (void)joint_translation(model, x, cross); }), "does not permit exactly one translation"));
}

}  // namespace joint_position_test
