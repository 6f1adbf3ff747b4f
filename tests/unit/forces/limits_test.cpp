// Stops, backlash and bump stops: law suites, and impacts with the restitution of the closed form.
#include <polybody/forces/limits.hpp>

#include <gtest/gtest.h>

#include <polybody/bodies/rigid/rigid.hpp>
#include <polybody/integrators/generalised_alpha.hpp>
#include <polybody/integrators/radau.hpp>
#include <polybody/joints/standard_joints.hpp>
#include <polybody/run/energy_audit.hpp>
#include <polybody/run/joint_position.hpp>
#include <polybody/run/probe.hpp>
#include <polybody/run/simulate.hpp>
#include <polybody/testing/force_laws.hpp>

#include "support/refusal.hpp"

namespace polybody {
using namespace laws;
namespace limits_test {

/// Cases of the law suite. The limits are narrow, so that random frames are beyond one of them.
struct LimitOnAngleCase {
  static auto force() { return JointLimit{{.lower = -0.01, .upper = 0.01, .stiffness = 80.0, .damping = 3.0}}; }
};
struct LimitOnTurnsCase {
  static auto force() { return TurnsLimit{{.upper = -9.0, .stiffness = 80.0, .damping = 3.0, .onset = 20.0}}; }
};
struct LimitOnTranslationCase {
  static auto force() { return SlideLimit{{.lower = -0.01, .upper = 0.01, .stiffness = 80.0}}; }
};
struct LimitOnDistanceCase {
  static auto force() { return EndStop{{.upper = 0.1, .stiffness = 80.0, .damping = 3.0}}; }
};
struct BacklashCase {
  static auto force() {
    return on_angle(Backlash{.play = 0.02, .centre = 0.01, .stiffness = 80.0, .damping = 3.0, .onset = 0.5});
  }
};
struct BumpStopCase {
  static auto force() {
    return on_translation(BumpStop{.lower = -0.01, .upper = 0.01, .stiffness = 80.0, .exponent = 2.5, .damping = 0.01});
  }
};
bool const forces_obey[] = {obeys<LimitOnAngleCase, ForceLaws>("LimitOnAngle"),
                            obeys<LimitOnTurnsCase, ForceLaws>("LimitOnTurns"),
                            obeys<LimitOnTranslationCase, ForceLaws>("LimitOnTranslation"),
                            obeys<LimitOnDistanceCase, ForceLaws>("LimitOnDistance"),
                            obeys<BacklashCase, ForceLaws>("Backlash"),
                            obeys<BumpStopCase, ForceLaws>("BumpStop")};

TEST(Limit, PushesOnlyBeyondItsLimits) {
  Limit const stop{.lower = -1.0, .upper = 2.0, .stiffness = 100.0, .damping = 5.0};
  auto const q = [&](double x, double rate) { return stop.force<double>(x, rate, 0.0); };
  EXPECT_EQ(q(1.9, 3.0), 0.0);
  EXPECT_NEAR(q(2.5, 3.0), -65.0, 1e-12);
  EXPECT_NEAR(q(2.5, -9.0), -5.0, 1e-12);
  EXPECT_EQ(q(2.5, -11.0), 0.0);  // 100 · 0.5 − 5 · 11 < 0
  EXPECT_NEAR(q(-1.5, -3.0), 65.0, 1e-12);
  EXPECT_EQ(q(-1.5, 11.0), 0.0);
  EXPECT_EQ((Limit{.upper = 2.0, .stiffness = 100.0}.force<double>(-1e9, 0.0, 0.0)), 0.0);
}

// The damping of a stop with an onset is proportional to the penetration up to the onset.
TEST(Limit, ForceBeginsAtZeroWithAnOnset) {
  Limit const stop{.upper = 0.0, .stiffness = 100.0, .damping = 5.0, .onset = 0.1};
  EXPECT_NEAR(stop.force<double>(1e-9, 7.0, 0.0), 0.0, 1e-5);
  EXPECT_NEAR(stop.force<double>(0.05, 4.0, 0.0), -(5.0 + 10.0), 1e-12);
  EXPECT_NEAR(stop.force<double>(0.2, 4.0, 0.0), -(20.0 + 20.0), 1e-12);
}

// MSL#2247: an elastic backlash with a damper pulled while it opened.
TEST(Backlash, NeverPulls) {
  Backlash const play{.play = 0.2, .centre = 0.3, .stiffness = 1e4, .damping = 500.0};
  Numbers number;
  for (int i = 0; i < 1000; ++i) {
    double const x = 0.3 + 0.3 * number(), q = play.force<double>(x, 30.0 * number(), 0.0);
    if (x > 0.4) {
      EXPECT_LE(q, 0.0);
    } else if (x < 0.2) {
      EXPECT_GE(q, 0.0);
    } else {
      EXPECT_EQ(q, 0.0);
    }
  }
}

/// Disc on a hinge without gravity that meets a stop at 0.107123 rad with 2 rad/s.
template <class Policy>
struct Disc {
  using Pin = Joint<Revolute, Policy>;
  Model<Bodies<Rigid<>>, Joints<Pin>, Forces<JointLimit>> model;
  BodyHandle<Rigid<>> body = model.add(Rigid<>(1.0, Mat3(Vec3(1, 1, 0.5).asDiagonal()), Placement{}), "disc");
  ElementHandle<Pin> pin;
  State x;
  explicit Disc(Limit const& stop, Policy const& policy = {})
      : pin(model.connect(Pin{Revolute{.axis = Vec3(0, 0, 1)}, policy}, model.ground().at({0, 0, 0}),
                          body.at(Vec3(0, 0, 0)), "pin")) {
    model.apply(JointLimit{stop}, pin, "stop");
    x = model.reference_state();
    model.set_velocity(x, body, Vec3::Zero(), Vec3(0, 0, 2.0));
  }
};

// J θ̈ + c θ̇ + k (θ − u) = 0 until the force is zero: the disc departs with e θ̇₀ [SpringDamperContact]. The error of a
// step of 1e-5 s is that of the times of contact and departure, h c/(2 J) θ̇₀.
template <class Policy>
void rebounds_with_its_restitution(Policy const& policy = {}) {
  for (double const e : {0.9, 0.5, 0.1}) {
    double const k = 1e3, c = SpringDamperContact::with_restitution(k, 0.5, e).damping;
    Disc<Policy> disc({.upper = 0.107123, .stiffness = k, .damping = c}, policy);
    simulate(disc.model, disc.x, GeneralisedAlpha{.rho_inf = 0.9}, {.end_time = 0.2, .step = 1e-5}).run();
    EXPECT_NEAR(joint_angle_rate(disc.model, disc.x, disc.pin), -2.0 * e, 2e-3) << e;
  }
}
TEST(Limit, ReboundsWithTheRestitutionOfItsDamping) {
  rebounds_with_its_restitution<Constraint>();
  rebounds_with_its_restitution<JointCoordinates>();
  rebounds_with_its_restitution<Penalty>({.stiffness = 1e6, .damping = 1e3});
}

// The disc meets the limit at the end of a step, up to 1e-13 rad beyond it. This step has no solution, since the
// damping force of a penetration moves the disc back. Halves of the step end at the same time; they become so short
// that the force moves the disc by less than Newton's tolerance. The error is that of the times of contact and
// departure.
TEST(Limit, IsMetAtTheEndOfAStep) {
  double const k = 1e3, e = 0.5, c = SpringDamperContact::with_restitution(k, 0.5, e).damping;
  for (double const h : {1e-3, 1e-4})
    for (double const beyond : {0.0, 1e-15, 1e-13, 1e-11, 1e-9, 1e-8}) {
      Disc<Constraint> disc({.upper = 0.1 - beyond, .stiffness = k, .damping = c});
      simulate(disc.model, disc.x, GeneralisedAlpha{.rho_inf = 0.9}, {.end_time = 0.2, .step = h}).run();
      EXPECT_NEAR(joint_angle_rate(disc.model, disc.x, disc.pin), -2.0 * e, 4.0 * h * c) << h << ' ' << beyond;
    }
}

// Without damping the disc penetrates by θ̇₀ √(J/k) and returns with −θ̇₀.
TEST(Limit, StoresTheEnergyOfTheImpact) {
  Disc<Constraint> disc({.upper = 0.1, .stiffness = 1e3});
  EnergyAudit audit(disc.model);
  double deepest = 0.0, most = 0.0;
  for (auto const& now : simulate(disc.model, disc.x, Radau{.tolerance = 1e-12}, {.end_time = 0.2, .step = 1e-4})) {
    audit.record(now);
    deepest = std::max(deepest, joint_angle(disc.model, State(now), disc.pin) - 0.1);
    most = std::max(most, audit.energy().forces);
  }
  EXPECT_NEAR(deepest, 2.0 * std::sqrt(0.5 / 1e3), 1e-6);
  EXPECT_NEAR(most, 1.0, 1e-4);
  EXPECT_LT(audit.relative(), 1e-6);
  EXPECT_NEAR(joint_angle_rate(disc.model, disc.x, disc.pin), -2.0, 1e-6);
}

TEST(Limit, RefusesWrongNumbers) {
  auto const message = [](Limit const& stop) { return refusal([&] { JointLimit{stop}.check("\"stop\""); }); };
  EXPECT_EQ(message({.stiffness = 1.0}),
            "\"stop\": the lower limit or the upper limit must be finite, but they are -inf and inf rad.");
  EXPECT_EQ(message({.lower = 0.3, .upper = 0.2, .stiffness = 1.0}),
            "\"stop\": the lower limit must be less than the upper limit of 0.2 rad, but is 0.3 rad.");
  EXPECT_EQ(message({.upper = 0.2, .stiffness = 0.0}),
            "\"stop\": the stiffness of the stop must be positive and finite, but is 0 N m/rad.");
  EXPECT_EQ(message({.upper = 0.2, .stiffness = 1.0, .damping = -1.0}),
            "\"stop\": the damping of the stop must be zero or positive, and finite, but is -1 N m s/rad.");
  EXPECT_EQ(message({.upper = 0.2, .stiffness = 1.0, .onset = -1.0}),
            "\"stop\": the onset of the damping must be zero or positive, and finite, but is -1 rad.");
  EXPECT_EQ(message({.upper = 4.0, .stiffness = 1.0}),
            "\"stop\": the upper limit of an angle without full turns must lie between -pi and pi, but is 4 rad. Use "
            "OnTurns for limits beyond half a turn.");
  TurnsLimit{{.upper = 4.0, .stiffness = 1.0}}.check("\"stop\"");
  SlideLimit{{.upper = 4.0, .stiffness = 1.0}}.check("\"stop\"");
}

TEST(Backlash, RefusesWrongNumbers) {
  auto const message = [](Backlash const& play) { return refusal([&] { on_angle(play).check("\"teeth\""); }); };
  EXPECT_EQ(message({.play = 0.0, .stiffness = 1.0}), "\"teeth\": the play must be positive and finite, but is 0 rad.");
  EXPECT_EQ(message({.play = 0.1, .centre = INFINITY, .stiffness = 1.0}),
            "\"teeth\": the centre of the play must be finite, but is inf rad.");
  EXPECT_TRUE(has(message({.play = 0.1, .stiffness = -1.0}), "the stiffness of the stop must be positive"));
}

TEST(BumpStop, RefusesWrongNumbers) {
  auto const message = [](BumpStop const& stop) { return refusal([&] { on_translation(stop).check("\"stop\""); }); };
  EXPECT_TRUE(has(message({.stiffness = 1.0}), "the lower limit or the upper limit must be finite"));
  EXPECT_EQ(message({.upper = 0.1, .stiffness = -1.0}),
            "\"stop\": the contact stiffness must be positive and finite, but is -1 N/m^n.");
  EXPECT_TRUE(has(message({.upper = 0.1, .stiffness = 1.0, .exponent = 0.5}), "the exponent"));
  EXPECT_TRUE(has(message({.upper = 0.1, .stiffness = 1.0, .damping = -1.0}), "the contact damping"));
  EXPECT_EQ(refusal([] { on_angle(BumpStop{.upper = 0.1, .stiffness = 0.0}).check("\"stop\""); }),
            "\"stop\": the contact stiffness must be positive and finite, but is 0 N m/rad^n.");
}

}  // namespace limits_test
}  // namespace polybody
