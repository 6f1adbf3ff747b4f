// Roll-up of a cantilever by a tip moment (S1). The exact solution for pure bending is an arc of curvature M/EI
// without stretch or shear: x = (L/θ) sin θ, y = (L/θ)(1 − cos θ), θ = ML/EI.

#include <polybody/bodies/ancf/planar_ancf_cable.hpp>
#include <polybody/bodies/lrvf/planar_lrvf.hpp>
#include <polybody/bodies/se3/planar_se3_beam.hpp>

#include <gtest/gtest.h>

#include <numbers>

#include "support/cantilever.hpp"
#include "support/held.hpp"

using namespace polybody;

namespace statics_roll_up_test {

using planar::EngineeringStrain, planar::GreenStrain, planar::Lrvf, planar::Se3Beam;
using std::numbers::pi;

/// Beam of Wallin 2016, Fig. 2.9, with the length of Simo & Vu-Quoc (S1). EA and GA have the order of their robot
/// arm, without influence.
Bar thesis() {
  return {.length = 10.0, .constants = BarConstants{.EA = 1e6, .EI = 8.33e4, .mass_per_length = 1.0, .GA = 1e6}};
}

/// Exudyn's ANCFtestHalfcircle.py (S1): L = 2, E = 2.07e11, b = h = 0.01.
Bar half_circle() {
  return {.length = 2.0,
          .section = Rectangle{.height = 0.01, .width = 0.01},
          .material = Material{.density = 7850, .young = 2.07e11}};
}

double moment_of_turn(Bar const& bar, double theta) { return constants(bar).EI * theta / bar.length; }

/// A claim about the arc of curvature M/EI.
Claim arc(char const* what, std::string const& formulation) {
  return {"S1", what, By::closed_form, "κ = M/EI without stretch or shear", formulation};
}

template <class B>
Cantilever<B> rolled(Bar const& bar, Index n, double theta, int load_steps = 10) {
  return {B::from(bar, n), {.moment = moment_of_turn(bar, theta)}, {.load_steps = load_steps}};
}

// With one Gauss point the elements of a 2-node beam in pure bending are chords of equal length h. Their directions
// differ by θ/n, and the first is at θ/2n. So θ is exact, and the position of node k is h Σ_{j ≤ k} (cos, sin)((2j −
// 1) θ/2n).
TEST(RollUp, LrvfNodesLieOnARegularPolygon) {
  Bar const bar = half_circle();
  for (Index const n : {1, 2, 3, 4, 10, 16})
    for (double const theta : {pi / 2, pi, 2 * pi}) {
      Cantilever<Lrvf> const c = rolled<Lrvf>(bar, n, theta);
      double const h = bar.length / double(n), step = theta / double(n);
      Vec3 node = Vec3::Zero();
      for (Index k = 0; k <= n; ++k) {
        held_within({"S1", "every node (x, y [m], θ) under a quarter, half and whole turn", By::closed_form,
                     "regular polygon of chords whose directions step by θ/n", "planar Lrvf, 1 to 16 elements"},
                    (c.at(double(k) * h) - node).norm(), 1e-10 * bar.length, {equals("n", double(n)), bar.length});
        node += Vec3(h * std::cos((double(k) + 0.5) * step), h * std::sin((double(k) + 0.5) * step), step);
      }
    }
}

// A polygon of two or more chords closes. The single chord of n = 1 points at −x.
TEST(RollUp, LrvfFullCircleClosesForAnyNumberOfElementsAboveOne) {
  Bar const bar = half_circle();
  for (Index const n : {2, 3, 4, 10, 16, 40}) {
    Vec3 const tip = rolled<Lrvf>(bar, n, 2 * pi).tip();
    Instance const at{equals("n", double(n)), bar.length};
    held_within(arc("gap of the closed circle [m]", "planar Lrvf, 2 to 40 elements"), tip.head<2>().norm(),
                1e-10 * bar.length, at);
    held(arc("θ of the closed circle [rad]", "planar Lrvf, 2 to 40 elements"), tip[2], 2 * pi, 1e-11, at);
  }
  EXPECT_LT((rolled<Lrvf>(bar, 1, 2 * pi).tip() - Vec3(-bar.length, 0, 2 * pi)).norm(), 1e-10);
}

// Closed form: κ = M/EI = 0.360144058 1/m and θ_tip = 3.601440576 for M = 30 kN m. The chords end on the arc's ray,
// farther out by the factor (θ/2n)/sin(θ/2n). The exact tip is (−1.232317522, 5.264893204).
TEST(RollUp, ThesisFigure29StaticValues) {
  Index const n = 10;
  Cantilever<Lrvf> const c(Lrvf::from(thesis(), n), {.moment = 3e4}, {});
  for (double const s : {0.5, 4.5, 9.5}) {  // the Gauss points of three elements
    Vec3 const strain = c.bar.body().strains<0>(c.bar.body().at(s), coordinates_of(c.model, c.x, c.bar));
    held_within(arc("strain and curvature of the thesis' Fig. 2.9 [1/m]", "planar Lrvf, 10 elements"),
                (strain - Vec3(0, 0, 0.360144058)).norm(), 5e-10, {equals("s", s), 0.36});
  }
  double const half = 0.5 * c.tip()[2] / double(n), chord = half / std::sin(half);
  char const* const body = "planar Lrvf, 10 elements; (θ/2n)/sin(θ/2n) farther out";
  held(arc("θ of the tip, thesis' Fig. 2.9 [rad]", body), c.tip()[2], 3.601440576, 5e-10);
  held(arc("x of the tip, thesis' Fig. 2.9 [m]", body), c.tip()[0], -1.232317522 * chord, 1e-9);
  held(arc("y of the tip, thesis' Fig. 2.9 [m]", body), c.tip()[1], 5.264893204 * chord, 1e-9);
}

// The elements of Se3Beam are arcs, so that each mesh is the exact arc, at its nodes and between them. One element
// turns by less than 2π.
TEST(RollUp, Se3BeamIsTheArcWithAnyNumberOfElements) {
  Bar const bar = half_circle();
  struct {
    Index n;
    double theta;
  } const arcs[] = {{1, pi / 2}, {1, pi}, {1, 1.9 * pi}, {2, pi / 2}, {2, 2 * pi}, {3, 2 * pi}, {10, pi}, {16, 2 * pi}};
  for (auto const& [n, theta] : arcs) {
    Cantilever<Se3Beam> const c = rolled<Se3Beam>(bar, n, theta);
    for (double const part : {0.2, 0.5, 1.0}) {
      Vec3 const exact(std::sin(part * theta) / theta * bar.length, (1 - std::cos(part * theta)) / theta * bar.length,
                       part * theta);
      held_within(arc("points of the arc (x, y [m], θ)", "planar Se3Beam, 1 to 16 elements"),
                  (c.at(part * bar.length) - exact).norm(), 1e-10 * bar.length,
                  {equals("n", double(n)) + equals(", θ", theta) + equals(", s/L", part), bar.length});
    }
  }
}
TEST(RollUp, Se3BeamHasTheStaticValuesOfThesisFigure29) {
  Cantilever<Se3Beam> const c(Se3Beam::from(thesis(), 2), {.moment = 3e4}, {});
  Vec3 const strain = c.bar.body().strains<0>(c.bar.body().at(4.5), coordinates_of(c.model, c.x, c.bar));
  held_within(arc("strain and curvature of the thesis' Fig. 2.9 [1/m]", "planar Se3Beam, 2 elements"),
              (strain - Vec3(0, 0, 0.360144058)).norm(), 5e-10, {.scale = 0.36});
  held_within(arc("tip (x, y [m], θ) of the thesis' Fig. 2.9", "planar Se3Beam, 2 elements"),
              (c.tip() - Vec3(-1.232317522, 5.264893204, 3.601440576)).norm(), 2e-9, {.scale = 5.0});
}

template <class Strain>
double cable_error(Index n, double theta) {
  Bar const bar = half_circle();
  Vec3 const tip = rolled<planar::AncfCable<Strain>>(bar, n, theta).tip();
  return (tip.head<2>() - bar.length / theta * Vec2(std::sin(theta), 1.0 - std::cos(theta))).norm() / bar.length;
}

// Tolerances of S1 for the closed circle: 1e-4 L for n = 32, and 1e-3 L for n = 16. Its 3.6e-3 L for n = 8 requires
// four or more Gauss points of bending (3.63e-3 with 4, 5 or 10). The three points that give the digits of S3 for
// each mesh result in 3.78e-3.
TEST(RollUp, AncfCableClosesTheCircle) {
  double const coarse = cable_error<EngineeringStrain>(8, 2 * pi), middle = cable_error<EngineeringStrain>(16, 2 * pi),
               fine = cable_error<EngineeringStrain>(32, 2 * pi);
  char const* const gap = "gap of the closed circle [L]";
  held_within(arc(gap, "planar AncfCable, 8 elements"), coarse, 3.8e-3, {.scale = 1.0});
  held_within(arc(gap, "planar AncfCable, 16 elements"), middle, 1e-3, {.scale = 1.0});
  held_within(arc(gap, "planar AncfCable, 32 elements"), fine, 1e-4, {.scale = 1.0});
  EXPECT_GT(std::log2(coarse / middle), 4.0);
  EXPECT_GT(std::log2(middle / fine), 4.0);
}

TEST(RollUp, AncfCableQuarterAndHalfCircle) {
  for (double const theta : {pi / 2, pi})
    held_within(arc("tip under a quarter and half turn [L]", "planar AncfCable, 16 elements"),
                cable_error<EngineeringStrain>(16, theta), 1e-4, {equals("θ", theta), 1.0});
}

// The curvature of GreenStrain, c/|r′|³ with c = r′ × r″, couples bending and stretch. The minimum of ½ EA ε² + ½ EI
// θ′²/n² − M θ′ over n = |r′| and θ′ = c/n² is at ε = ½ (n² − 1) = M²/(EI EA) and θ′ = M n²/EI. The arc has the
// radius n/θ′ and an excess rotation of 2ε of a circle, 1.6e-4 L here (S1). This is the limit of fine meshes.
TEST(RollUp, GreenCableTurnsFartherByTheStretchOfItsCurvature) {
  Bar const bar = half_circle();
  BarConstants const k = constants(bar);
  double const m = moment_of_turn(bar, 2 * pi), e = m * m / (k.EI * k.EA), n2 = 1.0 + 2.0 * e;
  double const turn = m * n2 / k.EI, radius = std::sqrt(n2) / turn, theta = turn * bar.length;
  Vec2 const limit = radius * Vec2(std::sin(theta), 1.0 - std::cos(theta));
  EXPECT_NEAR(limit.norm() / bar.length, 1.6e-4, 0.05e-4);
  double error[3];
  for (int i = 0; i < 3; ++i)
    error[i] =
        (rolled<planar::AncfCable<GreenStrain>>(bar, 16 << i, 2 * pi).tip().head<2>() - limit).norm() / bar.length;
  double const tolerance[] = {1e-3, 1e-5, 1e-6};
  for (int i = 0; i < 3; ++i)
    held_within({"S1", "tip of the circle [L]", By::closed_form, "arc that turns by 2ε farther, ε = M²/(EI EA)",
                 "planar AncfCable, Green strain, " + std::to_string(16 << i) + " elements"},
                error[i], tolerance[i], {.scale = 1.0});
}

}  // namespace statics_roll_up_test
