// CASES E3 by the geometrically exact rods, of second order in the elements' length: the limit by Richardson from two
// meshes.

#include <polybody/bodies/ancf/ancf_beam.hpp>
#include <polybody/bodies/lrvf/lrvf.hpp>

#include "support/rotating_cantilever.hpp"

using namespace polybody;

namespace rotating_rods_test {

template <class B>
void converges(Index n, double tolerance) {
  for (RotatingCantilever const& row : rotating_cantilevers) {
    Vec6 const coarse = frequencies_in_rotation(B::from(blade(), n), row.omega);
    Vec6 const fine = frequencies_in_rotation(B::from(blade(), 2 * n), row.omega);
    for (int i = 0; i < 6; ++i) {
      double const limit = fine[i] + (fine[i] - coarse[i]) / 3.0;
      EXPECT_NEAR(limit / row.frequency[i], 1.0, tolerance) << row.omega << ' ' << i;
    }
  }
}

TEST(RotatingCantilever, LargeRotationVectorConvergesToTheTable) { converges<Lrvf<>>(12, 1e-3); }
TEST(RotatingCantilever, FullAncfBeamConvergesToTheTable) { converges<AncfBeam<>>(8, 1e-3); }

}  // namespace rotating_rods_test
