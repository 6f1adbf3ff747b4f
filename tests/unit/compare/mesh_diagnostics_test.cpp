#include <polybody/compare/mesh_diagnostics.hpp>
#include <polybody/se3_beam.hpp>

#include <gtest/gtest.h>

#include "support/spatial_lrvf.hpp"

namespace mesh_diagnostics_test {

using namespace polybody;

planar::Lrvf beam(Index n) {
  return planar::Lrvf::from(
      {.length = 2.0, .constants = BarConstants{.EA = 1.0, .EI = 1.0, .mass_per_length = 1.0, .GA = 1.0}}, n);
}

/// Length of the polygon through points of a curve. An arc of curvature κ in steps of h is longer by the factor 1 +
/// (κ h)²/24.
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
    q[3 * i] = s;  // the position mesh is straight
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

// Wallin 2016, 2.5.3: the rotation field is inextensible for any positions.
TEST(MeshDiagnostics, StretchLengthensThePositionMeshOnly) {
  planar::Lrvf const b = beam(3);
  std::vector<double> q(std::size_t(b.coordinates()), 0.0);
  for (std::size_t i = 0; i <= 3; ++i) q[3 * i] = 1.1 * 2.0 / 3.0 * double(i);
  MeshDiagnostics const d = mesh_diagnostics(b, q);
  EXPECT_NEAR(d.position_length, 2.2, 1e-14);
  EXPECT_NEAR(polygon_length(implied_curve(b, q, 4)), 2.0, 1e-14);
  EXPECT_EQ(d.rotation_length, 2.0);
}

// The curve implied by a natural shape has the curvature of the shape: an arc of 0.3 1/m.
TEST(MeshDiagnostics, ANaturalShapeCountsInTheCurvature) {
  double const k = 0.3;
  auto const b = planar::Lrvf::naturally_curved(
      {.length = 2.0, .constants = BarConstants{.EA = 1.0, .EI = 1.0, .mass_per_length = 1.0, .GA = 1.0}}, 4,
      [&](double s) { return Placement::planar(std::sin(k * s) / k, (1.0 - std::cos(k * s)) / k, k * s); });
  std::vector<double> q(std::size_t(b.coordinates()));
  b.reference(q);
  MeshDiagnostics const d = mesh_diagnostics(b, q);
  EXPECT_LT(d.largest_gap, 1e-14);
  for (double c : d.rotation_curvature) EXPECT_NEAR(c, k, 1e-14);
}

Lrvf<> rod(Index n) {
  return Lrvf<>::from(
      {.length = 2.0, .constants = BarConstants{.EA = 1, .EI = 1, .mass_per_length = 1, .GA = 1, .GJ = 1}}, n);
}

// Straight sections, r = s ((1 + eps) t1 + gamma t2 + delta t3): the length is that of r', and the distance is L
// times the strains.
TEST(SpatialMeshDiagnostics, StretchAndShearLengthenThePositionMeshOnly) {
  Placement const turned = Placement::at({0.3, -0.2, 0.5}, {0.7, -0.4, 1.1});
  Vec3 const strain(0.1, 0.2, -0.3);
  VecX const q = nodes_of(4, [&](double i) {
    return Placement{turned.origin + 0.5 * i * (turned.axes * (Vec3::UnitX() + strain)), turned.axes};
  });
  SpatialMeshDiagnostics const d = mesh_diagnostics(rod(4), numbers(q));
  EXPECT_NEAR(d.position_length, 2.0 * (Vec3::UnitX() + strain).norm(), 1e-14);
  EXPECT_NEAR(d.largest_gap, 2.0 * strain.norm(), 1e-14);
  EXPECT_EQ(d.rotation_length, 2.0);
  EXPECT_LT((d.rotation_nodes.back() - turned.origin - 2.0 * turned.axes.col(0)).norm(), 1e-14);
  for (double c : d.rotation_curvature) EXPECT_NEAR(c, 0.0, 1e-14);
  for (double c : d.position_curvature) EXPECT_EQ(c, 0.0);
}

// Rotations exp(s phi) are the Frenet frames of a helix of curvature kappa = hypot(phi2, phi3) and torsion phi1. With
// w = |phi| its radius is kappa/w^2 and its rise phi1/w. With nodes on the helix the meshes agree at the nodes. The
// position mesh is shorter, with chords of sqrt((phi1 l/w)^2 + (2 kappa/w^2 sin(w l/2))^2).
TEST(SpatialMeshDiagnostics, AHelixHasItsCurvatureAndItsChords) {
  Index const n = 5;
  Vec3 const phi(0.6, -0.5, 1.2);
  double const l = 2.0 / double(n), kappa = 1.3, w = phi.norm();
  VecX const q = nodes_of(n, [&](double i) {
    double const s = l * i;
    return Placement{s * left_jacobian<double>(s * phi).col(0), exp_so3<double>(s * phi)};
  });
  SpatialMeshDiagnostics const d = mesh_diagnostics(rod(n), numbers(q));
  EXPECT_LT(d.largest_gap, 1e-13);
  double const chord = std::hypot(phi[0] * l / w, 2.0 * kappa / (w * w) * std::sin(0.5 * w * l));
  EXPECT_NEAR(d.position_length, double(n) * chord, 1e-13);
  EXPECT_LT(d.position_length, 1.999);
  ASSERT_EQ(d.rotation_curvature.size(), std::size_t(n));
  for (double c : d.rotation_curvature) EXPECT_NEAR(c, kappa, 1e-13);
}

// The axis of a beam on SE(3) is this helix, in the plane a circle: length and curvature are those of the curve. The
// five Gauss points of the implied curve have errors of (5!)⁴ (w l)¹¹/(11 (10!)³) ≈ 3e-13 in an element.
TEST(SpatialMeshDiagnostics, ElementsOfASe3BeamAreHelicesAndArcs) {
  Bar const bar{.length = 2.0, .constants = BarConstants{.EA = 1, .EI = 1, .mass_per_length = 1, .GA = 1, .GJ = 1}};
  Vec3 const phi(0.6, -0.5, 1.2);
  VecX const q = nodes_of(3, [&](double i) {
    double const s = 2.0 / 3.0 * i;
    return Placement{1.1 * s * left_jacobian<double>(s * phi).col(0), exp_so3<double>(s * phi)};
  });
  SpatialMeshDiagnostics const d = mesh_diagnostics(Se3Beam::from(bar, 3), numbers(q));
  EXPECT_NEAR(d.position_length, 2.2, 1e-13);
  EXPECT_NEAR(d.largest_gap, 0.1 * 2.0 * (left_jacobian<double>(2.0 * phi).col(0)).norm(), 1e-12);
  for (double c : d.position_curvature) EXPECT_NEAR(c, 1.3 / 1.1, 1e-13);
  for (double c : d.rotation_curvature) EXPECT_NEAR(c, 1.3, 1e-13);
  double const k = 0.7;
  std::vector<double> arc;
  for (int i = 0; i <= 4; ++i) {
    double const s = 0.5 * i;
    arc.insert(arc.end(), {1.1 * std::sin(k * s) / k, 1.1 * (1.0 - std::cos(k * s)) / k, k * s});
  }
  MeshDiagnostics const plane = mesh_diagnostics(planar::Se3Beam::from(bar, 4), arc);
  EXPECT_NEAR(plane.position_length, 2.2, 1e-13);
  for (double c : plane.position_curvature) EXPECT_NEAR(c, k / 1.1, 1e-13);
  for (double c : plane.rotation_curvature) EXPECT_NEAR(c, k, 1e-13);
}

// Curved reference configuration: a stress-free helix has these chords, and no distance between the meshes.
TEST(SpatialMeshDiagnostics, ACurvedReferenceHasNoGap) {
  Vec3 const phi(0.6, -0.5, 1.2);
  auto const b = Lrvf<>::from(
      {.length = 2.0, .constants = BarConstants{.EA = 1, .EI = 1, .mass_per_length = 1, .GA = 1, .GJ = 1}}, 4,
      [&](double s) { return Placement{s * left_jacobian<double>(s * phi).col(0), exp_so3<double>(s * phi)}; });
  std::vector<double> q(std::size_t(b.coordinates()));
  b.reference(q);
  SpatialMeshDiagnostics const d = mesh_diagnostics(b, q);
  EXPECT_LT(d.largest_gap, 1e-13);
  for (double c : d.rotation_curvature) EXPECT_NEAR(c, 1.3, 1e-13);
}

/// Nodes (x, y, θ) of a planar state far from the reference.
Vec3 planar_node(double i) {
  return {0.6 * i + 0.1 * std::sin(2.0 * i), 0.3 * std::sin(1.0 + i), 0.5 + 0.6 * std::sin(1.7 * i)};
}
VecX in_space() {
  return nodes_of(4, [](double i) {
    Vec3 const at = planar_node(i);
    return Placement::at({at[0], at[1], 0.0}, {0.0, 0.0, at[2]});
  });
}

// A planar motion in space gives the results of the planar beam, for all quadratures of either.
TEST(SpatialMeshDiagnostics, APlanarMotionIsThatOfThePlanarBeam) {
  std::vector<double> q;
  for (int i = 0; i <= 4; ++i) {
    Vec3 const at = planar_node(i);
    q.insert(q.end(), {at[0], at[1], at[2]});
  }
  MeshDiagnostics const plane = mesh_diagnostics(beam(4), q);
  VecX const spatial = in_space();
  SpatialMeshDiagnostics const space = mesh_diagnostics(rod(4), numbers(spatial));
  EXPECT_NEAR(space.largest_gap, plane.largest_gap, 1e-14);
  EXPECT_NEAR(space.position_length, plane.position_length, 1e-14);
  for (std::size_t i = 0; i <= 4; ++i) {
    EXPECT_LT((space.position_nodes[i].head<2>() - plane.position_nodes[i]).norm(), 1e-15);
    EXPECT_LT((space.rotation_nodes[i].head<2>() - plane.rotation_nodes[i]).norm(), 1e-14);
    EXPECT_EQ(space.position_nodes[i][2], 0.0);
    EXPECT_NEAR(space.rotation_nodes[i][2], 0.0, 1e-15);
  }
  for (std::size_t e = 0; e < 4; ++e)
    EXPECT_NEAR(space.rotation_curvature[e], std::abs(plane.rotation_curvature[e]), 1e-13);
  auto const full = planar::FullLrvf::from(
      {.length = 2.0, .constants = BarConstants{.EA = 1.0, .EI = 1.0, .mass_per_length = 1.0, .GA = 1.0}}, 4);
  EXPECT_EQ(mesh_diagnostics(full, q).largest_gap, plane.largest_gap);
}

// A rigid motion moves both curves and changes no result.
TEST(SpatialMeshDiagnostics, ARigidMotionCarriesBothCurves) {
  Placement const motion = Placement::at({1.3, -0.7, 2.1}, {-0.8, 1.9, 0.6});
  VecX const at = nodes_of(4, [](double i) {
    return Placement::at({0.6 * i, 0.3 * std::sin(i), 0.2 * i * i}, {0.4 * i, -0.3 * i * i / 4.0, 0.5 * std::sin(i)});
  });
  VecX const moved = carried(motion, at);
  SpatialMeshDiagnostics const before = mesh_diagnostics(rod(4), numbers(at));
  SpatialMeshDiagnostics const after = mesh_diagnostics(rod(4), numbers(moved));
  EXPECT_GT(before.largest_gap, 0.1);
  EXPECT_NEAR(after.largest_gap, before.largest_gap, 1e-13);
  EXPECT_NEAR(after.position_length, before.position_length, 1e-13);
  for (std::size_t i = 0; i <= 4; ++i)
    EXPECT_LT((after.rotation_nodes[i] - motion.origin - motion.axes * before.rotation_nodes[i]).norm(), 1e-13);
  for (std::size_t e = 0; e < 4; ++e) EXPECT_NEAR(after.rotation_curvature[e], before.rotation_curvature[e], 1e-13);
}

}  // namespace mesh_diagnostics_test
