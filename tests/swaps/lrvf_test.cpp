// README.md's program with large rotation vectors, under each policy and integrator.
#include "support/swapped_pendulum.hpp"

namespace polybody::lrvf_test {

using swaps::Count;

TEST(SwapsOfTheReadme, RelativeRotation) { EXPECT_EQ(swaps::run_all<Lrvf<>>(), (Count{93, 67})); }
TEST(SwapsOfTheReadme, DirectInterpolation) { EXPECT_EQ(swaps::run_all<Lrvf<Direct>>(), (Count{85, 75})); }

}  // namespace polybody::lrvf_test
