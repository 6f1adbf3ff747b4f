// README.md's program with rigid bodies, under each policy and integrator.
#include "support/swapped_pendulum.hpp"

namespace polybody::rigid_test {

using swaps::Count;

TEST(SwapsOfTheReadme, RigidBody) { EXPECT_EQ(swaps::run_all<Rigid<>>(), (Count{124, 36})); }
TEST(SwapsOfTheReadme, RigidBodyWithEulerParameters) {
  EXPECT_EQ(swaps::run_all<Rigid<EulerParameters>>(), (Count{60, 100}));
}

}  // namespace polybody::rigid_test
