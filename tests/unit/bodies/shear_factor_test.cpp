// Section with its own shear factor k: every formulation with shear uses its k G A.

#include <gtest/gtest.h>

#include <polybody/bodies/ancf/ancf_beam.hpp>
#include <polybody/bodies/lrvf/lrvf.hpp>
#include <polybody/bodies/lrvf/planar_lrvf.hpp>

#include "support/cantilever.hpp"
#include "support/held.hpp"
#include "support/refusal.hpp"
#include "support/spatial_cantilever.hpp"

namespace polybody {
namespace shear_factor_test {

/// Thick cantilever, L/h = 4.
Bar thick(std::optional<double> factor) {
  return {.length = 2.0,
          .section = Rectangle{.height = 0.5, .width = 0.1},
          .material = Material{.density = 7850, .young = 2e8, .poisson = 0.25},
          .shear_factor = factor};
}
constexpr double force = 1.0, shear_area = 2e8 / 2.5 * 0.05, bending = 2e8 * 0.1 * 0.125 / 12.0;

/// Deflection F L³/(3 EI) + F L/(k G A) [Timoshenko].
double deflection(double k) { return force * 8.0 / (3.0 * bending) + force * 2.0 / (k * shear_area); }

/// \param deflect tip deflection of a bar under `force`; \param mesh relative error of bending on its mesh
template <class F>
void follows_timoshenko(F&& deflect, double mesh, std::string const& formulation) {
  Claim const claim{"shear factor", "deflection of a thick cantilever [m]", By::closed_form,
                    "F L³/(3 EI) + F L/(k G A)", formulation};
  Claim const shear{"shear factor", "deflection beyond that of k = 1 [m]", By::closed_form, "F L/(G A) (1/k − 1)",
                    formulation};
  double const whole = deflect(thick(1.0));
  for (double const k : {0.4, 5.0 / 6.0}) {
    double const found = deflect(thick(k));
    held(claim, found, deflection(k), mesh * deflection(k), {equals("k", k)});
    held(shear, found - whole, deflection(k) - deflection(1.0), 1e-4 * (deflection(k) - deflection(1.0)),
         {equals("k", k)});
  }
  EXPECT_EQ(deflect(thick({})), deflect(thick(10.0 * 1.25 / (12.0 + 11.0 * 0.25))));  // Cowper's factor
}

TEST(ShearFactor, SetsTheDeflectionOfAThickCantilever) {
  EquilibriumOptions const tight{.tolerance = 1e-12};
  follows_timoshenko(
      [&](Bar const& bar) {
        return Cantilever<planar::Lrvf>(planar::Lrvf::from(bar, 16), {.force = {0, force}}, tight)
            .tip_displacement()[1];
      },
      1.01 / (4 * 16 * 16), "planar Lrvf, 16 elements");
  follows_timoshenko(
      [&](Bar const& bar) {
        return SpatialCantilever<Lrvf<>>(Lrvf<>::from(bar, 16), {.force = {0, force, 0}}, tight).tip()[1];
      },
      1.01 / (4 * 16 * 16), "Lrvf, 16 elements");
  follows_timoshenko(
      [&](Bar const& bar) {
        using Beam = AncfBeam<Continuum<>>;
        return SpatialCantilever<Beam>(Beam::from(bar, 16), {.force = {0, force, 0}}, tight).tip()[1];
      },
      2e-3, "AncfBeam<Continuum>, 16 elements");
}

TEST(ShearFactor, IsRefusedWhereItMeansNothing) {
  EXPECT_TRUE(has(refusal([] { constants(thick(0.0)); }), "the shear factor"));
  Bar by_constants{.length = 1.0, .constants = BarConstants{.EA = 1, .EI = 1, .mass_per_length = 1}};
  by_constants.shear_factor = 0.8;
  EXPECT_TRUE(
      has(refusal([&] { constants(by_constants); }), "Constants and matrices already contain the shear stiffness"));
  using Full = AncfBeam<Continuum<Locking::present>>;
  EXPECT_TRUE(has(refusal([] { Full::from(thick(0.8), 2); }), "without a shear factor"));
}

}  // namespace shear_factor_test
}  // namespace polybody
