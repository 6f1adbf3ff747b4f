#pragma once
/// \file
/// Comparison of the position mesh and the implied curve of an LRVF beam, in the plane and in space.

#include <concepts>
#include <span>
#include <vector>

#include <polybody/bodies/lrvf/planar_lrvf.hpp>
#include <polybody/compare/implied_curve.hpp>

namespace polybody {

/// Position mesh and implied curve of an LRVF beam in the plane (dim = 2) or in space (dim = 3), in world axes. The
/// position field of the beam gives the position mesh. The rotation field of the beam, with the tangent t₁, implies
/// another curve,
///   r(s) = r(0) + ∫ t₁ ds [thesis Eq. 2.2, 2.17].
template <int dim>
struct TwoMeshes {
  using Point = Mat<double, dim, 1>;  ///< point in world axes [m]
  std::vector<Point> position_nodes;  ///< nodes of the position mesh [m]
  std::vector<Point> rotation_nodes;  ///< the same material points on the implied curve [m]
  double largest_gap = 0.0;           ///< largest distance between a position node and its rotation node [m]
  double position_length = 0.0;       ///< arc length of the position mesh [m]
  double rotation_length = 0.0;       ///< arc length of the implied curve [m]: the length of the bar, since |t₁| = 1
  std::vector<double> position_curvature;  ///< |r′ × r″|/|r′|³ at the middle of each element [1/m], thesis Eq. 2.16
  /// Curvature of the implied curve at the middle of each element [1/m]: θ′ with its sign in the plane, |t₁′| in space
  /// [thesis Eq. 2.15, 2.4].
  std::vector<double> rotation_curvature;
};
using MeshDiagnostics = TwoMeshes<2>;         ///< diagnostics of planar beams
using SpatialMeshDiagnostics = TwoMeshes<3>;  ///< diagnostics of spatial beams

namespace detail {

/// Adds the position node and the rotation node of the next material point to d. Updates the largest distance, and adds
/// the arc length and the curvature of the element of length l before this point.
template <int dim>
void add_nodes(TwoMeshes<dim>& d, double l, typename TwoMeshes<dim>::Point const& position,
               typename TwoMeshes<dim>::Point const& rotation) {
  double gap = 0.0;
  for (int k = 0; k < dim; ++k) gap = std::hypot(gap, position[k] - rotation[k]);
  d.largest_gap = std::max(d.largest_gap, gap);
  d.rotation_nodes.push_back(rotation);
  d.position_nodes.push_back(position);
  if (d.position_nodes.size() < 2) return;
  ShapeValues<2> const n = linear_shape(0.5, l);
  auto const& last = d.position_nodes[d.position_nodes.size() - 2];
  double first = 0.0, second = 0.0, mixed = 0.0;  // r′·r′, r″·r″, r′·r″
  for (int k = 0; k < dim; ++k) {
    double const slope = n.ds[0] * last[k] + n.ds[1] * position[k], bend = n.dds[0] * last[k] + n.dds[1] * position[k];
    first += slope * slope;
    second += bend * bend;
    mixed += slope * bend;
  }
  d.position_length += std::sqrt(first) * l;
  d.position_curvature.push_back(std::sqrt(std::max(0.0, first * second - mixed * mixed)) / std::pow(first, 1.5));
}

}  // namespace detail

/// Points of the curve that the rotation field of a planar beam implies at the coordinates q. They are the first node
/// and `samples` points in each element.
template <std::derived_from<planar::SimoVuQuoc> Theory>
std::vector<Vec2> implied_curve(planar::Beam<Theory> const& beam, std::span<double const> q, int samples = 1) {
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

/// Position mesh and implied curve of a planar beam at the coordinates q (see `coordinates_of`), for any quadrature.
template <std::derived_from<planar::SimoVuQuoc> Theory>
MeshDiagnostics mesh_diagnostics(planar::Beam<Theory> const& beam, std::span<double const> q) {
  MeshDiagnostics d;
  double const l = beam.element_length();
  d.rotation_length = beam.length();
  std::vector<Vec2> const implied = implied_curve(beam, q);
  for (std::size_t i = 0; i < implied.size(); ++i) {
    detail::add_nodes<2>(d, l, Vec2(q[3 * i], q[3 * i + 1]), implied[i]);
    if (i > 0) d.rotation_curvature.push_back((q[3 * i + 2] - q[3 * i - 1]) / l);
  }
  return d;
}

/// Position mesh and implied curve of a spatial beam at the coordinates q. The rotation field is that of the beam's
/// interpolation. If the reference configuration is curved, the position mesh is the polygon through the nodes, and the
/// implied curve includes the curvature of the reference configuration.
template <NodalInterpolation Interpolation, StrainQuadrature Quadrature>
SpatialMeshDiagnostics mesh_diagnostics(Lrvf<Interpolation, Quadrature> const& beam, std::span<double const> q) {
  SpatialMeshDiagnostics d;
  d.rotation_length = beam.length();
  std::vector<Vec3> const implied = implied_curve(beam, q);
  for (std::size_t i = 0; i < implied.size(); ++i) {
    detail::add_nodes<3>(d, beam.element_length(), Vec3(part<3>(q, 7 * Index(i))), implied[i]);
    if (i > 0) d.rotation_curvature.push_back(implied_curvature(beam.rotation_field({Index(i) - 1, 0.5, 0.0, 0.0}, q)));
  }
  return d;
}

}  // namespace polybody
