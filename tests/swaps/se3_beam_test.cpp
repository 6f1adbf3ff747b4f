// README.md's program with the beam on SE(3), under each policy and integrator.
#include <polybody/se3_beam.hpp>

#include "support/swapped_pendulum.hpp"

namespace polybody::se3_beam_test {

using swaps::Count;

TEST(SwapsOfTheReadme, Se3Beam) { EXPECT_EQ(swaps::run_all<Se3Beam>(), (Count{109, 51})); }

}  // namespace polybody::se3_beam_test
