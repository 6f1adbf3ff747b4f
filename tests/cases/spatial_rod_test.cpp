// Cantilevers in space compared with an independent computation of the exact rod with the same constants: end moments
// (S5), Princeton beam (S6), 45° bend (S7), pre-twisted cantilever (S8). Elements are of order 2. The extrapolation
// of two meshes, (4 u₂ₙ − uₙ)/3, agrees with the exact values to their printed digits.

#include <polybody/bodies/lrvf/lrvf.hpp>

#include <gtest/gtest.h>

#include "support/spatial_rods.hpp"

using namespace polybody;

namespace spatial_rod_test {

using namespace spatial_rods;

// ---- S5: Nachbagauer, Gruber & Gerstmayr 2013, end moments

TEST(EndMoments, SpaceFixedMomentsMeetTheExactRod) { meets_the_exact_dead_moments<Lrvf<>>("Lrvf"); }
TEST(EndMoments, FollowerMomentsGiveAnotherAnswer) { meets_the_exact_following_moments<Lrvf<>>("Lrvf"); }

// ---- S6: the Princeton beam of Dowell & Traybar 1975

TEST(PrincetonBeam, MeetsTheExactRod) { meets_the_exact_princeton_beam<Lrvf<>>("Lrvf"); }

// ---- S7: the 45° bend of Bathe & Bolourchi, a curved reference configuration

TEST(FortyFiveDegreeBend, MeetsTheExactRod) { meets_the_exact_bend<Lrvf<>>("Lrvf"); }

// ---- S8: the pre-twisted cantilever of MacNeal & Harder 1985, linear

TEST(PreTwistedCantilever, MeetsTheExactRod) { meets_the_exact_twisted_rod<Lrvf<>>("Lrvf"); }

}  // namespace spatial_rod_test
