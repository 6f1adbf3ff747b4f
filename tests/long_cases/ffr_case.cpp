// Double pendulum M7 by the floating frame of reference, with the lowest modes of each clamped beam.
#include <polybody/bodies/ffr/beam_structure.hpp>
#include <polybody/bodies/ffr/ffr.hpp>

#include "slanted_pendulum.hpp"

namespace polybody::long_cases {

TEST(SlantedPendulum, OfFloatingFramesFollowsTheSpectralBeam) {
  auto const modal = [](Bar const& bar) {
    Structure const s = structure_of(bar, 4);
    return Ffr(s, fixed_interface_modes(s, 4), {.placement = bar.placement, .stiffening = true});
  };
  pendulum_follows<Ffr>(modal, GeneralisedAlpha{.rho_inf = 0.8}, 1e-3, flexible_pendulum, 1e-3, 3e-3,
                        "Ffr, 4 modes a beam, generalised-α, h = 1 ms");
}

}  // namespace polybody::long_cases
