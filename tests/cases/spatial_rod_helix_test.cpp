// Cantilever of Ibrahimbegović 1997 (S9f), wound into a helix by a space-fixed moment and a force along its axis.

#include <polybody/bodies/lrvf/lrvf.hpp>

#include <gtest/gtest.h>

#include <numbers>

#include "support/held.hpp"
#include "support/spatial_cantilever.hpp"

using namespace polybody;

namespace spatial_rod_helix_test {

using std::numbers::pi;
using Rod = SpatialCantilever<Lrvf<>>;

struct Winding {
  double lambda;
  Vec3 tip;
  double turns;  ///< of the tip section under the moment alone, M L/EI / 2π
};
Winding const windings[] = {{0.05, {0.711481029, 6.285664431, 2.750736205}, 0.5},
                            {0.1, {0.410203353, 0.053770903, -1.091729019}, 1.0},
                            {0.25, {0.025764950, 1.272717958, 0.520651252}, 2.5},
                            {0.5, {0.019106995, 0.000573980, -0.226637441}, 5.0}};

Rod wound(Index n, Winding const& h) {
  Bar const bar{.length = 10.0,
                .constants = BarConstants{.EA = 1e4, .EI = 100, .mass_per_length = 1, .GA = 1e4, .GJ = 100}};
  return Rod(Lrvf<>::from(bar, n), {.force = {0, 0, 50 * h.lambda}, .moment = {0, 0, 200 * pi * h.lambda}},
             {.load_steps = int(200 * h.lambda)});
}

// The tolerance is derived. With the angle φ between adjacent nodes (λ = 0.5: φ = 0.31) the relative error of the
// length of a winding is φ²/24, at most 4e-3 m. The extrapolation of two meshes leaves an error of order φ⁴.
TEST(CantileverToHelix, MeetsTheExactRodThroughFiveTurns) {
  for (Winding const& h : windings) {
    Rod const coarse = wound(50, h), fine = wound(100, h);
    auto const tip = [](char const* mesh) {
      return Claim{"S9f", "tip of the helix [m]", By::independent, "shooting on the rod's equations", mesh};
    };
    Instance const at{equals("λ", h.lambda), h.tip.norm()};
    held_within(tip("Lrvf, 100 elements"), (fine.tip() - h.tip).norm(), 5e-3, at);
    held_within(tip("Lrvf, 50 and 100 elements extrapolated"), ((4.0 * fine.tip() - coarse.tip()) / 3.0 - h.tip).norm(),
                1e-4, at);
    double turned = 0.0;  // ∫ |K| ds
    for (int e = 0; e < 100; ++e)
      turned +=
          0.1 *
          fine.bar.body().section_strains({e, 0.5}, coordinates_of(fine.model, fine.x, fine.bar)).tail<3>().norm();
    EXPECT_GT(turned, 2 * pi * h.turns * 0.98) << h.lambda;
  }
}

}  // namespace spatial_rod_helix_test
