// Joints, springs and bushings in an energy-conserving step.

#include <polybody/integrators/energy_momentum.hpp>

#include <gtest/gtest.h>

#include <polybody/bodies/ancf/planar_ancf_cable.hpp>
#include <polybody/integrators/generalised_alpha.hpp>
#include <polybody/run/simulate.hpp>

#include "support/energy_drift.hpp"
#include "support/integrator_cases.hpp"
#include "support/solver_instances.hpp"

using namespace polybody;

namespace energy_momentum_joints_test {

using Cable = planar::AncfCable<>;
using Pin = Joint<planar::Revolute, Constraint>;
using SoftPin = Joint<planar::Revolute, Penalty>;

Bar rope(double x, double y) {
  return {.length = 1.0,
          .constants = BarConstants{.EA = 1e4, .EI = 1.0, .mass_per_length = 1.0},
          .placement = Placement::planar(x, y)};
}

// Two cables on pins swing down from the horizontal.
TEST(EnergyMomentumOfJoints, PinsDoNoWorkInAChainOfCables) {
  Model<Bodies<Cable>, Joints<Pin>> model{Gravity{0, -9.81, 0}};
  auto const first = model.add(Cable::from(rope(0, 0), 4), "first"),
             second = model.add(Cable::from(rope(1, 0), 4), "second");
  model.connect(Pin{}, model.ground().at({0, 0, 0}), first.at(0.0), "hook");
  model.connect(Pin{}, first.at(1.0), second.at(0.0), "pin");
  State x = model.reference_state();
  model.set_velocity(x, first, Vec3::Zero(), Vec3(0, 0, 1.0));
  model.set_velocity(x, second, Vec3::Zero(), Vec3(0, 0, 1.0));
  Drift const drift =
      // later the motion is irregular, and Newton's method does not converge because of round-off
      drift_of(model, x, EnergyMomentum{}, 0.002, 5000);
  EXPECT_LT(drift.energy, 1e-7);
  EXPECT_LT(drift.violation, 1e-11);
}

// Angles as coordinates: constraint equations of sines and cosines do no work either. Position has order two. λ
// belongs to the middle of the step and alternates by O(h) about the exact value. The mean of two steps equals the
// reaction of the exact pendulum between them up to O(h²).
TEST(EnergyMomentumOfJoints, PinDoesNoWorkOnARigidPendulum) {
  std::vector<double> angles, reactions;
  for (double const h : {0.02, 0.01}) {
    SwingingBar bar;
    State x = bar.start;
    Drift const drift = drift_of(bar.model, x, EnergyMomentum{}, h, int(std::lround(0.6 / h)));
    EXPECT_LT(drift.energy, 1e-9);
    EXPECT_LT(drift.violation, 1e-11);
    angles.push_back(std::abs(x.q[2] + 0.5 * std::numbers::pi - bar.exact(bar.phase + x.t).angle));
    VecX const before = x.lambda;
    drift_of(bar.model, x, EnergyMomentum{}, h, 1);
    reactions.push_back((0.5 * (before + x.lambda) + bar.reaction(x.t - h)).norm());
  }
  EXPECT_NEAR(std::log2(angles[0] / angles[1]), 2.0, 0.1) << testing::PrintToString(angles);
  EXPECT_NEAR(std::log2(reactions[0] / reactions[1]), 2.0, 0.2) << testing::PrintToString(reactions);
}

/// Two cables and a bar in free flight, connected by a pin, a compliant pin and a spring.
struct Flock {
  Model<Bodies<Cable, planar::Rigid>, Joints<Pin, SoftPin>, Forces<SpringDamper>> model;
  State x;
  explicit Flock(double damping) {
    auto const first = model.add(Cable::from(rope(0, 0), 2), "first"),
               second = model.add(Cable::from(rope(1, 0), 2), "second");
    auto const ball = model.add(planar::Rigid(1.0, 0.1, Placement::planar(2.0, 0.0)), "ball");
    model.connect(Pin{}, first.at(1.0), second.at(0.0), "pin");
    model.connect(SoftPin{{}, {.stiffness = 1e4, .damping = 0.0}}, second.at(1.0), ball.at(Vec2(0, 0)), "soft pin");
    model.apply(SpringDamper{.stiffness = 50.0, .damping = damping, .free_length = 1.0}, first.at(0.3),
                ball.at(Vec2(0, 0)), "spring");
    x = model.reference_state();
    model.set_velocity(x, first, Vec3(1, 0, 0), Vec3(0, 0, 4.0));
    model.set_velocity(x, second, Vec3(1, 0, 0), Vec3(0, 0, 4.0));
    model.set_velocity(x, ball, Vec3(1, 0, 0), Vec3(0, 0, 4.0));
  }
};

TEST(EnergyMomentumOfJoints, JointsOfPointsAndSpringsKeepBothMomenta) {
  Flock flock(0.0);
  expect_invariants(drift_of(flock.model, flock.x, EnergyMomentum{}, 0.005, 4000));
}

// Dampers reduce the energy in every step; the momenta are constant.
TEST(EnergyMomentumOfJoints, DampersOnlyTakeEnergy) {
  Flock flock(2.0);
  expect_decay(drift_of(flock.model, flock.x, EnergyMomentum{}, 0.005, 1000), 0.05);
}

// A point mass moves around on a spring, with hω = 10 along the spring and a rotation of 0.3 rad per step. The
// trapezoidal rule is stable for linear models only and doubles the energy [Gonzalez & Simo 1996]. The
// energy-momentum step conserves the energy and the moment of momentum.
TEST(EnergyMomentumOfJoints, StaysWhereTheTrapezoidalRuleGainsEnergy) {
  Model<Bodies<planar::Rigid>, Joints<>, Forces<SpringDamper>> model;
  auto const mass = model.add(planar::Rigid(1.0, 1.0, Placement::planar(1.0, 0.0)), "mass");
  model.apply(SpringDamper{.stiffness = 1e4, .free_length = 0.99}, model.ground().at({0, 0, 0}), mass.at(Vec2(0, 0)),
              "spring");
  double const h = 0.1;
  State start = model.reference_state();
  start.v << 0.0, 3.0, 0.0;
  auto const worst_of_trapezoidal = [&] {
    State x = start;
    double const e0 = energy(model, x).total();
    System system(model);
    auto const method = method_of(Trapezoidal{});
    auto workspace = method.workspace<DefaultSolver>(system);
    double worst = 0.0;
    try {
      method.start(system, x, h, workspace);
      for (int i = 0; i < 1000; ++i) {
        method.step(system, x, h, workspace);
        worst = std::max(worst, energy(model, x).total() / e0);
      }
    } catch (NewtonConvergenceFailure const&) {
    }
    return worst;
  };
  EXPECT_GT(worst_of_trapezoidal(), 2.0);
  State x = start;
  // the remaining errors of Newton's method add up over the steps: 1e-7 with the usual tolerance
  Drift const drift = drift_of(model, x, EnergyMomentum{.tolerance = 1e-12}, h, 10000);
  EXPECT_LT(drift.energy, 1e-8);
  EXPECT_LT(drift.angular, 1e-9);
}

}  // namespace energy_momentum_joints_test
