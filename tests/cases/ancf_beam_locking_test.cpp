// Locking of the ANCF beam by continuum mechanics: S10 (derived in closed form) and the cantilever of Nachbagauer et
// al. 2011 (S4). The tests measure the size of the locking and check that the corrected element has none.

#include <polybody/bodies/ancf/ancf_beam.hpp>

#include <gtest/gtest.h>

#include "support/held.hpp"
#include "support/spatial_cantilever.hpp"

using namespace polybody;

namespace ancf_beam_locking_test {

using Plain = AncfBeam<Continuum<Locking::present>>;
using Cured = AncfBeam<Continuum<>>;

template <class B>
Vec3 tip(Bar const& bar, Index n, Vec3 const& force, int steps = 1) {
  return SpatialCantilever<B>(B::from(bar, n), {.force = force}, {.load_steps = steps}).tip_displacement();
}

/// Bar of 1 m × 1 cm × 1 cm.
Bar slender(double poisson) {
  return {.length = 1.0,
          .section = Rectangle{.height = 0.01, .width = 0.01},
          .material = Material{.density = 7850, .young = 2e11, .poisson = poisson}};
}

/// Ratio of a small tip deflection to P L³/3EI, for n elements and for the limit from 16 and 32. In linear theory n
/// elements have the bending part 1 − 1/4n², due to piecewise linear sections, and the shear part 3EI/(L² GA).
template <class B>
double ratio(Bar const& bar, Index n) {
  double const unit = 1e-4;  // [m]
  return tip<B>(bar, n, {0, 3 * constants(bar).EI * unit, 0})[1] / unit;
}
template <class B>
double limit_ratio(Bar const& bar) {
  return (4 * ratio<B>(bar, 32) - ratio<B>(bar, 16)) / 3;
}

// Factor (1 + ν)(1 − 2ν)/(1 − ν) of the deflection in bending and in shear with k = 1 (S10, closed form).
TEST(AncfLocking, FullHookesLawBendsWithTheConstrainedModulus) {
  double const shear = 3.0 / 12 * 1e-4;  // 3I/(L² A)
  auto const locked = [](char const* source, char const* formulation) {
    return Claim{"S10", "deflection over P L³/3EI, locked", By::closed_form, source, formulation};
  };
  Claim const line = locked("(1 + ν)(1 − 2ν)/(1 − ν) of bending, shear with k = 1",
                            "AncfBeam<Continuum>, locking left, 16 and 32 elements extrapolated");
  held(line, limit_ratio<Plain>(slender(0.3)), 0.742857142857 + shear * 2.6, 1e-6, {"ν = 0.3"});
  held(line, limit_ratio<Plain>(slender(0.0)), 1.0 + shear * 2.0, 1e-6, {"ν = 0"});
  held(locked("that times 1 − 1/4n², shear with k = 1", "AncfBeam<Continuum>, locking left, 8 elements"),
       ratio<Plain>(slender(0.3), 8), 0.742857142857 * (1 - 1.0 / 256) + shear * 2.6, 1e-6);
}

// Criterion of S10: 1.00 ± 0.01.
TEST(AncfLocking, CureBringsTheDeflectionBack) {
  for (double const nu : {0.0, 0.3, 0.45}) {
    BarConstants const c = constants(slender(nu));
    auto const cured = [](char const* formulation) {
      return Claim{"S10", "deflection over P L³/3EI, cured", By::closed_form, "1 + 3EI/(L² GA)", formulation};
    };
    Instance const at{equals("ν", nu)};
    held(cured("AncfBeam<Continuum>, 8 elements"), ratio<Cured>(slender(nu), 8), 1.0, 0.01, at);
    held(cured("AncfBeam<Continuum>, 16 and 32 elements extrapolated"), limit_ratio<Cured>(slender(nu)),
         1.0 + 3 * c.EI / c.GA, 1e-6, at);
  }
}

// The axial stretch is not affected (S10). The contraction −ν is not affected either.
template <class B>
void stretches_freely() {
  Bar const bar = slender(0.3);
  double const strain = 1e-6;
  SpatialCantilever<B> const c(B::from(bar, 4), {.force = {constants(bar).EA * strain, 0, 0}}, {});
  held({"S10", "stretch [m]", By::closed_form, "N L/EA",
        std::same_as<B, Plain> ? "AncfBeam<Continuum>, locking left, 4 elements" : "AncfBeam<Continuum>, 4 elements"},
       c.tip_displacement()[0], strain, 1e-5 * strain);
  Mat3 const e = c.bar.body().strain(c.bar.body().at(0.4), c.coordinates());
  EXPECT_NEAR(e(1, 1), -0.3 * strain, 1e-5 * strain);
  EXPECT_NEAR(e(2, 2), -0.3 * strain, 1e-5 * strain);
  Mat3 const s = c.bar.body().stress(c.bar.body().at(0.4), c.coordinates()).cauchy;
  EXPECT_NEAR(s(0, 0), 2e11 * strain, 1e-5 * 2e11 * strain);
  EXPECT_NEAR(s(1, 1), 0.0, 1e-5 * 2e11 * strain);
}
TEST(AncfLocking, StretchIsFree) {
  stretches_freely<Plain>();
  stretches_freely<Cured>();
}

Bar thick() {
  return {.length = 2.0,
          .section = Rectangle{.height = 0.5, .width = 0.1},
          .material = Material{.density = 7850, .young = 2.07e11, .poisson = 0.3}};
}

// Small load of Nachbagauer et al. 2011 (S4): published deflections of elements with linear sections, for each mesh.
// The tolerance is the size of the strain, 1e-4. The quadratic terms of E are far smaller.
TEST(AncfLocking, CuredMeshesHaveThePublishedDeflections) {
  struct {
    Index n;
    double u;
  } const published[] = {{1, 6.166665660910789e-04}, {2, 7.615940599560586e-04},  {4, 7.978259537503566e-04},
                         {8, 8.068839288072378e-04}, {16, 8.091484226773518e-04}, {32, 8.097145461515286e-04}};
  for (auto const& m : published)
    held({"S4", "u_y under 62.5 kN, mesh by mesh [m]", By::published,
          "Nachbagauer et al. 2011 (n = 1, 2, 4), Exudyn's ANCFBeamTest.py", "AncfBeam<Continuum>, 1 to 32 elements"},
         tip<Cured>(thick(), m.n, {0, 62500, 0})[1], m.u, 1e-6 * m.u, {equals("n", double(m.n))});
}

// Large load of S4: strains of the outer fibres reach F L h/2EI = 0.14. The law of St. Venant–Kirchhoff and the rod
// model differ at such strains. The results agree to a fraction of the strain.
TEST(AncfLocking, CuredBeamUnderALargeLoadIsTheRodUpToTheStrain) {
  Vec3 const exact(-0.1509711442396, 0.7105685978542, 0);
  held_within({"S4", "u_x and u_y under 62.5 MN [m]", By::independent, "shooting on the rod's equations",
               "AncfBeam<Continuum>, 32 elements; strains of 0.14"},
              (tip<Cured>(thick(), 32, {0, 6.25e7, 0}, 4) - exact).norm(), 0.14 * exact.norm() / 8,
              {.scale = exact.norm()});
}

}  // namespace ancf_beam_locking_test
