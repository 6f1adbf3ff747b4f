// Frequencies of rotating cantilevers (E3) by geometrically exact rods of second order in the element length.
// Richardson extrapolation of two meshes gives the limit.

#include <polybody/bodies/ancf/ancf_beam.hpp>
#include <polybody/bodies/lrvf/lrvf.hpp>
#include <polybody/bodies/se3/se3_beam.hpp>

#include "support/rotating_cantilever.hpp"

using namespace polybody;

namespace rotating_rods_test {

template <class B>
void converges(std::vector<RotatingCantilever> const& rows, Index n, double share, char const* formulation) {
  for (RotatingCantilever const& row : rows) {
    Vec6 const coarse = frequencies_in_rotation(B::from(blade(), n), row.omega);
    Vec6 const fine = frequencies_in_rotation(B::from(blade(), 2 * n), row.omega);
    for (int i = 0; i < 6; ++i) {
      double const limit = fine[i] + (fine[i] - coarse[i]) / 3.0;
      held_frequency(row, i, limit, share, formulation);
    }
  }
}

TEST(RotatingCantilever, LargeRotationVectorConvergesToTheTable) {
  converges<Lrvf<>>({std::begin(rotating_cantilevers), std::end(rotating_cantilevers)}, 12, 5e-4,
                    "Lrvf, 12 and 24 elements extrapolated");
}
TEST(RotatingCantilever, HelicoidalBeamConvergesToTheTable) {
  converges<Se3Beam>({std::begin(rotating_cantilevers), std::end(rotating_cantilevers)}, 12, 5e-4,
                     "Se3Beam, 12 and 24 elements extrapolated");
}
// Ω = 2, 6 and 12: the frequencies of each angular velocity take one second of computation.
TEST(RotatingCantilever, FullAncfBeamConvergesToTheTable) {
  converges<AncfBeam<>>({rotating_cantilevers[2], rotating_cantilevers[5], rotating_cantilevers[8]}, 8, 8e-4,
                        "AncfBeam, 8 and 16 elements extrapolated");
}

}  // namespace rotating_rods_test
