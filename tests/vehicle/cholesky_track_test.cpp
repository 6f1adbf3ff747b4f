// Tracks of ANCF cables in Cholesky coordinates; for 0.05 s: tests/long_cases/cholesky_tracks_case.cpp.
#include "support/cholesky_tracks.hpp"

namespace polybody {
namespace cholesky_track_test {
using namespace cholesky_tracks;

/// How many unknowns explicit steps factor once, and how many they have.
template <class Link>
std::pair<Index, Index> kept_unknowns() {
  auto const tracks = vehicle<Link>(1.0);
  System system = stepped_system(tracks.model);
  TangentSolver<KeptParts<BlockSolver>> tangent;
  tangent.linear_solver().keep(detail::constant_unknowns(system));
  tangent.analyse(system, 1, [&](BlockSink& sink) { system.masses(sink); });
  return {tangent.linear_solver().kept(), equations_of(system)};
}

TEST(CholeskyTracks, AreFactoredOnce) {  // a link has eight speeds, a pin takes four; one pin of a closed track repeats
                                         // the lateral slope that all share
  for (auto const& [kept, all] : {kept_unknowns<AncfCable<>>(), kept_unknowns<Cholesky>()}) {
    EXPECT_GE(kept, 2 * 64 * 8 - 2 * 64 * 4);
    EXPECT_LT(kept, all);  // the hull has joints that turn
  }
}

TEST(CholeskyTracks, MoveAsInOrdinaryCoordinates) { expect_the_same_motion(5e-4, 1e-10); }

}  // namespace cholesky_track_test
}  // namespace polybody
