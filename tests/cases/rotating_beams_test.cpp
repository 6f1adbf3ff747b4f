// Frequencies of cantilevers in steady rotation (E3), by linearisation about the rotation.

#include <polybody/bodies/ancf/ancf_cable.hpp>
#include <polybody/bodies/ffr/ffr.hpp>

#include "support/rotating_cantilever.hpp"

using namespace polybody;

namespace rotating_beams_test {

// Ten elements of third order, with the tolerance of a beam at rest (E1).
TEST(RotatingCantilever, CableHasTheFrequenciesOfTheTable) {
  for (RotatingCantilever const& row : rotating_cantilevers) {
    Vec6 const w = frequencies_in_rotation(AncfCable<>::from(blade(), 10), row.omega);
    for (int i = 0; i < 6; ++i) held_frequency(row, i, w[i], 3e-4, "AncfCable, 10 elements");
    // flap and chord differ only by the centrifugal force across the axis
    EXPECT_NEAR(w[1] * w[1] - w[0] * w[0], row.omega * row.omega, 1e-4);
  }
}

// Floating frame with all coordinates of ten elements and with stiffening. Without stiffening the chord mode is
// unstable above Ω = 3.516.
TEST(RotatingCantilever, FloatingFrameHasTheFrequenciesOfTheTable) {
  for (RotatingCantilever const& row : rotating_cantilevers) {
    Vec6 const w = frequencies_in_rotation(Ffr::from(blade(), 10, {.stiffening = true}), row.omega);
    for (int i = 0; i < 6; ++i) held_frequency(row, i, w[i], 3e-4, "Ffr, all coordinates of 10 elements");
  }
}

}  // namespace rotating_beams_test
