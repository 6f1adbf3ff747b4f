// Tracks of ANCF cables in Cholesky coordinates for 0.05 s, contacts included.
#include "support/cholesky_tracks.hpp"

TEST(CholeskyTracksCase, MoveAsInOrdinaryCoordinates) { polybody::cholesky_tracks::expect_the_same_motion(0.05, 1e-8); }
