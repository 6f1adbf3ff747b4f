// Cantilevers in space with Se3Beam, compared with closed forms and with an independent computation of the exact rod
// with the same constants: end moments (S5), Princeton beam (S6), 45° bend (S7), pre-twisted cantilever (S8), quarter
// circle (S8b), helix of five turns (S9f). Elements are of order 2.

#include <polybody/bodies/se3/se3_beam.hpp>

#include <gtest/gtest.h>

#include <numbers>

#include "support/held.hpp"
#include "support/spatial_cantilever.hpp"
#include "support/spatial_cantilevers.hpp"

using namespace polybody;

namespace se3_beam_statics_test {

using std::numbers::pi;
using Rod = SpatialCantilever<Se3Beam>;

Claim exact_rod(char const* case_id, char const* what, std::string const& formulation) {
  return {case_id, what, By::independent, "shooting on the rod's equations", formulation};
}

/// Extrapolation of u(n) and u(2n).
template <class F>
Vec3 extrapolated(F&& u, Index n) {
  return (4.0 * u(2 * n) - u(n)) / 3.0;
}

// ---- S1: roll-up. One element is exact up to half a circle.
TEST(Se3RollUp, FewElementsBecomeTheCircle) {
  Bar const bar{.length = 1.0,
                .constants = BarConstants{
                    .EA = 300, .EI = 1, .mass_per_length = 1, .GA = 200, .GJ = 0.7, .rotary_inertia = 1e-3}};
  struct {
    Index elements;
    double theta;
    char const* name;
  } const arcs[] = {{1, 0.5 * pi, "Se3Beam, 1 element"}, {3, 2 * pi, "Se3Beam, 3 elements"}};
  for (auto const& [n, theta, name] : arcs)
    for (double const axis : {0.0, 1.3}) {
      Vec3 const about(0, -std::sin(axis), std::cos(axis)), across(0, std::cos(axis), std::sin(axis));
      Rod const rod(Se3Beam::from(bar, n), {.moment = theta * about}, {.load_steps = 10});
      Claim const arc{"S1", "tip of the bar rolled up about any axis, and its turn", By::closed_form,
                      "arc of curvature M/EI", name};
      Vec3 const exact = std::sin(theta) / theta * Vec3::UnitX() + (1 - std::cos(theta)) / theta * across;
      Instance const at{equals("θ", theta) + equals(", axis", axis), 1.0};
      held_within(arc, (rod.tip() - exact).norm(), 1e-10, at);
      held_within(arc, (rod.tip_turn() - exp_so3<double>(theta * about)).norm(), 1e-9, at);
    }
}

// ---- S5: end moments of Nachbagauer, Gruber & Gerstmayr 2013

Vec3 end_moments(Index n, LoadAxes axes) {
  double const e = 2.07e11, g = e / 2.6, h = 0.2, w = 0.4, a = h * w, iz = w * h * h * h / 12, iy = h * w * w * w / 12;
  Bar const bar{.length = 2.0,
                .constants = BarConstants{.EA = e * a,
                                          .EI = e * iz,
                                          .mass_per_length = 1,
                                          .GA = 0.8331 * g * a,
                                          .GJ = 0.5768 * g * (iy + iz),
                                          .EI_y = e * iy,
                                          .GA_z = 0.7961 * g * a}};
  return Rod(Se3Beam::from(bar, n), {.moment = {0.5e6, 2e6, 0}, .axes = axes}, {}).tip_displacement();
}
TEST(Se3EndMoments, MeetTheExactRod) {
  struct {
    LoadAxes axes;
    char const* what;
    Vec3 exact;
  } const rows[] = {
      {LoadAxes::world, "tip under dead moments [m]", {-1.0943798558e-4, -1.8643645616e-4, -1.81174027438e-2}},
      {LoadAxes::marker, "tip under following moments [m]", {-1.0949948006e-4, 6.6856646766e-4, -1.81128138084e-2}}};
  for (auto const& row : rows)
    held_within(exact_rod("S5", row.what, "Se3Beam, 16 and 32 elements extrapolated"),
                (extrapolated([&](Index n) { return end_moments(n, row.axes); }, 16) - row.exact).norm(), 1e-11,
                {.scale = row.exact.norm()});
}

// ---- S6: the Princeton beam of Dowell & Traybar 1975

TEST(Se3PrincetonBeam, MeetsTheExactRod) {
  struct {
    double force, degrees;
    Vec3 tip;
    double twist;
  } const rows[] = {{4.448, 45, {-0.003748208, -0.003976434, 0.056063501}, 0.008014200},
                    {8.896, 30, {-0.007680972, -0.010207614, 0.079547377}, 0.027815698},
                    {13.345, 0, {-0.000304668, -0.016061179, 0}, 0},
                    {13.345, 15, {-0.005340668, -0.016577652, 0.064734218}, 0.038678936},
                    {13.345, 45, {-0.030452935, -0.015621150, 0.156774618}, 0.064003675},
                    {13.345, 90, {-0.050401015, 0, 0.200683961}, 0}};
  for (auto const& row : rows) {
    double const beta = row.degrees * pi / 180;
    auto const at = [&](Index n) {
      return Rod(Se3Beam::from(spatial_cantilevers::princeton(), n),
                 {.force = row.force * Vec3(0, -std::cos(beta), std::sin(beta))}, {.load_steps = 2});
    };
    auto const twist = [](Rod const& rod) { return std::atan2(rod.tip_turn()(2, 1), rod.tip_turn()(1, 1)); };
    Rod const a = at(8), b = at(32), c = at(64);
    Instance const load{equals("F", row.force) + equals(" N, β", row.degrees), row.tip.norm()};
    held_within(exact_rod("S6", "tip of the Princeton beam [m]", "Se3Beam, 8 elements"),
                (a.tip_displacement() - row.tip).norm(), 5e-3 * row.tip.norm(), load);
    held_within(exact_rod("S6", "tip of the Princeton beam [m]", "Se3Beam, 32 and 64 elements extrapolated"),
                ((4.0 * c.tip_displacement() - b.tip_displacement()) / 3.0 - row.tip).norm(), 2e-9, load);
    held(exact_rod("S6", "twist of the tip [rad]", "Se3Beam, 32 and 64 elements extrapolated"),
         (4.0 * twist(c) - twist(b)) / 3.0, row.twist, 2e-9, {load.at, 0.064});
  }
}

// ---- S7: the 45° bend of Bathe & Bolourchi

struct Bend {
  double GA, GJ, force;
  Vec3 tip;
};
double const twelfth = 1e7 / 12, polar = twelfth, saint_venant = 0.1405770150 * 5e6;
Bend const bends[] = {{5e6, polar, 300, {58.7791224897, 22.2447809454, 40.1918916701}},
                      {5e6, polar, 600, {47.1504385736, 15.6848005340, 53.4748587918}},
                      {5e6, polar, 3000, {23.0243082249, 4.2328759166, 68.5390894931}},
                      {5e6 / 1.2, polar, 600, {47.1500962403, 15.6846894790, 53.4754779982}},
                      {5e6 / 1.2, saint_venant, 600, {46.8915863910, 15.5576762394, 53.6079863172}}};
Vec3 bend_tip(Index n, Bend const& b) {
  Bar const bar = spatial_cantilevers::bend_bar(b.GA, b.GJ);
  return Rod(Se3Beam::from(bar, n, spatial_cantilevers::bend_curve), {.force = {0, 0, b.force}},
             {.load_steps = b.force > 1000 ? 8 : 2})
      .tip();
}
// Tolerance relative to the displacement: 0.5 % with 8 elements and a sixteenth of it with 32, for order 2. The largest
// error of 8 elements is 0.41 %, that of Lrvf is below 0.3 %.
TEST(Se3FortyFiveDegreeBend, MeetsTheExactRod) {
  Vec3 const start = 100.0 * Vec3(std::sin(pi / 4), 1 - std::cos(pi / 4), 0);
  for (Bend const& b : bends) {
    double const u = (b.tip - start).norm();
    Vec3 const coarse = bend_tip(32, b), fine = bend_tip(64, b);
    char const* const what = "tip of the 45° bend, of its displacement";
    Instance const at{equals("F", b.force) + equals(", GJ", b.GJ), 1.0};
    held_within(exact_rod("S7", what, "Se3Beam, 8 elements"), (bend_tip(8, b) - b.tip).norm() / u, 5e-3, at);
    held_within(exact_rod("S7", what, "Se3Beam, 32 elements"), (coarse - b.tip).norm() / u, 5e-3 / 16, at);
    held_within(exact_rod("S7", what, "Se3Beam, 32 and 64 elements extrapolated"),
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
  return Rod(Se3Beam::from(bar, n, twist), {.force = force}, {}).tip_displacement();
}
TEST(Se3PreTwistedCantilever, MeetsTheExactRod) {
  Vec3 const y = extrapolated([](Index n) { return twisted_tip(n, {0, 1, 0}); }, 64);
  Vec3 const z = extrapolated([](Index n) { return twisted_tip(n, {0, 0, 1}); }, 64);
  char const* const meshes = "Se3Beam, 64 and 128 elements extrapolated";
  held(exact_rod("S8", "u_x under a force along y [in]", meshes), y[0], -1.58e-6, 5e-9);
  held(exact_rod("S8", "u_x under a force along z [in]", meshes), z[0], -3.6e-7, 5e-9);
  held_within(exact_rod("S8", "u_y and u_z under a force along y [in]", meshes),
              (y - Vec3(0, 5.4293204e-3, 1.7187433e-3)).tail<2>().norm(), 1e-10, {.scale = 5.7e-3});
  held_within(exact_rod("S8", "u_y and u_z under a force along z [in]", meshes),
              (z - Vec3(0, 1.7187438e-3, 1.7496234e-3)).tail<2>().norm(), 1e-10, {.scale = 2.5e-3});
}

// ---- S8b: a quarter circle under unit forces, linear, by Castigliano's theorem

TEST(Se3CurvedCantilever, BendsAsCastiglianoSays) {
  double const radius = 4.22, small = 1e-3, r3 = std::pow(radius, 3);
  Bar const bar{.length = 0.5 * pi * radius,
                .section = Rectangle{.height = 0.2, .width = 0.1},
                .material = Material{.density = 1.0, .young = 1e7, .poisson = 0.25}};
  auto const arc = [&](double s) {
    double const a = s / radius;
    return Placement::at(radius * Vec3(std::sin(a), 1 - std::cos(a), 0), Vec3(0, 0, a));
  };
  auto const tip = [&](Index n, Vec3 const& force) {
    auto const under = [&](double part) {
      return Rod(Se3Beam::from(bar, n, arc), {.force = part * force}, {}).tip_displacement();
    };
    return Vec3((under(small) - under(-small)) / (2.0 * small));
  };
  auto const limit = [&](Vec3 const& force) { return extrapolated([&](Index n) { return tip(n, force); }, 32); };
  BarConstants const c = constants(bar);
  double const in_plane = pi * r3 / (4 * c.EI) + pi * radius / 4 * (1 / c.EA + 1 / c.GA);
  double const out_of_plane = pi * r3 / (4 * *c.EI_y) + (0.75 * pi - 2) * r3 / c.GJ + pi * radius / (2 * *c.GA_z);
  Claim const castigliano{"S8b", "tip of the quarter circle along its unit force", By::closed_form,
                          "Castigliano, with shear", "Se3Beam, 32 and 64 elements extrapolated"};
  held(castigliano, limit({1, 0, 0})[0], in_plane, 1e-6 * in_plane, {"in the plane"});
  held(castigliano, limit({0, 0, 1})[2], out_of_plane, 1e-6 * out_of_plane, {"out of the plane"});
}

// ---- S9f: cantilever of Ibrahimbegović 1997, wound into a helix

TEST(Se3CantileverToHelix, MeetsTheExactRodThroughFiveTurns) {
  struct {
    double lambda;
    Vec3 tip;
  } const windings[] = {{0.1, {0.410203353, 0.053770903, -1.091729019}},
                        {0.5, {0.019106995, 0.000573980, -0.226637441}}};
  Bar const bar{.length = 10.0,
                .constants = BarConstants{.EA = 1e4, .EI = 100, .mass_per_length = 1, .GA = 1e4, .GJ = 100}};
  for (auto const& [lambda, exact] : windings) {
    auto const tip = [&](Index n) {
      return Rod(Se3Beam::from(bar, n), {.force = {0, 0, 50 * lambda}, .moment = {0, 0, 200 * pi * lambda}},
                 {.load_steps = int(100 * lambda)})
          .tip();
    };
    Vec3 const coarse = tip(50), fine = tip(100);
    Instance const at{equals("λ", lambda), exact.norm()};
    held_within(exact_rod("S9f", "tip of the helix [m]", "Se3Beam, 100 elements"), (fine - exact).norm(), 5e-3, at);
    held_within(exact_rod("S9f", "tip of the helix [m]", "Se3Beam, 50 and 100 elements extrapolated"),
                ((4.0 * fine - coarse) / 3.0 - exact).norm(), 1e-4, at);
  }
}

}  // namespace se3_beam_statics_test
