#include <polybody/compare/mesh_diagnostics.hpp>

#include <gtest/gtest.h>

namespace mesh_diagnostics_test {

using namespace polybody;

planar::Lrvf beam(Index n) {
  return planar::Lrvf::from(
      {.length = 2.0, .constants = BarConstants{.EA = 1.0, .EI = 1.0, .mass_per_length = 1.0, .GA = 1.0}}, n);
}

/// Length of the polygon through points of a curve; an arc of curvature κ in steps of h is longer by (κ h)²/24 of it.
double polygon_length(std::vector<Vec2> const& points) {
  double length = 0.0;
  for (std::size_t i = 1; i < points.size(); ++i) length += (points[i] - points[i - 1]).norm();
  return length;
}

TEST(MeshDiagnostics, UndeformedMeshesCoincide) {
  planar::Lrvf const b = beam(4);
  std::vector<double> q(std::size_t(b.coordinates()));
  b.reference(q);
  MeshDiagnostics const d = mesh_diagnostics(b, q);
  EXPECT_NEAR(d.largest_gap, 0.0, 1e-15);
  EXPECT_NEAR(d.position_length, 2.0, 1e-15);
}

// A linear rotation field over one arc of curvature k implies a circle: x = sin(k s)/k, y = (1 - cos(k s))/k.
TEST(MeshDiagnostics, LinearRotationsImplyACircle) {
  planar::Lrvf const b = beam(5);
  double const k = 0.7;
  std::vector<double> q(std::size_t(b.coordinates()));
  for (std::size_t i = 0; i <= 5; ++i) {
    double const s = 0.4 * double(i);
    q[3 * i] = s;  // the position mesh stays straight
    q[3 * i + 1] = 0.0;
    q[3 * i + 2] = k * s;
  }
  MeshDiagnostics const d = mesh_diagnostics(b, q);
  for (std::size_t i = 0; i <= 5; ++i) {
    double const s = 0.4 * double(i);
    EXPECT_NEAR(d.rotation_nodes[i][0], std::sin(k * s) / k, 1e-13);
    EXPECT_NEAR(d.rotation_nodes[i][1], (1.0 - std::cos(k * s)) / k, 1e-13);
  }
  Vec2 const tip(std::sin(k * 2.0) / k, (1.0 - std::cos(k * 2.0)) / k);
  EXPECT_NEAR(d.largest_gap, (tip - Vec2(2.0, 0.0)).norm(), 1e-13);
  for (double c : d.rotation_curvature) EXPECT_NEAR(c, k, 1e-13);
  for (double c : d.position_curvature) EXPECT_EQ(c, 0.0);
  EXPECT_NEAR(implied_curve(b, q, 7).back()[1], tip[1], 1e-13);
  double const chord = k * 0.4 / 7.0;  // 2 sin(κh/2) of the arc κh
  EXPECT_NEAR(polygon_length(implied_curve(b, q, 7)), 2.0 * 2.0 * std::sin(0.5 * chord) / chord, 1e-13);
}

// Thesis 2.5.3: the rotation field is inextensible whatever the positions do.
TEST(MeshDiagnostics, StretchLengthensThePositionMeshOnly) {
  planar::Lrvf const b = beam(3);
  std::vector<double> q(std::size_t(b.coordinates()), 0.0);
  for (std::size_t i = 0; i <= 3; ++i) q[3 * i] = 1.1 * 2.0 / 3.0 * double(i);
  MeshDiagnostics const d = mesh_diagnostics(b, q);
  EXPECT_NEAR(d.position_length, 2.2, 1e-14);
  EXPECT_NEAR(polygon_length(implied_curve(b, q, 4)), 2.0, 1e-14);
  EXPECT_EQ(d.rotation_length, 2.0);
}

}  // namespace mesh_diagnostics_test
