// Impact at the limit of a joint: jump of the velocities, momentum, restitution and rest.
#include <polybody/run/impact_at_limit.hpp>

#include <gtest/gtest.h>

#include <polybody/bodies/rigid/planar_rigid.hpp>
#include <polybody/bodies/rigid/rigid.hpp>
#include <polybody/forces/spring_laws.hpp>
#include <polybody/integrators/generalised_alpha.hpp>
#include <polybody/joints/driving_constraints.hpp>
#include <polybody/joints/planar/joints.hpp>
#include <polybody/joints/policies/elimination.hpp>
#include <polybody/joints/standard_joints.hpp>
#include <polybody/run/energy.hpp>
#include <polybody/run/probe.hpp>
#include <polybody/run/simulate.hpp>

#include "support/refusal.hpp"

namespace polybody::impact_at_limit_test {

double const g = 9.81;

/// Two free rods in space without gravity on a skew hinge, which rotates at −1.5 rad/s towards its lower limit.
struct FreeRods {
  using Pin = Joint<Revolute, Constraint>;
  Vec3 const axis = Vec3(1, 2, 2) / 3.0, offset = {0.5, -0.2, 0.1};
  Model<Bodies<Rigid<>>, Joints<Pin>> model;
  BodyHandle<Rigid<>> a = model.add(Rigid<>(2.0, Mat3(Vec3(0.1, 0.2, 0.25).asDiagonal()), Placement{}), "a");
  BodyHandle<Rigid<>> b =
      model.add(Rigid<>(1.0, Mat3(Vec3(0.3, 0.1, 0.35).asDiagonal()), Placement::at(2.0 * offset)), "b");
  ElementHandle<Pin> pin = model.connect(Pin{Revolute{.axis = axis}}, a.at(offset), b.at(Vec3(-offset)), "pin");
  State x = model.reference_state();
  FreeRods() {
    Vec3 const of_a(0.3, -0.4, 0.2), v_a(1, 2, 3), of_b = of_a - 1.5 * axis;
    model.set_velocity(x, a, v_a, of_a);
    Vec3 const at_pin = v_a + of_a.cross(offset);
    model.set_velocity(x, b, at_pin - of_b.cross(offset), of_b);
  }
  Frame<double> frame_of(BodyHandle<Rigid<>> const& body) const { return frame(model, x, body.at(Vec3(0, 0, 0))); }
  Vec3 angular_momentum(BodyHandle<Rigid<>> const& body, Vec3 const& inertia) const {
    Frame<double> const f = frame_of(body);
    return f.A * inertia.asDiagonal() * f.A.transpose() * f.w;
  }
};

// The impulse acts between the rods only. With the moment I of the impulse about the axis and the impulse P of the pin,
// the rod b obeys m Δv = P and J Δω = I a + (r_pin − r_b) × P; the energy changes by ½ I (ẋ⁻ + ẋ⁺).
TEST(ImpactAtLimit, ConservesTheMomentumOfFreeBodies) {
  FreeRods rods;
  Event const impact = impact_at_limit(rods.model, rods.pin, {.lower = 0.0, .restitution = 0.4});
  Vec3 const ja(0.1, 0.2, 0.25), jb(0.3, 0.1, 0.35);
  auto const momentum = [&] { return Vec3(2.0 * rods.frame_of(rods.a).v + rods.frame_of(rods.b).v); };
  auto const turning = [&] {
    Frame<double> const fa = rods.frame_of(rods.a), fb = rods.frame_of(rods.b);
    return Vec3(rods.angular_momentum(rods.a, ja) + rods.angular_momentum(rods.b, jb) + fa.r.cross(2.0 * fa.v) +
                fb.r.cross(fb.v));
  };
  Vec3 const p = momentum(), l = turning(), own = rods.angular_momentum(rods.b, jb), v = rods.frame_of(rods.b).v;
  double const kinetic = energy(rods.model, rods.x).kinetic;
  EXPECT_EQ(impact.value(rods.x), 0.0);
  impact.action(rods.x);
  EXPECT_NEAR(joint_angle_rate(rods.model, rods.x, rods.pin), 0.6, 1e-13);
  EXPECT_LT((momentum() - p).norm(), 1e-13);
  EXPECT_LT((turning() - l).norm(), 1e-13);
  Vec3 const of_pin = rods.frame_of(rods.b).v - v;  // P with m = 1 kg
  Vec3 const moment = rods.angular_momentum(rods.b, jb) - own + rods.offset.cross(of_pin);
  double const along = moment.dot(rods.axis);
  EXPECT_GT(along, 0.1);
  EXPECT_NEAR(energy(rods.model, rods.x).kinetic - kinetic, 0.5 * along * (0.6 - 1.5), 1e-13);
  System system(rods.model, with<Capabilities::motion>);
  system.evaluate(rods.x.q, rods.x.v, 0.0);
  VecX rate(system.rows());
  system.violation_rate(rate);
  EXPECT_LT(rate.norm(), 1e-13);
}

TEST(ImpactAtLimit, DoesNotPullAtADepartingJoint) {
  FreeRods rods;
  Event const impact = impact_at_limit(rods.model, rods.pin, {.upper = 0.0, .restitution = 0.4});
  VecX const before = rods.x.v;
  impact.action(rods.x);
  EXPECT_EQ(rods.x.v, before);
}

/// Rod that falls from the horizontal against a stop in its lowest position, on a hinge at its end.
template <class Policy>
struct Pendulum {
  using Pin = Joint<planar::Revolute, Policy>;
  Model<Bodies<planar::Rigid>, Joints<Pin>> model{Gravity{0, -g, 0}};
  BodyHandle<planar::Rigid> rod = model.add(
      planar::Rigid::from({.length = 1.0, .constants = BarConstants{.EA = 1.0, .EI = 1.0, .mass_per_length = 1.0}}),
      "rod");
  ElementHandle<Pin> pin = model.connect(Pin{}, model.ground().at({0, 0, 0}), rod.at(0.0), "pin");
};

// Each impact keeps e² of the energy: the height of the centre above its lowest position is e²ⁿ h after n impacts.
template <class Policy>
void keeps_its_restitution() {
  Pendulum<Policy> p;
  State x = p.model.reference_state();
  Event const stop = impact_at_limit(p.model, p.pin, {.lower = -0.5 * std::numbers::pi, .restitution = 0.8});
  std::vector<double> tops;
  double before = 0.0, last = 0.0;
  auto run = simulate(p.model, x, GeneralisedAlpha{.rho_inf = 1.0}, {.end_time = 4.5, .step = 5e-4, .events = {stop}});
  for (State const& now : run) {
    double const height = position(p.model, now, p.rod.at(0.5))[1] + 0.5;
    if (last > before && last >= height) tops.push_back(last);
    before = std::exchange(last, height);
  }
  ASSERT_GE(tops.size(), 4u);  // the first is the start
  for (std::size_t n = 0; n < 4; ++n) EXPECT_NEAR(tops[n], 0.5 * std::pow(0.64, double(n)), 2e-6) << n;
  EXPECT_EQ(run.report().events.front().name, "impact at a limit of \"pin\"");
}
TEST(ImpactAtLimit, KeepsItsRestitution) {
  keeps_its_restitution<Constraint>();
  keeps_its_restitution<JointCoordinates>();
}

// A block falls 1 m along a vertical guide to its limit: the impacts accumulate at √(2 h/g) (1 + e)/(1 − e), 1.355 s
// for e = 0.5. The block then rests.
TEST(ImpactAtLimit, ComesToRestOnASlide) {
  using Slide = Joint<planar::Prismatic, Constraint>;
  Model<Bodies<planar::Rigid>, Joints<Slide>> model{Gravity{0, -g, 0}};
  auto const block = model.add(planar::Rigid(2.0, 1.0, Placement::planar(0, 3.0)), "block");
  auto const slide =
      model.connect(Slide{{.axis = Vec3(0, 1, 0)}}, model.ground().at({0, 0, 0}), block.at(Vec2(0, 0)), "slide");
  State x = model.reference_state();
  Event const stop = impact_at_limit(model, slide, {.lower = 2.0, .upper = 4.0, .restitution = 0.5});
  auto run = simulate(model, x, GeneralisedAlpha{}, {.end_time = 1.6, .step = 1e-2, .events = {stop}});
  run.run();
  auto const& met = run.report().events;
  EXPECT_NEAR(met.front().time, std::sqrt(2.0 / g), 1e-9);
  EXPECT_NEAR(met.back().time, 3.0 * std::sqrt(2.0 / g), 1e-6);
  EXPECT_NEAR(joint_translation(model, x, slide), 2.0, 1e-9);
  EXPECT_NEAR(joint_translation_rate(model, x, slide), 0.0, 1e-9);
}

using String = OnDistance<LinearSpring>;  // a law without force
String const no_force{{.stiffness = 0.0}};

// Two free bodies on a string that becomes taut. With the line n, and the arm r of the point on body a, the impulse is
// P = (1 + e) ẋ/(1/m_a + 1/m_b + |r × n|²/J_a), along the line only.
TEST(ImpactAtLimit, OfADistanceHasTheImpulseOfTheClosedForm) {
  double const ma = 2.0, mb = 3.0, ja = 0.05, e = 0.6;
  Model<Bodies<Rigid<>>, Joints<>, Forces<String>> model;
  auto const a = model.add(Rigid<>(ma, Mat3(Mat3::Identity() * ja)), "a");
  auto const b = model.add(Rigid<>(mb, Mat3(Mat3::Identity()), Placement::at({0.6, 0.9, 0.4})), "b");
  Vec3 const arm(0, 0.1, 0.2), line = Vec3(0.6, 0.8, 0.2), n = line.normalized();
  auto const string = model.apply(no_force, a.at(arm), b.at(Vec3(0, 0, 0)), "string");
  Event const taut = impact_at_limit(model, string, {.upper = line.norm(), .restitution = e});
  EXPECT_EQ(taut.name, "impact at a limit of \"string\"");
  State x = model.reference_state();
  Vec3 const va(0.1, -0.2, 0.3), wa(1, -2, 0.5), vb(1.5, 0.7, -0.4);
  model.set_velocity(x, a, va, wa);
  model.set_velocity(x, b, vb, Vec3::Zero());
  double const rate = n.dot(vb - va - wa.cross(arm));
  ASSERT_GT(rate, 0.5);
  EXPECT_NEAR(taut.value(x), 0.0, 1e-15);
  taut.action(x);
  Vec3 const p = (1.0 + e) * rate / (1.0 / ma + 1.0 / mb + arm.cross(n).squaredNorm() / ja) * n;  // on a
  Frame<double> const fa = frame(model, x, a.at(Vec3(0, 0, 0))), fb = frame(model, x, b.at(Vec3(0, 0, 0)));
  EXPECT_LT((fa.v - va - p / ma).norm(), 1e-13);
  EXPECT_LT((fa.w - wa - arm.cross(p) / ja).norm(), 1e-13);
  EXPECT_LT((fb.v - vb + p / mb).norm(), 1e-13);
  EXPECT_LT(fb.w.norm(), 1e-13);
  EXPECT_NEAR(n.dot(fb.v - fa.v - fa.w.cross(arm)), -e * rate, 1e-13);
  VecX const before = x.v;
  taut.action(x);  // departs
  EXPECT_EQ(x.v, before);
}

// A weight falls 0.8 m until its string of 1 m is taut, and bounces: impacts at √(2 h/g), rest at 3 times this time.
TEST(ImpactAtLimit, OfADistanceComesToRest) {
  Model<Bodies<Rigid<>>, Joints<>, Forces<String>> model{Gravity{0, 0, -g}};
  auto const weight = model.add(Rigid<>(2.0, Mat3(Mat3::Identity()), Placement::at({0, 0, -0.2})), "weight");
  auto const string = model.apply(no_force, model.ground().at({0, 0, 0}), weight.at(Vec3(0, 0, 0)), "string");
  State x = model.reference_state();
  Event const taut = impact_at_limit(model, string, {.upper = 1.0, .restitution = 0.5});
  auto run = simulate(model, x, GeneralisedAlpha{}, {.end_time = 1.6, .step = 1e-2, .events = {taut}});
  run.run();
  auto const& met = run.report().events;
  EXPECT_NEAR(met.front().time, std::sqrt(1.6 / g), 1e-9);
  EXPECT_NEAR(met.back().time, 3.0 * std::sqrt(1.6 / g), 1e-6);
  EXPECT_NEAR(position(model, x, weight.at(Vec3(0, 0, 0)))[2], -1.0, 1e-9);
  EXPECT_EQ(refusal([&] { (void)impact_at_limit(model, string, {.upper = 1.0, .restitution = -0.1}); }),
            "\"string\": the coefficient of restitution must lie in [0, 1], but is -0.1.");
}

TEST(ImpactAtLimit, RefusesWrongNumbers) {
  Pendulum<Constraint> p, other;
  auto const message = [&](LimitImpact const& limit) {
    return refusal([&] { (void)impact_at_limit(p.model, p.pin, limit); });
  };
  EXPECT_EQ(message({.upper = 0.1, .restitution = 1.2}),
            "\"pin\": the coefficient of restitution must lie in [0, 1], but is 1.2.");
  EXPECT_EQ(message({.lower = 0.2, .upper = 0.1, .restitution = 1.0}),
            "\"pin\": the lower limit must be less than the upper limit, and one of them finite, but they are 0.2 and "
            "0.1 rad.");
  EXPECT_TRUE(has(message({.restitution = 1.0}), "-inf and inf rad"));
  EXPECT_TRUE(has(message({.upper = 4.0, .restitution = 1.0}), "must lie between -pi and pi"));
  EXPECT_TRUE(has(refusal([&] { (void)impact_at_limit(p.model, other.pin, {.upper = 0.1, .restitution = 1.0}); }),
                  "another model"));
}

// A driven hinge has no velocity that an impulse can change.
TEST(ImpactAtLimit, RefusesAPrescribedMotion) {
  using Pin = Joint<planar::Revolute, Constraint>;
  using Drive = Joint<PrescribedAngle<Ramp>, Constraint>;
  Model<Bodies<planar::Rigid>, Joints<Pin, Drive>> model;
  auto const rod = model.add(planar::Rigid(1.0, 1.0, Placement{}), "rod");
  auto const ground = model.ground().at({0, 0, 0});
  auto const pin = model.connect(Pin{}, ground, rod.at(Vec2(0, 0)), "pin");
  model.connect(Drive{{.law = {.target = 1.0, .duration = 1.0}}}, ground, rod.at(Vec2(0, 0)), "drive");
  State x = model.reference_state();
  EXPECT_TRUE(has(refusal([&] {
                    simulate(model, x, GeneralisedAlpha{},
                             {.end_time = 1.0,
                              .step = 1e-2,
                              .events = {impact_at_limit(model, pin, {.upper = 0.505, .restitution = 1.0})}})
                        .run();
                  }),
                  "joint \"pin\" cannot rebound from its limit"));
}

}  // namespace polybody::impact_at_limit_test
