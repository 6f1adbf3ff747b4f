// Remedies in the messages of iterations that do not converge.
#include <gtest/gtest.h>

#include <numbers>

#include <polybody/bodies/lrvf/lrvf.hpp>
#include <polybody/bodies/rigid/rigid.hpp>
#include <polybody/forces/contact.hpp>
#include <polybody/forces/loads.hpp>
#include <polybody/integrators/generalised_alpha.hpp>
#include <polybody/joints/joint.hpp>
#include <polybody/joints/standard_joints.hpp>
#include <polybody/run/simulate.hpp>
#include <polybody/statics/equilibrium.hpp>

#include "support/refusal.hpp"

using namespace polybody;

namespace remedies_test {

/// Message of the failure of a cantilever of 1 m under an end moment that bends it by 1.5 turns; empty without failure.
std::string failure_of_cantilever(Index elements) {
  using Beam = Lrvf<>;
  using Clamp = Joint<Weld, Constraint>;
  Model<Bodies<Beam>, Joints<Clamp>, Forces<PointMoment<>>> model;
  auto const beam = model.add(Beam::from({.length = 1.0,
                                          .section = Rectangle{.height = 0.01, .width = 0.01},
                                          .material = Material{.density = 7800, .young = 2e11}},
                                         elements),
                              "beam");
  model.connect(Clamp{}, model.ground().at({0, 0, 0}), beam.at(0.0), "clamp");
  double const stiffness = 2e11 * 1e-8 / 12.0;
  model.apply(PointMoment<>{.moment = Vec3(0, 0, stiffness * 3.0 * std::numbers::pi)}, beam.at(1.0), "moment");
  State x = model.reference_state();
  try {
    equilibrium(model, x, {.load_steps = 60});
  } catch (NewtonConvergenceFailure const& failure) {
    return failure.what();
  }
  return "";
}

TEST(Remedies, AnElementThatTurnsByHalfATurnNeedsMoreElements) {
  std::string const message = failure_of_cantilever(2);
  EXPECT_TRUE(has(message, "use more elements")) << message;
  EXPECT_TRUE(has(message, "body \"beam\"")) << message;
  EXPECT_EQ(failure_of_cantilever(16), "");
}

/// A ball of 1 kg slides at 1 m/s on a rough floor and begins to roll after 1/(3.5 μ g) = 0.058 s.
struct RollingBall {
  using Floor = Contact<SphereOnPlane>;
  Model<Bodies<Rigid<>>, Joints<>, Forces<Floor>> model{Gravity{0, 0, -9.81}};
  State x;
  explicit RollingBall(double slip_speed) {
    Mat3 const inertia = 0.004 * Mat3::Identity();
    auto const ball = model.add(Rigid<>(1.0, inertia, Placement::at({0, 0, 0.1 - 9.81e-5})), "ball");
    Floor const rough{{0.1}, {.stiffness = 1e5, .damping = 100.0}, {.coefficient = 0.5, .slip_speed = slip_speed}};
    model.apply(rough, ball.at(Vec3(0, 0, 0)), model.ground().at({0, 0, 0}), "rough floor");
    x = model.reference_state();
    x.v[0] = 1.0;
  }
  void run() { simulate(model, x, GeneralisedAlpha{}, {.end_time = 0.5, .step = 1e-3}).run(); }
};

// With a slip speed of 1e-20 m/s the friction turns within round-off, so no step length helps.
TEST(Remedies, FrictionNeedsALargerSlipSpeed) {
  std::string message;
  try {
    RollingBall(1e-20).run();
  } catch (NewtonConvergenceFailure const& failure) {
    message = failure.what();
  }
  EXPECT_TRUE(has(message, "or a larger slip speed if \"rough floor\" has friction")) << message;
}

// The momentum about the point of contact is constant, so a sphere rolls at 5/7 of its speed, for every slip speed.
// 1e-12 m/s is below the change of the speed that the tolerance of Newton's method permits in a step.
TEST(Remedies, ASlidingBallRollsWithVerySmallSlipSpeeds) {
  for (double const slip_speed : {1e-2, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12}) {
    RollingBall ball(slip_speed);
    ball.run();
    EXPECT_NEAR(ball.x.v[0], 5.0 / 7.0, 1e-9) << slip_speed;
  }
}

}  // namespace remedies_test
