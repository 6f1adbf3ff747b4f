// Short cantilevers with stretch and shear: Gerstmayr & Irschik 2008 (S3), Nachbagauer et al. 2011 (S4) and the
// inclined cantilever S4b. References are published values for each mesh and an independent computation of the exact
// rod.

#include <polybody/bodies/ancf/planar_ancf_cable.hpp>
#include <polybody/bodies/lrvf/planar_lrvf.hpp>
#include <polybody/bodies/se3/planar_se3_beam.hpp>

#include <gtest/gtest.h>

#include <numbers>

#include "support/cantilever.hpp"
#include "support/held.hpp"

using namespace polybody;

namespace statics_cantilever_test {

using Cable = planar::AncfCable<planar::EngineeringStrain>;
using planar::Lrvf, planar::Se3Beam;

struct Mesh {
  Index n;
  double x, y;  ///< tip displacement
};

// ---- S3: Gerstmayr & Irschik 2008

Vec3 gerstmayr_irschik(Index n) {
  Bar const bar{.length = 2.0,
                .section = Rectangle{.height = 0.1, .width = 0.1},
                .material = Material{.density = 7850, .young = 2.07e11}};
  double const force = 3.0 * 1.725e6 / 4.0;  // 3 EI/L²
  return Cantilever<Cable>(Cable::from(bar, n), {.force = {0, -force}}, {.load_steps = 5}).tip_displacement();
}

// Published values: Exudyn, ANCFcantileverTest.py, full integration.
TEST(GerstmayrIrschik, EveryMeshGivesThePublishedDigits) {
  constexpr Mesh published[] = {
      {1, -0.36224472989050654, -0.9941447587249747}, {2, -0.4889263086109102, -1.1752228652637502},
      {4, -0.5074287154557922, -1.2055337025602493},  {8, -0.5085092365729895, -1.207197756093103},
      {16, -0.5085365799149556, -1.207238895003594},  {32, -0.508537277761696, -1.2072398264650905},
      {64, -0.5085373030408489, -1.207239853404364}};
  for (Mesh const& m : published) {
    Vec3 const u = gerstmayr_irschik(m.n);
    Claim claim{"S3", "u_x of the tip, mesh by mesh [m]", By::published,
                "Gerstmayr & Irschik 2008, Exudyn's ANCFcantileverTest.py", "planar AncfCable, 1 to 64 elements"};
    Instance const at{equals("n", double(m.n))};
    held(claim, u[0], m.x, 1e-9, at);
    claim.what = "u_y of the tip, mesh by mesh [m]";
    held(claim, u[1], m.y, 1e-9, at);
  }
}

/// Claim about the exact rod of the independent computation.
Claim exact_rod(char const* case_id, char const* what, std::string const& formulation) {
  return {case_id, what, By::independent, "shooting on the rod's equations", formulation};
}

// Extensible rod (independent computation).
TEST(GerstmayrIrschik, MeshesConvergeToTheExactRod) {
  Vec3 const exact(-0.508537304325871, -1.207239854549803, -0.986237330266), coarse = gerstmayr_irschik(64),
                                                                             fine = gerstmayr_irschik(128);
  held_within(exact_rod("S3", "u_x, u_y [m] and slope of the tip", "planar AncfCable, 128 elements"),
              (fine - exact).cwiseAbs().maxCoeff(), 1e-9, {.scale = 0.5});
  EXPECT_GT((coarse - exact).norm() / (fine - exact).norm(), 14.0);  // order 4
}

// Rods with shear, which do not lock in their thin limit. With GA = 1e6 EA, shear adds F L/GA, 1e-9. Extrapolation
// removes the errors in h² and h⁴.
template <class B>
void converges_without_shear(std::string const& body) {
  Bar const bar{.length = 2.0,
                .constants = BarConstants{.EA = 2.07e9, .EI = 1.725e6, .mass_per_length = 78.5, .GA = 2.07e15}};
  Vec3 const exact(-0.508537304325871, -1.207239854549803, -0.986237330266);
  auto const tip = [&](Index n) {
    return Cantilever<B>(B::from(bar, n), {.force = {0, -3.0 * 1.725e6 / 4.0}}, {.load_steps = 5}).tip_displacement();
  };
  Vec3 const a = tip(32), b = tip(64), c = tip(128), once = (4.0 * b - a) / 3.0, twice = (4.0 * c - b) / 3.0;
  EXPECT_NEAR((a - exact).norm() / (b - exact).norm(), 4.0, 0.01);
  held_within(exact_rod("S3", "u_x, u_y [m] and slope of the tip", body + ", 32 to 128 elements extrapolated"),
              ((16.0 * twice - once) / 15.0 - exact).cwiseAbs().maxCoeff(), 5e-9, {.scale = 0.5});
}
TEST(GerstmayrIrschik, LrvfWithoutShearConvergesToTheExactRod) { converges_without_shear<Lrvf>("planar Lrvf"); }
TEST(GerstmayrIrschik, Se3BeamWithoutShearConvergesToTheExactRod) {
  converges_without_shear<Se3Beam>("planar Se3Beam");
}

// ---- S4: Nachbagauer, Pechstein, Irschik & Gerstmayr 2011

Bar thick(double angle = 0.0) {
  return {.length = 2.0,
          .section = Rectangle{.height = 0.5, .width = 0.1},
          .material = Material{.density = 7850, .young = 2.07e11, .poisson = 0.3},
          .placement = Placement::planar(0, 0, angle)};
}
constexpr double h3 = 0.125;  // h³ [m³]

template <class B>
Cantilever<B> nachbagauer(Index n, double force) {
  return {B::from(thick(), n), {.force = {0, force}}, {.load_steps = 5}};
}

// The element of the paper interpolates slope vectors, the ones here the angle. S4 does not distinguish them. They are
// equal in linear theory only, so the published digits hold up to the square of the rotation, θ² = 3.4e-7. Sources:
// the paper (1, 2, 4 elements) and Exudyn. The shortening is itself of the order of θ². The arcs of Se3Beam shorten by
// φ²/24 more than chords, so that its shortening has other digits.
template <class B>
void gives_the_published_meshes(std::string const& body) {
  constexpr Mesh published[] = {
      {1, 9.122730637578513e-08, 6.166665660910789e-04},   {2, 1.612930911054633e-07, 7.615940599560586e-04},
      {4, 1.8176323512975046e-07, 7.978259537503566e-04},  {8, 1.8706537496804287e-07, 8.068839288072378e-04},
      {16, 1.8840244964124508e-07, 8.091484226773518e-04}, {32, 1.887374359021976e-07, 8.097145461515286e-04},
      {64, 1.888212299849812e-07, 8.098560770202866e-04},  {256, 1.8884741770364144e-07, 8.099003054122335e-04}};
  for (Mesh const& m : published) {
    Vec3 const u = nachbagauer<B>(m.n, 5e5 * h3).tip_displacement();
    Claim claim{"S4", "shortening under 62.5 kN, mesh by mesh [m]", By::published,
                "Nachbagauer et al. 2011 (n = 1, 2, 4), Exudyn's ANCFBeamTest.py", body + ", 1 to 256 elements"};
    Instance const at{equals("n", double(m.n))};
    if (std::is_same_v<B, Lrvf>) held(claim, -u[0], m.x, 3.4e-7 * m.x, at);
    claim.what = "u_y under 62.5 kN, mesh by mesh [m]";
    held(claim, u[1], m.y, 3.4e-7 * m.y, at);
  }
}
TEST(Nachbagauer, SmallLoadGivesThePublishedMeshesUpToTheSquareOfTheRotation) {
  gives_the_published_meshes<Lrvf>("planar Lrvf");
  gives_the_published_meshes<Se3Beam>("planar Se3Beam");
}

// Linear theory with constant strains (closed form): the bending part F L³/3EI is smaller by the factor 1 − 1/(4n²),
// and the shear part F L/GA is exact.
template <class B>
void follows_linear_theory(std::string const& body) {
  BarConstants const k = constants(thick());
  double const f = 5e5 * h3;
  for (Index const n : {1, 2, 4, 8, 16}) {
    double const linear = f * 8.0 / (3.0 * k.EI) * (1.0 - 0.25 / double(n * n)) + f * 2.0 / k.GA;
    held({"S4", "u_y under 62.5 kN, mesh by mesh [m]", By::closed_form,
          "linear theory: F L³/3EI (1 − 1/4n²) + F L/GA, up to θ²", body + ", 1 to 16 elements"},
         nachbagauer<B>(n, f).tip_displacement()[1], linear, 3.4e-7 * linear, {equals("n", double(n))});
  }
}
TEST(Nachbagauer, SmallLoadFollowsLinearTheory) {
  follows_linear_theory<Lrvf>("planar Lrvf");
  follows_linear_theory<Se3Beam>("planar Se3Beam");
}

// Conditions on a mesh under a tip force, node by node, without matrices (derived). With the relative rotation φ and
// the chord Δr of an element, and its axes t₁, t₂ at the mean angle of its nodes,
//   (1 + ε, γ) = g (t₁, t₂)·Δr/l,
// with g = 1 for Lrvf and g = (φ/2)/sin(φ/2) for Se3Beam. The nodes of each element carry the force F = g (N t₁ + Q
// t₂). With a = ½ l (N γ − Q (1 + ε)) and b = l (g′/g) (N (1 + ε) + Q γ), the moments are in balance at each node:
//   M_k + a_k + b_k = M_{k+1} − a_{k+1} + b_{k+1},  M = EI κ.
template <class B>
void balances(Cantilever<B> const& c, Index n, Vec2 const& force) {
  BarConstants const k = c.bar.body().constants();
  double const l = c.bar.body().element_length();
  double beyond = 0.0;  // right side, of the next element
  for (Index e = n; e-- > 0;) {
    Vec3 const from = c.at(double(e) * l), to = c.at(double(e + 1) * l);
    double const angle = 0.5 * (from[2] + to[2]), phi = to[2] - from[2];
    bool const chord = std::is_same_v<B, Lrvf>;
    double const g = chord ? 1.0 : 0.5 * phi / std::sin(0.5 * phi);
    double const slope = chord ? 0.0 : 1.0 / phi - 0.5 / std::tan(0.5 * phi);  // g′/g
    Vec2 const t1(std::cos(angle), std::sin(angle)), t2(-t1[1], t1[0]);
    double const pull = force.dot(t1) / g, push = force.dot(t2) / g, along = 1.0 + pull / k.EA, across = push / k.GA;
    EXPECT_LT((g * (to - from).head<2>() - l * (along * t1 + across * t2)).norm(), 1e-12);
    double const moment = k.EI * phi / l, a = 0.5 * l * (pull * across - push * along),
                 b = l * slope * (pull * along + push * across);
    EXPECT_NEAR(moment + a + b, beyond, 1e-10 * force.norm() * c.bar.body().length());
    beyond = moment - a + b;
  }
}

TEST(Nachbagauer, LargeLoadBalancesAtEveryNodeOfEveryMesh) {
  for (Index const n : {1, 2, 4, 8, 16, 32, 64}) {
    balances(nachbagauer<Lrvf>(n, 5e8 * h3), n, {0, 5e8 * h3});
    balances(nachbagauer<Se3Beam>(n, 5e8 * h3), n, {0, 5e8 * h3});
  }
}

// Shortening, deflection and rotation of the exact rod (independent computation). The meshes converge with order 2.
template <class B>
void converges_under_both_loads(std::string const& body) {
  Vec3 const large(-0.1509711442396, 0.7105685978542, 0.520173166012);
  auto const tip = [](Index n, double force) { return nachbagauer<B>(n, force * h3).tip_displacement(); };
  Vec3 const a = tip(128, 5e8), b = tip(256, 5e8);
  EXPECT_NEAR((a - large).norm() / (b - large).norm(), 4.0, 0.01);
  std::string const meshes = body + ", 128 and 256 elements extrapolated";
  held_within(exact_rod("S4", "u_x, u_y [m] and rotation under 62.5 MN", meshes),
              ((4.0 * b - a) / 3.0 - large).cwiseAbs().maxCoeff(), 1e-9, {.scale = 0.15});
  Vec2 const small(-1.8884916364e-7, 8.0990325398e-4);
  Vec3 const limit = (4.0 * tip(256, 5e5) - tip(128, 5e5)) / 3.0;
  held(exact_rod("S4", "u_x under 62.5 kN [m]", meshes), limit[0], small[0], 1e-8 * 1.9e-7);
  held(exact_rod("S4", "u_y under 62.5 kN [m]", meshes), limit[1], small[1], 1e-9 * 8.1e-4);
}
TEST(Nachbagauer, MeshesConvergeToTheExactRod) {
  converges_under_both_loads<Lrvf>("planar Lrvf");
  converges_under_both_loads<Se3Beam>("planar Se3Beam");
}

// ---- S4b: the same bar at 45° under force and moment

template <class B>
Vec3 inclined(Index n, Bar const& bar) {
  double const f = 5e8 * h3 * std::sqrt(0.5);
  return Cantilever<B>(B::from(bar, n), {.force = {f, -f}, .moment = -5e8}, {.load_steps = 10}).tip_displacement();
}

// Published values: Exudyn, geometricallyExactBeam2Dtest.py, with the same element. It rounds G to 7.9615e10.
TEST(InclinedBeam, SixteenElementsGiveExudynsDigits) {
  Bar const bar{.length = 2.0,
                .constants = BarConstants{.EA = 2.07e11 * 0.05,
                                          .EI = 2.07e11 * 0.1 * h3 / 12.0,
                                          .mass_per_length = 392.5,
                                          .GA = 13.0 / 15.3 * 7.9615e10 * 0.05},
                .placement = Placement::planar(0, 0, std::numbers::pi / 4)};
  held({"S4b", "u_y of the tip [m]", By::published, "Exudyn's geometricallyExactBeam2Dtest.py",
        "planar Lrvf, 16 elements"},
       inclined<Lrvf>(16, bar)[1], -2.211502835379855, 1e-9);
}

template <class B>
void converges_at_an_angle(std::string const& body) {
  Vec3 const exact(-1.197374069, -2.209408446, -4.306675415);
  auto const tip = [](Index n) { return inclined<B>(n, thick(std::numbers::pi / 4)); };
  char const* const what = "u_x, u_y [m] and rotation of the tip";
  held_within(exact_rod("S4b", what, body + ", 16 elements"), (tip(16) - exact).cwiseAbs().maxCoeff(), 0.001 * 2.21,
              {.scale = 2.21});
  held_within(exact_rod("S4b", what, body + ", 64 and 128 elements extrapolated"),
              ((4.0 * tip(128) - tip(64)) / 3.0 - exact).cwiseAbs().maxCoeff(), 1e-7, {.scale = 2.21});
}
TEST(InclinedBeam, MeshesConvergeToTheExactRod) {
  converges_at_an_angle<Lrvf>("planar Lrvf");
  converges_at_an_angle<Se3Beam>("planar Se3Beam");
}

}  // namespace statics_cantilever_test
