// README.md's program with ANCF beams of both strains, under each policy and integrator.
#include "support/swapped_pendulum.hpp"

namespace polybody::ancf_beam_test {

using swaps::Count;

TEST(SwapsOfTheReadme, ElasticLine) { EXPECT_EQ(swaps::run_all<AncfBeam<ElasticLine>>(), (Count{111, 49})); }
TEST(SwapsOfTheReadme, Continuum) { EXPECT_EQ(swaps::run_all<AncfBeam<Continuum<>>>(), (Count{111, 49})); }

}  // namespace polybody::ancf_beam_test
