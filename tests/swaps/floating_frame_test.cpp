// README.md's program with a floating frame, under each policy and integrator.
#include <polybody/bodies/ffr/ffr.hpp>

#include "support/swapped_pendulum.hpp"

namespace polybody::floating_frame_test {

using swaps::Count;

TEST(SwapsOfTheReadme, FloatingFrame) { EXPECT_EQ(swaps::run_all<Ffr>(), (Count{92, 68})); }

}  // namespace polybody::floating_frame_test
