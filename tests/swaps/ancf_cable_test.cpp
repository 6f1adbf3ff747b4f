// README.md's program with an ANCF cable, under each policy and integrator. The cable has no axis across its tangent,
// so the geometry is `Spherical`.
#include "support/refusal.hpp"
#include "support/swapped_pendulum.hpp"

namespace polybody::ancf_cable_test {

using swaps::Count;

TEST(SwapsOfTheReadme, Cable) { EXPECT_EQ(swaps::run_all<AncfCable<>>(Spherical{}), (Count{111, 49})); }
TEST(SwapsOfTheReadme, CableOnARevoluteAcrossItsTangentIsRefused) {
  Revolute const pin{.axis = {0, 1, 0}};
  std::string const message = refusal([&] { swaps::run_program<AncfCable<>>(Joint{pin}, GeneralisedAlpha{}, 1e-3); });
  EXPECT_TRUE(has(message, "tangent")) << message;
}

}  // namespace polybody::ancf_cable_test
