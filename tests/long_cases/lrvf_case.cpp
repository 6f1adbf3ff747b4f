// Flexible mechanisms M1, M2, M3 and M7 by Lrvf; M7 also with rigid bars.
#include <polybody/bodies/lrvf/lrvf.hpp>
#include <polybody/integrators/radau.hpp>

#include "driven_beams.hpp"
#include "four_bar.hpp"
#include "slanted_pendulum.hpp"

namespace polybody::long_cases {

Mesh<Lrvf<>> const lrvf{"Lrvf", [](Bar const& bar, Index n) { return Lrvf<>::from(bar, n); }};

TEST(MisalignedFourBar, OfLrvfFollowsTheExactRods) { four_bar_follows(lrvf, 6, 4.0, 1e-4); }
TEST(LateralBuckling, OfLrvfFollowsTheSpectralBeam) { beam_buckles(lrvf, 64, 2.5e-4, {8e-6, 3e-4, 4e-4, 5e-4, 1e-3}); }
TEST(RotatingShaft, OfLrvfFollowsTheSpectralBeam) { shaft_whirls(lrvf, 64, 2.5e-4, {3e-4, 2e-3, 2.4e-3, 7e-3}); }
TEST(SlantedPendulum, OfLrvfFollowsTheSpectralBeam) {
  pendulum_follows<Lrvf<>>([](Bar const& bar) { return Lrvf<>::from(bar, 4); }, GeneralisedAlpha{.rho_inf = 0.8}, 1e-3,
                           flexible_pendulum, 1e-3, 3e-3, "Lrvf, 4 elements a beam, generalised-α, h = 1 ms");
}
TEST(SlantedPendulum, OfRigidBarsFollowsTwoAngles) {
  auto const rigid = [](Bar const& bar) { return Rigid<>::from(bar); };
  pendulum_follows<Rigid<>>(rigid, GeneralisedAlpha{.rho_inf = 0.9}, 1e-3, rigid_pendulum, 1e-4, 1e-4,
                            "Rigid, Constraint, generalised-α, h = 1 ms");
  pendulum_follows<Rigid<>>(rigid, Radau{}, 2e-3, rigid_pendulum, 1e-8, 1e-8, "Rigid, Constraint, Radau IIA, h = 2 ms");
}

}  // namespace polybody::long_cases
