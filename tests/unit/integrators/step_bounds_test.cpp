// Bounds on converged but wrong steps: open joints, and energy without the work of a force. Motions whose energy
// grows by work are accepted.
#include <gtest/gtest.h>

#include <polybody/bodies/ffr/planar_ffr.hpp>
#include <polybody/bodies/rigid/planar_rigid.hpp>
#include <polybody/bodies/rigid/rigid.hpp>
#include <polybody/forces/springs.hpp>
#include <polybody/forces/user_force.hpp>
#include <polybody/integrators/energy_momentum.hpp>
#include <polybody/integrators/generalised_alpha.hpp>
#include <polybody/integrators/runge_kutta.hpp>
#include <polybody/integrators/symplectic.hpp>
#include <polybody/joints/driving_constraints.hpp>
#include <polybody/joints/joint.hpp>
#include <polybody/joints/planar/joints.hpp>
#include <polybody/joints/policies/elimination.hpp>
#include <polybody/joints/policies/penalty.hpp>
#include <polybody/joints/standard_joints.hpp>
#include <polybody/run/probe.hpp>
#include <polybody/run/simulate.hpp>
#include <polybody/system/model.hpp>

#include "support/refusal.hpp"

namespace polybody {
namespace step_bounds_test {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr PlausibilityLimits off{infinity, infinity};

Bar round_bar(double length, double radius, double young, Placement const& placement = {}) {
  return {.length = length,
          .section = Circle{.radius = radius},
          .material = Material{.density = 7800.0, .young = young},
          .placement = placement};
}

void expect_same(State const& a, State const& b) {
  EXPECT_EQ(a.q, b.q);
  EXPECT_EQ(a.v, b.v);
  EXPECT_EQ(a.a, b.a);
  EXPECT_EQ(a.lambda, b.lambda);
  EXPECT_EQ(a.history, b.history);
  EXPECT_EQ(a.t, b.t);
}

/// Runs until a step throws Diverged, which must leave the state unchanged. Returns the message.
template <class Run>
std::string message_of_divergence(Run&& run, State const& x) {
  State before = x;
  std::string const message = message_of<Diverged>([&] {
    while (!run.done()) {
      before = x;
      run.advance();
    }
  });
  expect_same(x, before);
  return message;
}

/// A steel rod on a pin of stiffness 1e16, released from the horizontal: ω h is about 1e6 at h = 0.01 s.
struct StiffPendulum {
  using Pin = Joint<Revolute, Penalty>;
  Model<Bodies<Rigid<>>, Joints<Pin>> model{Gravity{0, 0, -9.81}};
  State x;

  StiffPendulum() {
    auto const rod = model.add(Rigid<>::from(round_bar(1.0, 0.01, 2e11)), "rod");
    model.connect(Pin{Revolute{.axis = {0, 1, 0}}, Penalty{.stiffness = 1e16, .damping = 0.0}},
                  model.ground().at({0, 0, 0}), rod.at(0.0), "pin");
    x = model.reference_state();
  }
};

// The course of a divergence depends on round-off: the run may fail to converge first. These two runs name their
// solver because their tangents are not symmetric.
TEST(PlausibilityCheck, EnergyThatNoWorkExplainsEndsTheRun) {
  StiffPendulum wild, p;
  try {
    simulate<BlockSolver>(wild.model, wild.x, GeneralisedAlpha{}, {.end_time = 0.4, .step = 0.01, .limits = off}).run();
  } catch (NewtonConvergenceFailure const&) {
  }
  EXPECT_GT(energy(wild.model, wild.x).total(), 1e6);  // a fall of 1 m gives 12 J
  auto run =
      simulate<BlockSolver>(p.model, p.x, GeneralisedAlpha{}, {.end_time = 0.4, .step = 0.01, .max_step_halvings = 0});
  std::string const message = message_of_divergence(run, p.x);
  EXPECT_TRUE(has(message, "The step to t = 0."));
  EXPECT_TRUE(has(message, "body \"rod\" moves fastest"));
  EXPECT_TRUE(has(message, "Take a smaller step"));
  EXPECT_TRUE(has(message, "limits.energy"));
  EXPECT_LT(energy(p.model, p.x).total(), 1e4);
}

/// Two cranks at 60 rad/s and a soft coupler, like rubber, that buckles. Its frame is unsuitable for pins at both ends.
struct BucklingCoupler {
  using Pin = Joint<planar::Revolute, Constraint>;
  Model<Bodies<planar::Rigid, planar::Ffr>, Joints<Pin>> model{Gravity{0, -9.81, 0}};
  State x;

  BucklingCoupler() {
    double const up = 0.5 * std::numbers::pi, length = 0.3, omega = 60.0;
    auto const crank = [&](double at, char const* name) {
      return model.add(planar::Rigid::from(round_bar(length, 0.01, 2e11, Placement::planar(at, 0, up))), name);
    };
    auto const left = crank(0.0, "left crank"), right = crank(1.0, "right crank");
    auto const coupler = model.add(planar::Ffr::from(round_bar(1.0, 0.005, 2e9, Placement::planar(0, length)), 4,
                                                     {.frame = FfrFrame::clamped, .stiffening = false}),
                                   "coupler");
    model.connect(Pin{}, model.ground().at({0, 0, 0}), left.at(0.0), "left bearing");
    model.connect(Pin{}, model.ground().at({1, 0, 0}), right.at(0.0), "right bearing");
    model.connect(Pin{}, left.at(length), coupler.at(0.0), "left pin");
    model.connect(Pin{}, right.at(length), coupler.at(1.0), "right pin");
    x = model.reference_state();
    for (auto const& body : {left, right}) model.set_velocity(x, body, {0, 0, 0}, {0, 0, -omega});
    model.set_velocity(x, coupler, {length * omega, 0, 0}, {0, 0, 0});
  }
};

// The tolerance is 1 m/s² plus a share of the accelerations, so constraint equations may remain violated. Their
// correction in the next step increases the violation further.
TEST(PlausibilityCheck, AnOpenJointEndsTheRun) {
  BucklingCoupler wild, m;
  GeneralisedAlpha const loose{.tolerance = 1.0};
  System system(wild.model, with<Capabilities::motion>);
  double most = 0.0;
  try {
    for (State const& now :
         simulate<BlockSolver>(wild.model, wild.x, loose, {.end_time = 2.0, .step = 3e-3, .limits = off}))
      most = std::max(most, largest_violation(system, now).position);
  } catch (Error const&) {
  }
  EXPECT_GT(most, 10.0);  // larger than the distance of the pins, 1 m
  auto run = simulate<BlockSolver>(m.model, m.x, loose, {.end_time = 2.0, .step = 3e-3, .max_step_halvings = 0});
  std::string const message = message_of_divergence(run, m.x);
  EXPECT_TRUE(has(message, "violates the constraint equations of joint \""));
  EXPECT_TRUE(has(message, "\" by "));
  EXPECT_TRUE(has(message, "limits.violation"));
  EXPECT_LT(largest_violation(system, m.x).position, 0.1);
}

/// A wheel on a bearing, at rest.
template <class... Drives>
struct Wheel {
  using Pin = Joint<planar::Revolute, Constraint>;
  Model<Bodies<planar::Rigid>, Joints<Pin, Drives...>> model;
  BodyHandle<planar::Rigid> wheel = model.add(planar::Rigid(1.0, 1.0), "wheel");
  Wheel() { model.connect(Pin{}, model.ground().at({0, 0, 0}), wheel.at(Vec2(0, 0)), "bearing"); }
};

struct Uniform {
  Motion operator()(double t) const { return {5.0 * t * t, 10.0 * t, 10.0}; }
};

template <class I>
void expect_spun_up(I const& integrator) {
  using Drive = Joint<PrescribedAngle<Uniform>, Constraint>;
  Wheel<Drive> w;
  w.model.connect(Drive{{Uniform{}}, {}}, w.model.ground().at({0, 0, 0}), w.wheel.at(Vec2(0, 0)), "drive");
  State x = w.model.reference_state();
  simulate(w.model, x, integrator, {.end_time = 10.0, .step = 0.01}).run();
  EXPECT_NEAR(x.v[2], 100.0, 1e-6);
}

// The energy rises from zero to 5 kJ by the work of the driving constraint.
TEST(PlausibilityCheck, ADriveExplainsEnergy) {
  expect_spun_up(GeneralisedAlpha{});
  expect_spun_up(RungeKutta4<Projection>{});
  expect_spun_up(EnergyMomentum{});
}

// θ¨ = θ˙ from θ˙ = 1e-3: the work of the force multiplies the kinetic energy by e²⁰.
TEST(PlausibilityCheck, AForceWithoutPotentialExplainsEnergy) {
  auto const push = user_force<1>([](auto const& frames, double) {
    using T = std::decay_t<decltype(frames[0].r[0])>;
    Wrench<T> w;
    w.m[2] = frames[0].w[2];
    return std::array{w};
  });
  Model<Bodies<planar::Rigid>, Joints<>, Forces<std::remove_const_t<decltype(push)>>> model;
  auto const wheel = model.add(planar::Rigid(1.0, 1.0), "wheel");
  model.apply(push, wheel.at(Vec2(0, 0)), "push");
  State x = model.reference_state();
  x.v[2] = 1e-3;
  simulate(model, x, GeneralisedAlpha{}, {.end_time = 10.0, .step = 0.01}).run();
  EXPECT_NEAR(x.v[2], 1e-3 * std::exp(10.0), 3e-3);  // the relative error of the method is h² t/12 = 8e-5
}

// A spring that is stretched at the start transfers ½ k (1 m)² = 50 J to a mass at rest.
TEST(PlausibilityCheck, WhatASpringHeldExplainsEnergy) {
  Model<Bodies<planar::Rigid>, Joints<>, Forces<SpringDamper>> model;
  auto const mass = model.add(planar::Rigid(1.0, 1.0, Placement::planar(2.0, 0.0)), "mass");
  model.apply(SpringDamper{.stiffness = 100.0, .damping = 0.0, .free_length = 1.0}, model.ground().at({0, 0, 0}),
              mass.at(Vec2(0, 0)), "spring");
  State x = model.reference_state();
  // a quarter of a period: ω = 10
  simulate(model, x, RungeKutta4<>{}, {.end_time = 0.05 * std::numbers::pi, .step = 1e-3}).run();
  EXPECT_NEAR(x.v[0], -10.0, 1e-6);
}

/// A spring to a point that moves along x: its potential depends on time, and the moving point does work.
struct Tow {
  static constexpr int markers = 1;
  static constexpr bool is_load = false;
  static constexpr MarkerKind needs = MarkerKind::point;
  double stiffness = 100.0, speed = 2.0;

  void check(std::string const&) const {}
  template <class T>
  std::array<Wrench<T>, 1> wrenches(std::array<Frame<T>, 1> const& at, double t) const {
    Wrench<T> w;
    w.f[0] = (speed * t - at[0].r[0]) * stiffness;
    return {w};
  }
  double potential(std::array<Frame<double>, 1> const& at, double t) const {
    return 0.5 * stiffness * (speed * t - at[0].r[0]) * (speed * t - at[0].r[0]);
  }
};
TEST(PlausibilityCheck, APotentialThatDependsOnTimeIsNotJudged) {
  Model<Bodies<planar::Rigid>, Joints<>, Forces<Tow>> model;
  auto const mass = model.add(planar::Rigid(1.0, 1.0), "mass");
  model.apply(Tow{}, mass.at(Vec2(0, 0)), "tow");
  State x = model.reference_state();
  simulate(model, x, RungeKutta4<>{}, {.end_time = 0.1 * std::numbers::pi, .step = 1e-3}).run();
  EXPECT_NEAR(x.v[0], 4.0, 1e-6);  // x = u (t − sin ωt/ω), ω = 10, after half a period
}

/// Force along x that has no potential, or does not report its potential.
struct Push {
  static constexpr int markers = 1;
  static constexpr bool is_load = true;
  static constexpr MarkerKind needs = MarkerKind::point;
  double const* force = nullptr;

  void check(std::string const&) const {}
  template <class T>
  std::array<Wrench<T>, 1> wrenches(std::array<Frame<T>, 1> const&, double) const {
    Wrench<T> w;
    w.f[0] = T(*force);
    return {w};
  }
};
struct SecretPush : Push {
  static constexpr bool is_load = false;
  double potential(std::array<Frame<double>, 1> const&, double) const { return 0.0; }
};

// An event refuses a step with 1e18 J of work. This work must not justify a later energy gain of 100 kJ without work.
TEST(PlausibilityCheck, AStepThatFailsExplainsNoEnergy) {
  double push = 0.0, secret = 0.0;
  Model<Bodies<planar::Rigid>, Joints<>, Forces<Push, SecretPush>> model;
  auto const mass = model.add(planar::Rigid(1.0, 1.0), "mass");
  model.apply(Push{.force = &push}, mass.at(Vec2(0, 0)), "push");
  model.apply(SecretPush{{.force = &secret}}, mass.at(Vec2(0, 0)), "secret");
  State x = model.reference_state();
  x.v[0] = 1.0;
  Event const refusing{.name = "refusing", .value = [&](State const&) -> double {
                         if (push != 0.0) throw InvalidInput("no such push");
                         return 1.0;
                       }};
  auto run = simulate(model, x, RungeKutta4<>{}, {.end_time = 1.0, .step = 1e-3, .events = {refusing}});
  run.advance();
  push = 1e12;
  State const before = x;
  EXPECT_EQ(message_of<InvalidInput>([&] { run.advance(); }), "no such push");
  expect_same(x, before);
  push = 0.0;
  secret = 1e3;
  EXPECT_TRUE(has(message_of_divergence(run, x), "body \"mass\" moves fastest"));
  EXPECT_LT(x.v[0], 50.0);
}

// A force on a fixed body is NaN for one step and appears in the reaction only. Later steps are judged independently
// of it: a spring transfers 50 J to a mass at rest.
TEST(PlausibilityCheck, AForceThatIsNaNInAStepThatFailsIsForgotten) {
  using Held = Joint<Weld, JointCoordinates>;
  double push = 0.0;
  Model<Bodies<Rigid<>>, Joints<Held>, Forces<SpringDamper, Push>> model;
  Mat3 const inertia = Mat3::Identity();
  auto const held = model.add(Rigid<>(1.0, inertia), "held");
  auto const mass = model.add(Rigid<>(1.0, inertia, {.origin = {2, 0, 0}}), "mass");
  model.connect(Held{}, model.ground().at({0, 0, 0}), held.at({0, 0, 0}), "weld");
  model.apply(SpringDamper{.stiffness = 1e4, .damping = 0.0, .free_length = 1.0}, model.ground().at({0, 0, 0}),
              mass.at({0, 0, 0}), "spring");
  model.apply(Push{.force = &push}, held.at({0, 0, 0}), "push");
  State x = model.reference_state();
  auto run = simulate(model, x, RungeKutta4<>{}, {.end_time = 0.015, .step = 1e-3});
  push = std::numeric_limits<double>::quiet_NaN();
  State const before = x;
  EXPECT_TRUE(has(message_of<NonFiniteValue>([&] { run.advance(); }), "The reaction of joint \"weld\" is not finite"));
  expect_same(x, before);
  push = 0.0;
  run.run();
  EXPECT_NEAR(x.v.minCoeff(), -100.0 * std::sin(1.5), 1e-3);  // ω = 100 1/s
}

/// −k (x − 1 m) − d ẋ along x, without a potential.
auto spring_of_a_user(double k, double d) {
  return user_force<1>([k, d](auto const& frames, double) {
    using T = std::decay_t<decltype(frames[0].r[0])>;
    Wrench<T> w;
    w.f[0] = (frames[0].r[0] - T(1.0)) * -k - frames[0].v[0] * d;
    return std::array{w};
  });
}
template <class I>
void expect_refused(I const& integrator, double k, double d, double h) {
  auto const force = spring_of_a_user(k, d);
  Model<Bodies<planar::Rigid>, Joints<>, Forces<std::remove_const_t<decltype(force)>>> model;
  auto const mass = model.add(planar::Rigid(1.0, 0.1, Placement::planar(1.001, 0.0)), "mass");
  model.apply(force, mass.at(Vec2(0, 0)), "spring");
  State x = model.reference_state();
  auto run = simulate(model, x, integrator, {.end_time = 0.3, .step = h});
  EXPECT_TRUE(has(message_of_divergence(run, x), "body \"mass\" moves fastest")) << I::name << k << ' ' << d;
  EXPECT_NEAR(x.q[0], 1.0, 0.01) << I::name;
}
// A force without a potential does not justify the divergence that it drives.
TEST(PlausibilityCheck, AUserForceBeyondTheStabilityLimitIsRefused) {
  expect_refused(RungeKutta4<>{}, 1e6, 0.0, 1e-2);
  expect_refused(RungeKutta4<>{}, 1e6, 0.0, 2.9e-3);
  expect_refused(RungeKutta4<>{}, 1e4, 1e3, 1e-2);
  expect_refused(CentralDifference<>{}, 1e6, 0.0, 1e-2);
  expect_refused(SymplecticEuler{}, 1e6, 0.0, 1e-2);
}

// Constant torque on a rotor that rotates by more than half a turn per step: the quadrature counts whole turns.
TEST(PlausibilityCheck, ATorqueExplainsEnergyAtManyTurnsAStep) {
  auto const drive = user_force<1>([](auto const& frames, double) {
    using T = std::decay_t<decltype(frames[0].r[0])>;
    Wrench<T> w;
    w.m[2] = T(10.0);
    return std::array{w};
  });
  Model<Bodies<planar::Rigid>, Joints<>, Forces<std::remove_const_t<decltype(drive)>>> model;
  auto const rotor = model.add(planar::Rigid(1.0, 1.0), "rotor");
  model.apply(drive, rotor.at(Vec2(0, 0)), "torque");
  State x = model.reference_state();
  RunReport const report = simulate(model, x, RungeKutta4<>{}, {.end_time = 100.0, .step = 0.1}).run();
  EXPECT_NEAR(x.v[2], 1000.0, 1e-6);
  EXPECT_TRUE(report.warnings.empty()) << report.warnings.front();
}

// A force that oscillates ten times per second and a force that is switched every 0.05 s, with coarse and fine steps.
TEST(PlausibilityCheck, ForcesOfTimeAreNeitherRefusedNorWarnedOf) {
  for (bool const switched : {false, true})
    for (double const h : {1e-2, 1e-3}) {
      auto const shake = user_force<1>([switched](auto const& frames, double t) {
        using T = std::decay_t<decltype(frames[0].r[0])>;
        double const wave = std::sin(20.0 * std::numbers::pi * t);
        Wrench<T> w;
        w.f[0] = T(switched ? (wave < 0.0 ? -10.0 : 10.0) : 10.0 * wave) - frames[0].v[0] * 0.5;
        return std::array{w};
      });
      Model<Bodies<planar::Rigid>, Joints<>, Forces<std::remove_const_t<decltype(shake)>>> model;
      auto const mass = model.add(planar::Rigid(1.0, 1.0), "mass");
      model.apply(shake, mass.at(Vec2(0, 0)), "shake");
      State x = model.reference_state();
      RunReport const report = simulate(model, x, GeneralisedAlpha{}, {.end_time = 10.0, .step = h}).run();
      EXPECT_TRUE(report.warnings.empty());
      EXPECT_EQ(report.halved, 0);
      x = model.reference_state();
      EXPECT_TRUE(simulate(model, x, RungeKutta4<>{}, {.end_time = 10.0, .step = h}).run().warnings.empty());
    }
}

// RungeKutta4 at ωh = 2.84, above its limit of 2.828. Slow growth causes a warning first, and is refused when the
// gain reaches order one.
TEST(PlausibilityCheck, SlowGrowthIsWarnedOfAndThenRefused) {
  for (double const end_time : {0.06, 1.0}) {
    Model<Bodies<Rigid<>>, Joints<>, Forces<SpringDamper>> model;
    Mat3 const inertia = 0.004 * Mat3::Identity();
    auto const mass = model.add(Rigid<>(1.0, inertia, Placement::at({1.1, 0, 0})), "mass");
    model.apply(SpringDamper{.stiffness = 1e4, .damping = 0.0, .free_length = 1.0}, model.ground().at({0, 0, 0}),
                mass.at(Vec3(0, 0, 0)), "spring");
    State x = model.reference_state();
    auto run = simulate(model, x, RungeKutta4<Projection>{}, {.end_time = end_time, .step = 0.0284});
    if (end_time == 1.0) {
      message_of_divergence(run, x);
      EXPECT_LT(energy(model, x).total(), 400.0);  // the initial energy is 50 J
    } else {
      auto slow = simulate(model, x, RungeKutta4<Projection>{}, {.end_time = 0.2, .step = 0.0284});
      auto const warnings = slow.run().warnings;
      ASSERT_EQ(warnings.size(), 1u);
      EXPECT_TRUE(has(warnings[0], "J that no work explains")) << warnings[0];
    }
  }
}

TEST(PlausibilityCheck, LimitsWithoutAMeaningAreRefused) {
  for (PlausibilityLimits const& wrong : {PlausibilityLimits{.violation = 0.0}, PlausibilityLimits{.energy = 0.5},
                                          PlausibilityLimits{.violation = std::numeric_limits<double>::quiet_NaN()}}) {
    StiffPendulum p;
    EXPECT_TRUE(has(refusal([&] {
                      simulate<BlockSolver>(p.model, p.x, GeneralisedAlpha{},
                                            {.end_time = 0.2, .step = 0.01, .limits = wrong});
                    }),
                    "limits.violation must be positive and limits.energy at least one"));
  }
}

}  // namespace step_bounds_test
}  // namespace polybody
