// README.md's program with large rotation vectors, under each policy and integrator.
#include "support/swapped_pendulum.hpp"

namespace polybody::lrvf_test {

using swaps::Count;

TEST(SwapsOfTheReadme, RelativeRotation) { EXPECT_EQ(swaps::run_all<Lrvf<>>(), (Count{109, 51})); }
TEST(SwapsOfTheReadme, DirectInterpolation) { EXPECT_EQ(swaps::run_all<Lrvf<Direct>>(), (Count{101, 59})); }

}  // namespace polybody::lrvf_test
