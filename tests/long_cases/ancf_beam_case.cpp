// Flexible mechanisms M1, M2, M3 and M7 by AncfBeam.
#include <polybody/bodies/ancf/ancf_beam.hpp>

#include "driven_beams.hpp"
#include "four_bar.hpp"
#include "slanted_pendulum.hpp"

namespace polybody::long_cases {

using Beam = AncfBeam<ElasticLine>;
Mesh<Beam> const ancf{"AncfBeam", [](Bar const& bar, Index n) { return Beam::from(bar, n); }};

TEST(MisalignedFourBar, OfAncfBeamsFollowsTheExactRods) { four_bar_follows(ancf, 6, 4.0, 1e-4); }
TEST(LateralBuckling, OfAncfBeamsFollowsTheSpectralBeam) {
  beam_buckles(ancf, 24, 2.5e-4, {1.2e-5, 6e-4, 1.8e-3, 2e-3, 2e-3});
}
TEST(RotatingShaft, OfAncfBeamsFollowsTheSpectralBeam) { shaft_whirls(ancf, 32, 2.5e-4, {1e-3, 6e-3, 9e-3, 2e-2}); }
TEST(SlantedPendulum, OfAncfBeamsFollowsTheSpectralBeam) {
  pendulum_follows<Beam>([](Bar const& bar) { return Beam::from(bar, 4); }, GeneralisedAlpha{.rho_inf = 0.8}, 1e-3,
                         flexible_pendulum, 1e-3, 3e-3, "AncfBeam, 4 elements a beam, generalised-α, h = 1 ms");
}

}  // namespace polybody::long_cases
