// Torsion of thin sections by the continuum beam. The ends twist as much as the middle, for both orientations of the
// section.

#include <polybody/bodies/ancf/ancf_beam.hpp>

#include <gtest/gtest.h>

#include <numbers>

#include "support/spatial_cantilever.hpp"

using namespace polybody;

namespace ancf_beam_torsion_test {

using Cured = AncfBeam<Continuum<>>;
using std::numbers::pi;

/// Bar of the pre-twisted cantilever of MacNeal & Harder 1985 (S8). The long side is along y or along z.
Bar thin(bool along_y) {
  return {.length = 12,
          .section = Rectangle{.height = along_y ? 1.1 : 0.32, .width = along_y ? 0.32 : 1.1},
          .material = Material{.density = 1, .young = 29e6, .poisson = 0.22}};
}
double const twist = 0.5 * pi / 12;
Placement twisted(double s) { return Placement::at({s, 0, 0}, {twist * s, 0, 0}); }

double const angle = 1e-4;  // of the rod, T L/GJ [rad]
TipLoad torque(Bar const& bar) { return {.moment = {angle * constants(bar).GJ / bar.length, 0, 0}}; }
template <class B>
double turn(SpatialCantilever<B> const& c) {
  return log_so3(c.tip_turn())[0] / angle;
}

// Saint-Venant's T L/GJ holds for every mesh. End conditions on r_y alone would add ℓ (1 − p)/p · T/GJ at each end.
// With the long side along z these meshes would then give 1.005, 1.020 and 1.061, with the limit 1.088.
TEST(ContinuumTorsion, IsSaintVenantsHoweverTheSectionLies) {
  for (bool const along_y : {false, true})
    for (Index const n : {8, 32, 128}) {
      SpatialCantilever<Cured> const c(Cured::from(thin(along_y), n), torque(thin(along_y)), {});
      EXPECT_NEAR(turn(c), 1.0, 1e-7) << along_y << ' ' << n;
      Vec6 unit = Vec6::Zero();
      unit[3] = angle / 12;
      for (double const s : {0.0, 0.03, 6.0, 12.0}) {
        auto const p = c.bar.body().at(s);
        EXPECT_LT((c.bar.body().section_strains(p, c.coordinates()) - unit).norm(), 1e-5 * unit[3]) << s;
        Vec3 const moment = c.bar.body().section_forces(p, c.coordinates()).tail<3>(),
                   applied = torque(thin(along_y)).moment;
        EXPECT_LT((moment - applied).norm(), 1e-6 * applied.norm()) << s;
      }
    }
}

TEST(ContinuumTorsion, OfTheElementThatLocksIsOfThePolarMoment) {
  using Plain = AncfBeam<Continuum<Locking::present>>;
  for (bool const along_y : {false, true}) {
    BarConstants const c = constants(thin(along_y));
    SpatialCantilever<Plain> const bar(Plain::from(thin(along_y), 64), torque(thin(along_y)), {});
    EXPECT_NEAR(turn(bar), c.GJ * 2.44 / (c.EI + *c.EI_y), 1e-7) << along_y;
  }
}

// A bar with the twist τ couples torsion with transverse strains. With e = E₂₂ − E₃₃ and E₂₂ + E₃₃ = 0, the shears
// are
//   2E₁₃ = y (α′ + τ e),  2E₁₂ = −z (α′ − τ e),  and the energy  ½ [D_y (α′ + τe)² + D_z (α′ − τe)² + μA e²],
// whose minimum over e is ½ GJ α′² (1 − τ² GJ (1 − 2p)²/(μA + τ² GJ)), D_y = p GJ.
TEST(ContinuumTorsion, OfATwistedBarTendsToOneNumberHoweverTheSectionLies) {
  BarConstants const c = constants(thin(true));
  double const area = 1.1 * 0.32, mu = 29e6 / 2.44, share = 1.1 * 1.1 / (1.1 * 1.1 + 0.32 * 0.32),
               bends = twist * twist * c.GJ, softer = bends * (1 - 2 * share) * (1 - 2 * share) / (mu * area + bends);
  EXPECT_NEAR(softer, 3.4e-4, 1e-5);
  double limits[2];
  for (bool const along_y : {false, true}) {
    auto const by = [&](Index n) {
      return turn(SpatialCantilever<Cured>(Cured::from(thin(along_y), n, twisted), torque(thin(along_y)), {}));
    };
    limits[along_y] = (16 * by(128) - by(32)) / 15;
  }
  EXPECT_NEAR(limits[0], limits[1], 1e-8);
  EXPECT_NEAR(limits[0], 1 / (1 - softer), 2e-6);
}

}  // namespace ancf_beam_torsion_test
