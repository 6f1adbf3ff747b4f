// Flexible mechanisms M1, M2, M3 and M7 by Se3Beam.
#include <polybody/bodies/se3/se3_beam.hpp>

#include "driven_beams.hpp"
#include "four_bar.hpp"
#include "slanted_pendulum.hpp"

namespace polybody::long_cases {

Mesh<Se3Beam> const helices{"Se3Beam", [](Bar const& bar, Index n) { return Se3Beam::from(bar, n); }};

TEST(MisalignedFourBar, OfSe3BeamsFollowsTheExactRods) { four_bar_follows(helices, 6, 4.0, 1e-4); }
TEST(LateralBuckling, OfSe3BeamsFollowsTheSpectralBeam) {
  beam_buckles(helices, 64, 2.5e-4, {8e-6, 3e-4, 4e-4, 5e-4, 1e-3});
}
TEST(RotatingShaft, OfSe3BeamsFollowsTheSpectralBeam) { shaft_whirls(helices, 64, 2.5e-4, {3e-4, 2e-3, 2.4e-3, 7e-3}); }
TEST(SlantedPendulum, OfSe3BeamsFollowsTheSpectralBeam) {
  pendulum_follows<Se3Beam>([](Bar const& bar) { return Se3Beam::from(bar, 4); }, GeneralisedAlpha{.rho_inf = 0.8},
                            1e-3, flexible_pendulum, 1e-3, 3e-3, "Se3Beam, 4 elements a beam, generalised-α, h = 1 ms");
}

}  // namespace polybody::long_cases
