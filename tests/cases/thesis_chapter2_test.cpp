// Chapter 2 of M. Wallin's thesis (2016): the two meshes of the large rotation vector formulation. The numbers come
// from an independent computation with 10 elements, rho_inf = 0.8 and a step of 5 ms.
#include <gtest/gtest.h>

#include "../../examples/chapter2.hpp"

namespace thesis_chapter2_test {

using namespace chapter2;

using planar::Lrvf;

// Largest gap between the nodes of the two meshes during the ramp.
double largest_gap(Stiffness const& stiffness, double ramp, double density = 7850.0) {
  RobotArm<Lrvf> arm(bar(stiffness, density), 10, ramp);
  State x = arm.model.reference_state();
  double gap = 0.0;
  for (State const& now : simulate(arm.model, x, GeneralizedAlpha{.rho_inf = 0.8}, {.until = ramp, .step = 5e-3}))
    gap = std::max(gap, mesh_diagnostics(arm.arm.body(), coordinates_of(arm.model, now, arm.arm)).largest_gap);
  return gap;
}

TEST(ThesisChapter2, NodeGapOfHighStiffnessSlowRampIsSmall) { EXPECT_NEAR(largest_gap(high, 10.0), 0.0034, 0.00005); }
TEST(ThesisChapter2, NodeGapOfMediumStiffnessSlowRamp) { EXPECT_NEAR(largest_gap(medium, 10.0), 0.040, 0.0005); }
TEST(ThesisChapter2, NodeGapOfMediumStiffnessFastRamp) { EXPECT_NEAR(largest_gap(medium, 4.5), 0.10, 0.005); }
TEST(ThesisChapter2, NodeGapOfLowStiffnessFastRamp) { EXPECT_NEAR(largest_gap(low, 4.5), 0.22, 0.005); }

/// Length of the polygon through points of a curve; an arc of curvature κ in steps of h is longer by (κ h)²/24 of it.
double polygon_length(std::vector<Vec2> const& points) {
  double length = 0.0;
  for (std::size_t i = 1; i < points.size(); ++i) length += (points[i] - points[i - 1]).norm();
  return length;
}

TEST(ThesisChapter2, AxialForceStretchesThePositionMeshOnly) {
  RobotArm<Lrvf> arm(bar(low, 7850.0), 10, 4.5, 100e3);
  State x = arm.model.reference_state();
  double longest = 0.0;
  for (State const& now : simulate(arm.model, x, GeneralizedAlpha{.rho_inf = 0.8}, {.until = 4.5, .step = 5e-3})) {
    MeshDiagnostics const d = mesh_diagnostics(arm.arm.body(), coordinates_of(arm.model, now, arm.arm));
    longest = std::max(longest, d.position_length);
    double const implied = polygon_length(implied_curve(arm.arm.body(), coordinates_of(arm.model, now, arm.arm), 20));
    ASSERT_LT(implied, 10.0 + 1e-12);
    ASSERT_GT(implied, 10.0 - 1e-3);
  }
  EXPECT_GT(longest, 11.0);
}

TEST(ThesisChapter2, TipMomentBringsTheMeshesApart) {
  chapter2::Cantilever<Lrvf> beam(bar(low, 7850.0), 10, 30e3);
  State x = beam.model.reference_state();
  simulate(beam.model, x, GeneralizedAlpha{.rho_inf = 0.8}, {.until = 2.0, .step = 1e-3}).run();
  MeshDiagnostics const d = mesh_diagnostics(beam.beam.body(), coordinates_of(beam.model, x, beam.beam));
  EXPECT_NEAR(d.position_nodes.back()[0], 8.832, 1e-3);
  EXPECT_NEAR(d.position_nodes.back()[1], 1.874, 1e-3);
  EXPECT_NEAR(d.rotation_nodes.back()[0], 8.789, 1e-3);
  EXPECT_NEAR(d.rotation_nodes.back()[1], 1.955, 1e-3);
  // Figure 2.10: no curvature on the position mesh; on the rotation mesh constant in each element, with jumps
  double jump = 0.0;
  for (std::size_t e = 0; e < 10; ++e) {
    EXPECT_EQ(d.position_curvature[e], 0.0);
    if (e > 0) jump = std::max(jump, std::abs(d.rotation_curvature[e] - d.rotation_curvature[e - 1]));
  }
  EXPECT_GT(jump, 0.01);
}

}  // namespace thesis_chapter2_test
