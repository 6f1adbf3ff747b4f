// The lowest modes of a track link, far above the filter frequency of its strain (docs/track_stress.md).

#include <gtest/gtest.h>

#include <numbers>

#include <Eigen/Eigenvalues>
#include <polybody/bodies/ffr/beam_structure.hpp>

#include "m113/links.hpp"
#include "support/held.hpp"

namespace polybody {
namespace link_modes_test {

using std::numbers::pi;

Claim mode(char const* what, char const* formula) {
  return {"M113 link", what, By::closed_form, formula, "Structure of 16 beam elements"};
}

/// Frequencies of the link [kHz] with the given free coordinates of its nodes; the other coordinates are fixed.
VecX frequencies(Structure const& s, std::vector<Index> const& free) {
  MatX const stiffness = s.stiffness, inertia = s.mass_matrix();
  VecX const squares =
      Eigen::GeneralizedSelfAdjointEigenSolver<MatX>(stiffness(free, free), inertia(free, free), Eigen::EigenvaluesOnly)
          .eigenvalues();
  return squares.cwiseMax(0.0).cwiseSqrt() / (2e3 * pi);
}

// Vertical bending between the pins, with the section's rotary inertia (Rayleigh's beam), and longitudinal modes of
// the free link.
TEST(TrackLink, ModesBeginFarAboveTheFilteredStrain) {
  Bar const bar = m113::link_bar();
  Structure const s = structure_of(bar, 16);
  std::vector<Index> bending, stretch;
  for (Index node = 0; node <= 16; ++node) {
    stretch.push_back(6 * node);
    if (node % 16 != 0) bending.push_back(6 * node + 2);
    bending.push_back(6 * node + 4);
  }
  BarConstants const c = constants(bar);
  double const mass = c.mass_per_length, k = pi / bar.length, rotary = 7800.0 / 2e11 * *c.EI_y;
  double const bent = k * k * std::sqrt(*c.EI_y / (mass + k * k * rotary)) / (2e3 * pi);
  held(mode("bending between the pins [kHz]", "ω² = k⁴ EI/(ρA + k² ρI), k = π/p"), frequencies(s, bending)[0], bent,
       1e-3 * bent);
  EXPECT_NEAR(bent, 3.83, 0.005);
  double const stretched = std::sqrt(c.EA / mass) / (2e3 * bar.length);
  held(mode("first axial mode of the free link [kHz]", "√(E/ρ)/2p"), frequencies(s, stretch)[1], stretched,
       2e-3 * stretched);
  EXPECT_NEAR(stretched, 16.6, 0.05);
}

}  // namespace link_modes_test
}  // namespace polybody
