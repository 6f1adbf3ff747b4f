// Tracks of ANCF cables in Cholesky coordinates. A run of 0.05 s is in tests/long_cases/cholesky_tracks_case.cpp.
#include "support/cholesky_tracks.hpp"

namespace polybody {
namespace cholesky_track_test {
using namespace cholesky_tracks;

/// Number of unknowns that explicit steps factorise once, and total number of unknowns.
template <class Link>
std::pair<Index, Index> kept_unknowns() {
  auto const tracks = vehicle<Link>(1.0);
  System system = stepped_system(tracks.model);
  PatternSink pattern;
  system.masses(pattern);
  ConstantBlockCache<BlockSolver> solver;
  return {solver.keep(detail::constant_unknowns(system), pattern.blocks), equations_of(system)};
}

// a link has eight velocities, a pin removes four; one pin of a closed track is redundant
TEST(CholeskyTracks, AreFactoredOnce) {
  // the lateral gradient that all links share
  for (auto const& [kept, all] : {kept_unknowns<AncfCable<>>(), kept_unknowns<Cholesky>()}) {
    EXPECT_GE(kept, 2 * 64 * 8 - 2 * 64 * 4);
    EXPECT_LT(kept, all);  // the hull has rotational joints
  }
}

TEST(CholeskyTracks, MoveAsInOrdinaryCoordinates) { expect_the_same_motion(5e-4, 1e-10); }

}  // namespace cholesky_track_test
}  // namespace polybody
