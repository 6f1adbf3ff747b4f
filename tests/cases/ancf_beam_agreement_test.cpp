// Comparison of the elastic forces of the ANCF beam after Wallin 2016. The elastic line and the continuum without
// locking agree in the limit of fine meshes, up to the size of the strain.

#include <polybody/bodies/ancf/ancf_beam.hpp>

#include <gtest/gtest.h>

#include <numbers>

#include "support/held.hpp"
#include "support/spatial_cantilever.hpp"

using namespace polybody;

namespace ancf_beam_agreement_test {

using Line = AncfBeam<ElasticLine>;
using Cured = AncfBeam<Continuum<>>;
using std::numbers::pi;

/// Richardson extrapolation of two meshes of order 2.
template <class Tip>
Vec3 limit(Tip&& tip) {
  return (4.0 * tip(32) - tip(16)) / 3.0;
}

// Bar that bends about both axes and twists under a tip force and a tip moment. The strains are at most 2e-3.
TEST(AncfElasticForces, AgreeOnABarBentAndTwisted) {
  Bar const bar{.length = 0.508,
                .section = Rectangle{.height = 12.3777e-3, .width = 3.2024e-3},
                .material = Material{.density = 2700, .young = 71.7e9, .poisson = 0.31}};
  TipLoad const load{.force = {0, -5, 5}, .moment = {0.4, 0, 0}};
  Vec3 const line = limit(
      [&](Index n) { return SpatialCantilever<Line>(Line::from(bar, n), load, {.load_steps = 2}).tip_displacement(); });
  Vec3 const cured = limit([&](Index n) {
    return SpatialCantilever<Cured>(Cured::from(bar, n), load, {.load_steps = 2}).tip_displacement();
  });
  EXPECT_GT(line.norm(), 0.07);
  held_within({"S4–S7", "tip of a bar bent and twisted [m]", By::itself, "AncfBeam on its elastic line",
               "AncfBeam<Continuum>, 16 and 32 elements extrapolated"},
              (cured - line).norm(), 2e-3 * line.norm(), {.scale = line.norm()});
}

// Elastica (S2) with α = 1 and EA = 1e6 EI/L²: a square section with side √12e-6 L. The strains are 1.7e-3.
TEST(AncfElasticForces, CuredContinuumMeetsTheElastica) {
  double const side = std::sqrt(12e-6);
  Bar const bar{.length = 1.0,
                .section = Rectangle{.height = side, .width = side},
                .material = Material{.density = 1, .young = 1e6 / (side * side), .poisson = 0.3}};
  Vec3 const u = limit([&](Index n) {
    return SpatialCantilever<Cured>(Cured::from(bar, n), {.force = {0, 1, 0}}, {.load_steps = 4}).tip_displacement();
  });
  held_within({"S2", "u/L and w/L of the tip, PL²/EI = 1", By::independent,
               "elliptic integrals, 40 digits; the decimals of Mattiasson 1981",
               "AncfBeam<Continuum>, 16 and 32 elements extrapolated"},
              (u - Vec3(-0.05643323628337688, 0.3017207737998135, 0)).cwiseAbs().maxCoeff(), 1e-5, {.scale = 0.3});
}

// 45° bend of Bathe & Bolourchi (S7) with Saint-Venant's GJ and GA = 5/6 · 5e6, the constants of the square section.
// Strains reach 1e-2.
TEST(AncfElasticForces, CuredContinuumMeetsTheCurvedRod) {
  Bar const bar{.length = 25 * pi,
                .section = Rectangle{.height = 1, .width = 1},
                .material = Material{.density = 1, .young = 1e7, .poisson = 0}};
  auto const bend = [](double s) {
    double const a = s / 100;
    return Placement{100 * Vec3(std::sin(a), 1 - std::cos(a), 0), exp_so3<double>(Vec3(0, 0, a))};
  };
  Vec3 const exact(46.8915863910, 15.5576762394, 53.6079863172), start(70.7106781187, 29.2893218813, 0);
  Vec3 const end = limit([&](Index n) {
    return SpatialCantilever<Cured>(Cured::from(bar, n, bend), {.force = {0, 0, 600}}, {.load_steps = 4}).tip();
  });
  held_within({"S7", "tip of the 45° bend [m]", By::independent, "shooting on the rod's equations",
               "AncfBeam<Continuum>, 16 and 32 elements extrapolated"},
              (end - exact).norm(), 1e-3 * (exact - start).norm(), {.scale = (exact - start).norm()});
}

}  // namespace ancf_beam_agreement_test
