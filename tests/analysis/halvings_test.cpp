// Steps that stall are halved where a run allows it.
#include <gtest/gtest.h>

#include <polybody/polybody.hpp>

#include "support/refusal.hpp"

using namespace polybody;

namespace halvings_test {

using OnFloor = Contact<SphereOnPlane>;
using Group = ContactGroup<OnFloor>;

// A mass that lands on a damper without onset: its force jumps to c ḋ where they touch, so that some steps have no
// solution.
struct Landing {
  Model<Bodies<Rigid<>>, Joints<>, Forces<Group>> model{Gravity{0, 0, -9.81}};
  BodyHandle<Rigid<>> mass;
  State x;

  explicit Landing(double height)
      : mass(model.add(Rigid<>(18.0, Mat3::Identity(), Placement::at({0, 0, height})), "mass")) {
    auto const group = model.apply(Group{}, std::vector{mass.at(Vec3(0, 0, 0))});
    model.pair_with(group, OnFloor{{0.0}, {.stiffness = 2e6, .damping = 3e4}}, model.ground().at({0, 0, 0}));
    x = model.reference_state();
  }
  RunReport run(int halvings) {
    return simulate(model, x, GeneralizedAlpha{}, {.until = 0.15, .step = 2e-3, .halvings = halvings}).run();
  }
};

TEST(Halvings, LetLandingsThroughThatStall) {
  int stalled = 0, halved = 0;
  for (int i = 0; i < 100; ++i) {
    double const height = 0.02 + 2e-4 * i;
    Landing without(height), with(height);
    try {
      without.run(0);
    } catch (NewtonStalled const&) {
      ++stalled;
      EXPECT_LT(without.x.t, 0.15);
      EXPECT_TRUE(without.x.q.allFinite());
    }
    RunReport const report = with.run(20);
    halved += report.rejected > 0;
    EXPECT_EQ(with.x.t, 0.15);
    // it lies where its weight presses it to, c/k = 15 ms after it has landed: within what it fell in that time
    EXPECT_LT(std::abs(position(with.model, with.x, with.mass.at(Vec3(0, 0, 0))).z()), 0.01);
    EXPECT_EQ(report.steps, 75);
  }
  EXPECT_GT(stalled, 0);
  EXPECT_EQ(halved, stalled);
}

TEST(Halvings, RefusesNumbersThatCannotBeMeant) {
  Landing landing(0.1);
  EXPECT_TRUE(has(refusal([&] { landing.run(-1); }), "a step can be halved 0 to 30 times, but -1 is asked for"));
  EXPECT_TRUE(has(refusal([&] { landing.run(31); }), "but 31 is asked for"));
}

}  // namespace halvings_test
