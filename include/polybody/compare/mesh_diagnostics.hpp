#pragma once
/// \file
/// The two curves of a large-rotation-vector beam. Its position field gives one; its rotation field implies
/// another, r(s) = r(0) + ∫ t₁(θ) ds [thesis Eq. 2.2, 2.17]. Their nodes, lengths and curvatures side by side.

#include <concepts>
#include <span>
#include <vector>

#include <polybody/bodies/lrvf/planar_lrvf.hpp>

namespace polybody {

struct MeshDiagnostics {
  std::vector<Vec2> position_nodes;        ///< nodes of the position mesh [m]
  std::vector<Vec2> rotation_nodes;        ///< the same material points on the curve the rotations imply [m]
  double largest_gap = 0.0;                ///< between the two, over all nodes [m]
  double position_length = 0.0;            ///< arc length of the position mesh [m]
  double rotation_length = 0.0;            ///< arc length of the implied curve [m]: the bar's, as |t₁| = 1
  std::vector<double> position_curvature;  ///< |r′ × r″|/|r′|³ in the middle of each element [1/m], Eq. 2.16
  std::vector<double> rotation_curvature;  ///< θ′ in each element [1/m], Eq. 2.15
};

/// Points of the curve that the rotation field implies: `samples` in each element and the first node.
template <std::same_as<planar::Lrvf> Beam>
std::vector<Vec2> implied_curve(Beam const& beam, std::span<double const> q, int samples = 1) {
  std::vector<double> const rest(q.size(), 0.0);
  auto const at = [&](Index e, double xi) {
    return beam.template centre_line<double>({e, xi, 0.0}, q, std::span<double const>(rest));
  };
  double const part = beam.element_length() / samples;
  Vec2 r = at(0, 0.0).r;
  std::vector<Vec2> curve{r};
  for (Index e = 0; e < beam.elements(); ++e)
    for (int i = 0; i < samples; ++i) {
      for (GaussPoint const& g : gauss<5>) {
        double const angle = at(e, (i + g.xi) / samples).angle;
        r[0] += g.weight * part * std::cos(angle);
        r[1] += g.weight * part * std::sin(angle);
      }
      curve.push_back(r);
    }
  return curve;
}

/// Both meshes of a beam at the coordinates q (see `coordinates_of`).
template <std::same_as<planar::Lrvf> Beam>
MeshDiagnostics mesh_diagnostics(Beam const& beam, std::span<double const> q) {
  MeshDiagnostics d;
  double const l = beam.element_length();
  d.rotation_nodes = implied_curve(beam, q);
  d.rotation_length = beam.length();
  for (Index i = 0; i <= beam.elements(); ++i) {
    Vec2 const r(q[std::size_t(3 * i)], q[std::size_t(3 * i + 1)]), &other = d.rotation_nodes[std::size_t(i)];
    d.position_nodes.push_back(r);
    d.largest_gap = std::max(d.largest_gap, std::hypot(r[0] - other[0], r[1] - other[1]));
  }
  ShapeValues<2> const n = linear_shape(0.5, l);
  for (Index e = 0; e < beam.elements(); ++e) {
    Vec2 const a = d.position_nodes[std::size_t(e)], b = d.position_nodes[std::size_t(e) + 1];
    Vec2 slope, second;
    for (int k = 0; k < 2; ++k) {
      slope[k] = n.ds[0] * a[k] + n.ds[1] * b[k];
      second[k] = n.dds[0] * a[k] + n.dds[1] * b[k];
    }
    double const length = std::hypot(slope[0], slope[1]);
    d.position_length += length * l;
    d.position_curvature.push_back(std::abs(slope[0] * second[1] - slope[1] * second[0]) / std::pow(length, 3));
    d.rotation_curvature.push_back(beam.template strains<0>({e, 0.5, 0.0}, q)[2]);
  }
  return d;
}

}  // namespace polybody
