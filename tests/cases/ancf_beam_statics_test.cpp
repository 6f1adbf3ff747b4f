// Statics of the fully parameterised ANCF beam on its elastic line: elastica (S2), Nachbagauer et al. 2011 (S4), end
// moments (S5), Princeton beam (S6), 45° bend (S7). The limit of fine meshes is the exact rod, which an independent
// computation gives. The element bends with piecewise linear sections and has order 2. The extrapolation of two
// meshes agrees with the rod.

#include <polybody/bodies/ancf/ancf_beam.hpp>

#include <gtest/gtest.h>

#include <numbers>

#include "support/held.hpp"
#include "support/spatial_cantilever.hpp"
#include "support/spatial_cantilevers.hpp"

using namespace polybody;

namespace ancf_beam_statics_test {

using Beam = AncfBeam<>;
using std::numbers::pi;

SpatialCantilever<Beam> cantilever(Bar const& bar, Index n, TipLoad const& load, int steps = 1) {
  return {Beam::from(bar, n), load, {.load_steps = steps}};
}
/// Richardson extrapolation of two meshes of order 2.
Vec3 limit(Vec3 const& coarse, Vec3 const& fine) { return (4.0 * fine - coarse) / 3.0; }

Claim shooting(char const* case_id, char const* what, char const* formulation) {
  return {case_id, what, By::independent, "shooting on the rod's equations", formulation};
}
char const* const extrapolated = "AncfBeam, 32 and 64 elements extrapolated";
char const* const coarser = "AncfBeam, 16 and 32 elements extrapolated";

// ---- S2: slender elastica, α = 1; tolerances of linear elements: 1e-3 with 16 elements, 1e-4 with 64

TEST(AncfElastica, DeadTipForce) {
  Bar const bar{.length = 1.0,
                .constants = BarConstants{
                    .EA = 1e6, .EI = 1.0, .mass_per_length = 1.0, .GA = 1e6, .GJ = 1.0, .rotary_inertia = 1e-6}};
  Vec3 const exact(-0.05643323628337688, 0.3017207737998135, 0);
  auto const tip = [&](Index n) { return cantilever(bar, n, {.force = {0, 1, 0}}, 4).tip_displacement(); };
  Vec3 const coarse = tip(32), fine = tip(64);
  auto const elastica = [](char const* formulation) {
    return Claim{"S2", "u/L and w/L of the tip, PL²/EI = 1", By::independent,
                 "elliptic integrals, 40 digits; the decimals of Mattiasson 1981", formulation};
  };
  Instance const at{.scale = 0.3};
  held_within(elastica("AncfBeam, 16 elements"), (tip(16) - exact).cwiseAbs().maxCoeff(), 1e-3, at);
  held_within(elastica("AncfBeam, 64 elements"), (fine - exact).cwiseAbs().maxCoeff(), 1e-4, at);
  // stretch α/EA plus the remaining error of order 4
  held_within(elastica(extrapolated), (limit(coarse, fine) - exact).cwiseAbs().maxCoeff(), 1e-6 + 1e-6, at);
}

// ---- S4: Nachbagauer, Pechstein, Irschik & Gerstmayr 2011

Bar thick() {
  return {.length = 2.0,
          .section = Rectangle{.height = 0.5, .width = 0.1},
          .material = Material{.density = 7850, .young = 2.07e11, .poisson = 0.3}};
}
double const small = 62500, large = 6.25e7;

// The paper and Exudyn print deflections of elements with linear sections. With linear strains the deflections here
// are equal, up to the square of the rotation, θ² = 3.4e-7.
TEST(AncfNachbagauer, SmallLoadGivesThePublishedDeflectionOfEveryMesh) {
  struct {
    Index n;
    double u;
  } const published[] = {{1, 6.166665660910789e-04}, {2, 7.615940599560586e-04},  {4, 7.978259537503566e-04},
                         {8, 8.068839288072378e-04}, {16, 8.091484226773518e-04}, {32, 8.097145461515286e-04},
                         {64, 8.098560770202866e-04}};
  for (auto const& m : published)
    held({"S4", "u_y under 62.5 kN, mesh by mesh [m]", By::published,
          "Nachbagauer et al. 2011 (n = 1, 2, 4), Exudyn's ANCFBeamTest.py", "AncfBeam, 1 to 64 elements"},
         cantilever(thick(), m.n, {.force = {0, small, 0}}).tip_displacement()[1], m.u, 3.4e-7 * m.u,
         {equals("n", double(m.n))});
}

TEST(AncfNachbagauer, SmallLoadConvergesToTheExactRod) {
  auto const tip = [](Index n) { return cantilever(thick(), n, {.force = {0, small, 0}}).tip_displacement(); };
  Vec3 const u = limit(tip(32), tip(64));
  held(shooting("S4", "u_x under 62.5 kN [m]", extrapolated), u[0], -1.8884916364e-7, 1e-6 * 1.9e-7);
  held(shooting("S4", "u_y under 62.5 kN [m]", extrapolated), u[1], 8.0990325398e-4, 1e-8 * 8.1e-4);
}

TEST(AncfNachbagauer, LargeLoadConvergesToTheExactRodWithOrderTwo) {
  Vec3 const exact(-0.1509711442396, 0.7105685978542, 0);
  auto const tip = [](Index n) { return cantilever(thick(), n, {.force = {0, large, 0}}, 3).tip_displacement(); };
  Vec3 const coarse = tip(32), fine = tip(64);
  EXPECT_NEAR((coarse - exact).norm() / (fine - exact).norm(), 4.0, 0.02);
  held_within(shooting("S4", "u_x and u_y under 62.5 MN [m]", extrapolated), (limit(coarse, fine) - exact).norm(), 1e-7,
              {.scale = 0.7});
}

// The weld constrains the position and the frame of the section at the clamp, and nothing else. The angle between
// axis and section is F/GA at the clamp, as in the rod. The strains of the section itself vanish there, as in every
// section. The section forces at the clamp are F and the moment F L.
TEST(AncfNachbagauer, WeldIsTheClampOfTheRod) {
  auto const c = cantilever(thick(), 32, {.force = {0, small, 0}});
  Beam const& body = c.bar.body();
  auto const clamp = body.at(0.0), inside = body.at(0.5 * body.element_length());
  double const ga = body.constants().GA;
  EXPECT_NEAR(body.section_strains(clamp, c.coordinates())[1], small / ga, 2e-3 * small / ga);
  EXPECT_LT(body.section_deformation(clamp, c.coordinates()).norm(), 1e-9);
  EXPECT_NEAR(body.section_forces(inside, c.coordinates())[5], small * 2.0 * (1 - 0.5 / 32), 1e-3 * small * 2.0);
}

// ---- S5: moments fixed in space, and follower moments

Bar general() {
  double const e = 2.07e11, g = e / 2.6, h = 0.2, w = 0.4, a = h * w, iz = w * h * h * h / 12, iy = h * w * w * w / 12;
  return {.length = 2.0,
          .constants = BarConstants{.EA = e * a,
                                    .EI = e * iz,
                                    .mass_per_length = 1,
                                    .GA = 0.8331 * g * a,
                                    .GJ = 0.5768 * g * (iy + iz),
                                    .rotary_inertia = 0.01,
                                    .EI_y = e * iy,
                                    .GA_z = 0.7961 * g * a}};
}

TEST(AncfEndMoments, FixedInSpace) {
  auto const run = [](Index n) { return cantilever(general(), n, {.moment = {0.5e6, 2e6, 0}}); };
  auto const coarse = run(16), fine = run(32);
  held_within(shooting("S5", "tip under dead moments [m]", coarser),
              (limit(coarse.tip_displacement(), fine.tip_displacement()) -
               Vec3(-1.0943798558e-4, -1.8643645616e-4, -1.81174027438e-2))
                  .norm(),
              1e-12 + 1e-9 * 1.8e-2, {.scale = 1.8e-2});
  Mat3 const exact = exp_so3<double>(Vec3(0.016323712401, 0.018117169413, -0.000427522396));
  held_within(shooting("S5", "rotation of the tip under dead moments", "AncfBeam, 32 elements"),
              (fine.tip_turn() - exact).norm(), 2e-6 * 0.024, {.scale = 0.024});
}

TEST(AncfEndMoments, Following) {
  auto const tip = [](Index n) {
    return cantilever(general(), n, {.moment = {0.5e6, 2e6, 0}, .axes = LoadAxes::marker}).tip_displacement();
  };
  held_within(shooting("S5", "tip under following moments [m]", coarser),
              (limit(tip(16), tip(32)) - Vec3(-1.0949948006e-4, 6.6856646766e-4, -1.81128138084e-2)).norm(),
              1e-9 * 1.8e-2, {.scale = 1.8e-2});
}

// ---- S6: the Princeton beam of Dowell & Traybar 1975, deflections and twist

TEST(AncfPrinceton, MeetsTheExactRod) {
  Bar const bar = spatial_cantilevers::princeton();
  struct {
    double force, beta;  ///< [N], [deg]
    Vec3 u;
    double twist;
  } const rows[] = {{4.448, 30, {-0.001917936, -0.004757606, 0.039959865}, 0.007028831},
                    {8.896, 45, {-0.014411825, -0.008979197, 0.109113115}, 0.030601604},
                    {13.345, 60, {-0.041257301, -0.011963546, 0.182003786}, 0.050891680},
                    {13.345, 90, {-0.050401015, 0, 0.200683961}, 0}};
  for (auto const& row : rows) {
    double const beta = row.beta * pi / 180;
    auto const run = [&](Index n) {
      return cantilever(bar, n, {.force = {0, -row.force * std::cos(beta), row.force * std::sin(beta)}}, 2);
    };
    auto const twist = [](auto const& c) { return std::atan2(c.tip_turn()(2, 1), c.tip_turn()(1, 1)); };
    auto const coarse = run(8), middle = run(16), fine = run(32);
    char const* const tip = "tip of the Princeton beam [m]";
    double const size = row.u.norm();
    Instance const at{equals("F", row.force) + " N, " + equals("β", row.beta), size};
    held_within(shooting("S6", tip, "AncfBeam, 8 elements"), (coarse.tip_displacement() - row.u).norm(), 5e-3 * size,
                at);
    held_within(shooting("S6", tip, "AncfBeam, 32 elements"), (fine.tip_displacement() - row.u).norm(), 3e-4 * size,
                at);
    held_within(shooting("S6", tip, coarser),
                (limit(middle.tip_displacement(), fine.tip_displacement()) - row.u).norm(), 1e-5 * size, at);
    held(shooting("S6", "twist of the tip [rad]", coarser), (4 * twist(fine) - twist(middle)) / 3, row.twist, 1e-5,
         {at.at, 0.06});
  }
}

// ---- S7: the 45° bend of Bathe & Bolourchi

Vec3 bathe(Bar bar, Index n, double force) {
  bar.length = spatial_cantilevers::bend_bar(1, 1).length;
  return SpatialCantilever<Beam>(Beam::from(bar, n, spatial_cantilevers::bend_curve), {.force = {0, 0, force}},
                                 {.load_steps = 4})
      .tip();
}
TEST(AncfBatheBolourchi, MeetsTheExactRod) {
  struct {
    double ga, gj, force;
    Vec3 tip;
  } const rows[] = {{5e6, 1e7 / 12, 300, {58.7791224897, 22.2447809454, 40.1918916701}},
                    {5e6, 1e7 / 12, 600, {47.1504385736, 15.6848005340, 53.4748587918}},
                    {5e6, 1e7 / 12, 3000, {23.0243082249, 4.2328759166, 68.5390894931}},
                    {5e7 / 12, 1e7 / 12, 600, {47.1500962403, 15.6846894790, 53.4754779982}}};
  for (auto const& row : rows) {
    Bar const bar = spatial_cantilevers::bend_bar(row.ga, row.gj);
    Vec3 const coarse = bathe(bar, 32, row.force), fine = bathe(bar, 64, row.force);
    // Straight elements have errors of about 3e-3 and 2e-4 at 600 N (S7). The errors here are 4.3e-3 and 2.5e-4 at
    // 600 N, and 7.5e-3 and 3.8e-4 at 3000 N.
    char const* const what = "tip of the 45° bend [m]";
    double const size = row.tip.norm();
    Instance const at{equals("F", row.force) + ", " + equals("GA", row.ga), size};
    held_within(shooting("S7", what, "AncfBeam, 8 elements"), (bathe(bar, 8, row.force) - row.tip).norm(), 8e-3 * size,
                at);
    held_within(shooting("S7", what, "AncfBeam, 32 elements"), (coarse - row.tip).norm(), 4e-4 * size, at);
    held_within(shooting("S7", what, extrapolated), (limit(coarse, fine) - row.tip).norm(), 3e-6 * size, at);
  }
}

// Saint-Venant's constants of S7, GJ = 0.1405770150·5e6 and GA = 5/6·5e6, are the constants of the bar's square
// section with ν = 0.
TEST(AncfBatheBolourchi, SectionGivesTheSaintVenantConstants) {
  Bar const square{.length = 1.0,
                   .section = Rectangle{.height = 1, .width = 1},
                   .material = Material{.density = 1, .young = 1e7, .poisson = 0}};
  Vec3 const exact(46.8915863910, 15.5576762394, 53.6079863172);
  held_within(shooting("S7", "tip of the 45° bend [m]", extrapolated),
              (limit(bathe(square, 32, 600), bathe(square, 64, 600)) - exact).norm(), 3e-6 * exact.norm(),
              {"F = 600, constants of the section", exact.norm()});
}

}  // namespace ancf_beam_statics_test
