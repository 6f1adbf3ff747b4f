// Wallin 2016, Chapter 2: the two meshes of the large rotation vector formulation. tests/long/planar_lrvf.py computes
// the references, with 10 elements, rho_inf = 0.8 and the same steps.
#include <gtest/gtest.h>

#include "../../examples/chapter2_energy.hpp"
#include "support/held.hpp"

namespace thesis_chapter2_test {

using namespace chapter2;

using planar::Lrvf;

Claim independent(char const* what, char const* formulation) {
  return {"thesis, ch. 2", what, By::independent, "`tests/long/planar_lrvf.py`, same mesh and step", formulation};
}
/// Claim about polybody's own runs in docs/chapter2.md.
Claim measured(char const* what, char const* formulation) {
  return {"thesis, ch. 2", what, By::itself, "docs/chapter2.md", formulation};
}

// Largest distance between the nodes of the two meshes during the ramp.
double largest_gap(Stiffness const& stiffness, double ramp, Index elements = 10) {
  RobotArm<Lrvf> arm(bar(stiffness, 7850.0), elements, ramp);
  State x = arm.model.reference_state();
  double gap = 0.0;
  for (State const& now : simulate(arm.model, x, GeneralisedAlpha{.rho_inf = 0.8}, {.end_time = ramp, .step = 5e-3}))
    gap = std::max(gap, mesh_diagnostics(arm.arm.body(), coordinates_of(arm.model, now, arm.arm)).largest_gap);
  return gap;
}

TEST(ThesisChapter2, NodeGapOfHighStiffnessSlowRampIsSmall) {
  held(independent("largest gap of the meshes [m]", "Lrvf, high stiffness, 10 s"), largest_gap(high, 10.0), 0.00335881,
       1e-7);
}
TEST(ThesisChapter2, NodeGapOfMediumStiffnessSlowRamp) {
  held(independent("largest gap of the meshes [m]", "Lrvf, medium stiffness, 10 s"), largest_gap(medium, 10.0),
       0.040355, 1e-6);
}
TEST(ThesisChapter2, NodeGapOfMediumStiffnessFastRamp) {
  double const gap = largest_gap(medium, 4.5);
  held(independent("largest gap of the meshes [m]", "Lrvf, medium stiffness, 4.5 s"), gap, 0.0987197, 2e-6);
}
TEST(ThesisChapter2, NodeGapOfLowStiffnessFastRamp) {
  held(independent("largest gap of the meshes [m]", "Lrvf, low stiffness, 4.5 s"), largest_gap(low, 4.5), 0.219484,
       2e-6);
}

// EA and GA of 1e4 times the normal value suppress stretch and shear like constraints. The remaining distance is due
// to interpolation: l (1 - sin(phi/2)/(phi/2)) per element, of second order in l.
TEST(ThesisChapter2, NodeGapWithoutStrainsVanishesWithTheElements) {
  Stiffness const unstrained{"low", 1e4 * low.EA, 1e4 * low.GA, low.EI};
  double const coarse = largest_gap(unstrained, 4.5, 10), fine = largest_gap(unstrained, 4.5, 20);
  held(measured("largest gap of the meshes [m]", "Lrvf, low EI without strains, 10 elements"), coarse, 0.028, 5e-4);
  held({"thesis, ch. 2", "order of the gap without strains", By::closed_form, "linear angles imply arcs",
        "Lrvf, low EI, 10 and 20 elements"},
       std::log2(coarse / fine), 2.0, 0.05);
}

/// Length of the polygon through points of a curve. An arc of curvature κ in steps of h is longer by the factor 1 +
/// (κ h)²/24.
double polygon_length(std::vector<Vec2> const& points) {
  double length = 0.0;
  for (std::size_t i = 1; i < points.size(); ++i) length += (points[i] - points[i - 1]).norm();
  return length;
}

TEST(ThesisChapter2, AxialForceStretchesThePositionMeshOnly) {
  RobotArm<Lrvf> arm(bar(low, 7850.0), 10, 4.5, 100e3);
  State x = arm.model.reference_state();
  double longest = 0.0;
  for (State const& now : simulate(arm.model, x, GeneralisedAlpha{.rho_inf = 0.8}, {.end_time = 4.5, .step = 5e-3})) {
    MeshDiagnostics const d = mesh_diagnostics(arm.arm.body(), coordinates_of(arm.model, now, arm.arm));
    longest = std::max(longest, d.position_length);
    double const implied = polygon_length(implied_curve(arm.arm.body(), coordinates_of(arm.model, now, arm.arm), 20));
    ASSERT_LT(implied, 10.0 + 1e-12);
    ASSERT_GT(implied, 10.0 - 1e-3);
  }
  held(measured("longest position mesh under 100 kN [m]", "Lrvf, low stiffness, 4.5 s"), longest, 11.95, 5e-3);
}

TEST(ThesisChapter2, TipMomentBringsTheMeshesApart) {
  chapter2::Cantilever<Lrvf> beam(bar(low, 7850.0), 10, 30e3);
  State x = beam.model.reference_state();
  simulate(beam.model, x, GeneralisedAlpha{.rho_inf = 0.8}, {.end_time = 2.0, .step = 1e-3}).run();
  MeshDiagnostics const d = mesh_diagnostics(beam.beam.body(), coordinates_of(beam.model, x, beam.beam));
  char const* const body = "Lrvf, low stiffness, 30 kN m, h = 1e-3 s";
  held(independent("x of the tip at 2 s, position mesh [m]", body), d.position_nodes.back()[0], 8.83173, 2e-5);
  held(independent("y of the tip at 2 s, position mesh [m]", body), d.position_nodes.back()[1], 1.87444, 2e-5);
  held(independent("x of the tip at 2 s, rotation mesh [m]", body), d.rotation_nodes.back()[0], 8.78937, 2e-5);
  held(independent("y of the tip at 2 s, rotation mesh [m]", body), d.rotation_nodes.back()[1], 1.95515, 2e-5);
  // Figure 2.10: zero curvature on the position mesh; piecewise constant curvature with jumps on the rotation mesh
  for (double const curvature : d.position_curvature) EXPECT_EQ(curvature, 0.0);
  simulate(beam.model, x, GeneralisedAlpha{.rho_inf = 0.8}, {.end_time = 20.0, .step = 5e-3}).run();
  MeshDiagnostics const late = mesh_diagnostics(beam.beam.body(), coordinates_of(beam.model, x, beam.beam));
  double jump = 0.0;
  for (std::size_t e = 1; e < 10; ++e)
    jump = std::max(jump, std::abs(late.rotation_curvature[e] - late.rotation_curvature[e - 1]));
  held(measured("largest jump of the curvature at 20 s [1/m]", "Lrvf, low stiffness, 30 kN m"), jump, 0.21, 5e-3);
}

// The drive is at rest and the pin does no work. The strain energy is a potential for any shape of the two curves.
// The energy error of a conserving method is therefore that of Newton's tolerance.
template <class B>
double conserving_drift() {
  return energy_drift<B>({}, 10, EnergyMomentum{}).largest;
}
TEST(ThesisChapter2, EnergyStaysOnceTheDriveStandsStill) {
  auto const claim = [](char const* formulation) {
    return Claim{"thesis, ch. 2", "energy in 20 s after the ramp, drift of itself", By::closed_form, "invariant",
                 formulation};
  };
  held_within(claim("planar Lrvf, 10 elements, EnergyMomentum, h = 5 ms"), conserving_drift<Lrvf>(), 1e-10,
              {.scale = 1.0});
  held_within(claim("planar AncfCable, Green strain, 10 elements, EnergyMomentum, h = 5 ms"),
              conserving_drift<planar::AncfCable<GreenStrain>>(), 1e-10, {.scale = 1.0});
  held_within(claim("planar AncfCable, engineering strain, 10 elements, EnergyMomentum, h = 5 ms"),
              conserving_drift<planar::AncfCable<EngineeringStrain>>(), 1e-10, {.scale = 1.0});
}
TEST(ThesisChapter2, EnergyDriftOfGeneralizedAlphaIsOfSecondOrder) {
  auto const drift = [](double h) {
    return energy_drift<Lrvf>({.step = h}, 10, GeneralisedAlpha{.rho_inf = 0.8}).largest;
  };
  double const coarse = drift(5e-3), fine = drift(2.5e-3);
  held(measured("energy in 20 s after the ramp, drift of itself", "Lrvf, GeneralisedAlpha, h = 5 ms"), coarse, 2.4e-5,
       5e-7);
  held({"thesis, ch. 2", "order of the drift of energy", By::closed_form, "order of the method",
        "Lrvf, GeneralisedAlpha, h = 5 and 2.5 ms"},
       std::log2(coarse / fine), 2.0, 0.2);
}

/// Distance of the tip from the root for M = 2πEI/L, which closes the beam of low stiffness to a circle.
template <class B>
double opening() {
  chapter2::Cantilever<B> beam(bar(low, 7850.0), 16, 2.0 * std::numbers::pi * low.EI / length);
  State x = beam.model.reference_state();
  equilibrium(beam.model, x, {.load_steps = 10});
  return position(beam.model, x, beam.beam.at(length)).norm();
}
TEST(ThesisChapter2, RollUpStaysOpenByTheGreenStrainOfAThickSection) {
  char const* const what = "opening of the rolled-up beam [m]";
  held(measured(what, "planar AncfCable, Green strain, 16 elements"), opening<planar::AncfCable<GreenStrain>>(), 0.63,
       5e-3);
  held_within(
      {"thesis, ch. 2", what, By::closed_form, "closed circle", "planar AncfCable, engineering strain, 16 elements"},
      opening<planar::AncfCable<EngineeringStrain>>(), 7.5e-4, {.scale = 10.0});
}

}  // namespace thesis_chapter2_test
