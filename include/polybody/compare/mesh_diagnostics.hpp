#pragma once
/// \file
/// Comparison of the position mesh and the implied curve of a geometrically exact beam, in the plane and in space.
///
/// The implied curve is the space curve that follows from a rotation field [thesis §2.3]. Its tangent is the first axis
/// of the sections, t = R e₁:
///   r(s) = r₀ + ∫ t ds (Eq. 2.2),  κ = |t′| (Eq. 2.4),  τ = t·(t′ × t″)/κ²  (Frenet).
/// With R′ = R K̃ the derivative of the tangent is t′ = R (0, K₃, −K₂), so that
///   κ² = K₂² + K₃²,  τ = K₁ + (K₂ K₃′ − K₃ K₂′)/κ².
/// Theory: Eqs. 11.35, 11.36.

#include <concepts>
#include <span>
#include <vector>

#include <polybody/bodies/lrvf/lrvf.hpp>
#include <polybody/bodies/lrvf/planar_lrvf.hpp>
#include <polybody/bodies/shared/sections.hpp>
#include <polybody/math/element_functions.hpp>

namespace polybody {

/// Curvature of the implied curve [1/m], κ = √(K₂² + K₃²).
inline double implied_curvature(SectionTurn const& s) { return std::hypot(s.K[1], s.K[2]); }

/// Torsion of the implied curve [1/m], τ = K₁ + (K₂ K₃′ − K₃ K₂′)/κ²; NaN if the curve is straight.
inline double implied_torsion(SectionTurn const& s) {
  return s.K[0] + (s.K[1] * s.dK[2] - s.K[2] * s.dK[1]) / (s.K[1] * s.K[1] + s.K[2] * s.K[2]);
}

/// Angle along a bar: its value [rad] and its first two derivatives with respect to arc length.
struct AngleAlong {
  double value = 0.0, slope = 0.0, second = 0.0;  ///< [rad], [rad/m], [rad/m²]
};

/// Rotation R and curvature K of a section that is rotated by ψ about Z, then θ about −Y, then φ about −X [thesis Eq.
/// 2.1]:
///   R = exp(ψ e₃) exp(−θ e₂) exp(−φ e₁),  K = −φ′ e₁ + exp(φ e₁) (−θ′ e₂ + exp(θ e₂) ψ′ e₃).
template <class T = double>  // compiled where it is used
SectionTurn section_turn(AngleAlong const& psi, AngleAlong const& theta, AngleAlong const& phi) {
  using V = Vec<T, 3>;
  using M = Mat<T, 3, 3>;
  V const x = V::UnitX(), y = V::UnitY(), z = V::UnitZ();
  M const about_z = exp_so3<T>(psi.value * z), about_y = exp_so3<T>(theta.value * y);
  M const about_x = exp_so3<T>(phi.value * x);
  V const yawed = about_y * z, inner = psi.slope * yawed - theta.slope * y;
  SectionTurn s;
  s.R = about_z * about_y.transpose() * about_x.transpose();
  s.K = about_x * inner - phi.slope * x;
  V const rate = psi.second * yawed + psi.slope * theta.slope * y.cross(yawed) - theta.second * y;
  s.dK = about_x * (phi.slope * x.cross(inner) + rate) - phi.second * x;
  return s;
}

/// Points r(s) = start + ∫ R e₁ ds [m] of the curve that the field R(s) = `rotation(s)` implies. The points are at the
/// multiples of length/pieces from 0 to `length`. Each piece is integrated with five Gauss points. The derivative of
/// the field may jump between pieces.
/// \throws InvalidInput if the length is not positive, or if pieces < 1.
template <class Field>
  requires std::is_invocable_r_v<Mat3, Field&, double>
std::vector<Vec3> implied_curve(Field&& rotation, double length, Index pieces, Vec3 const& start = Vec3::Zero()) {
  require_positive(length, "implied_curve: the length");
  if (pieces < 1)
    throw InvalidInput(
        "implied_curve.pieces",
        {ErrorObject{"implied_curve"}, ": at least one piece is needed, but there are ", ErrorValue{pieces}, "."});
  double const part = length / double(pieces);
  std::vector<Vec3> curve{start};
  for (Index i = 0; i < pieces; ++i) {
    Vec3 r = curve.back();
    for (GaussPoint const& g : gauss<5>) {
      Mat3 const axes = rotation((double(i) + g.xi) * part);
      for (int k = 0; k < 3; ++k) r[k] += g.weight * part * axes(k, 0);
    }
    curve.push_back(r);
  }
  return curve;
}

/// Beam in space with a rotation field: `Lrvf` with a `NodalInterpolation`, and `Se3Beam`.
template <class B>
concept HasRotationField =
    std::derived_from<B, FrameChain> && requires(B const b, typename B::Point p, std::span<double const> q) {
      { b.rotation_field(p, q) } -> std::convertible_to<SectionTurn>;
    };

/// Points of the curve that the rotation field of a beam implies at the coordinates q: the first node and `samples`
/// points in each element.
template <HasRotationField B>
std::vector<Vec3> implied_curve(B const& beam, std::span<double const> q, int samples = 1) {
  auto const rotation = [&](double s) { return beam.rotation_field(beam.at(s), q).R; };
  return implied_curve(rotation, beam.length(), beam.elements() * samples, part<3>(q, 0));
}

/// Position mesh and implied curve of a beam in the plane (dim = 2) or in space (dim = 3), in world axes. The
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

/// Adds the position node and the rotation node of the next material point to d, and updates the largest distance.
template <int dim>
void add_nodes(TwoMeshes<dim>& d, typename TwoMeshes<dim>::Point const& position,
               typename TwoMeshes<dim>::Point const& rotation) {
  double gap = 0.0;
  for (int k = 0; k < dim; ++k) gap = std::hypot(gap, position[k] - rotation[k]);
  d.largest_gap = std::max(d.largest_gap, gap);
  d.rotation_nodes.push_back(rotation);
  d.position_nodes.push_back(position);
}
/// Derivatives of the position on the straight line between the last two nodes of an element of length l.
template <int dim>
AxisSlopes<dim> slopes_of_chord(TwoMeshes<dim> const& d, double l) {
  AxisSlopes<dim> s{(d.position_nodes.back() - *(d.position_nodes.end() - 2)) / l, {}};
  s.second.setZero();
  return s;
}
/// Adds the arc length and the curvature of the axis of the next element of length l, of constant |r′| and |r″|.
template <int dim>
void add_axis(TwoMeshes<dim>& d, double l, AxisSlopes<dim> const& s) {
  double first = 0.0, second = 0.0, mixed = 0.0;  // r′·r′, r″·r″, r′·r″
  for (int k = 0; k < dim; ++k) {
    first += s.first[k] * s.first[k];
    second += s.second[k] * s.second[k];
    mixed += s.first[k] * s.second[k];
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
    detail::add_nodes<2>(d, Vec2(q[3 * i], q[3 * i + 1]), implied[i]);
    if (i == 0) continue;
    double const turn = q[3 * i + 2] - q[3 * i - 1];
    d.rotation_curvature.push_back(turn / l);
    AxisSlopes<2> slopes = detail::slopes_of_chord<2>(d, l);
    if constexpr (requires { Theory::axis_slopes(slopes.first, turn, l); })
      slopes = Theory::axis_slopes(Vec2(l * slopes.first), turn, l);
    detail::add_axis<2>(d, l, slopes);
  }
  return d;
}

/// Position mesh and implied curve of a spatial beam at the coordinates q. The rotation field is that of the beam's
/// interpolation. The position mesh of `Lrvf` is the polygon through the nodes, that of `Se3Beam` consists of helices.
/// If the reference configuration is curved, the implied curve includes its curvature.
template <HasRotationField B>
SpatialMeshDiagnostics mesh_diagnostics(B const& beam, std::span<double const> q) {
  SpatialMeshDiagnostics d;
  double const l = beam.element_length();
  d.rotation_length = beam.length();
  std::vector<Vec3> const implied = implied_curve(beam, q);
  for (std::size_t i = 0; i < implied.size(); ++i) {
    detail::add_nodes<3>(d, Vec3(part<3>(q, 7 * Index(i))), implied[i]);
    if (i == 0) continue;
    typename B::Point const middle{Index(i) - 1, 0.5, 0.0, 0.0};
    d.rotation_curvature.push_back(implied_curvature(beam.rotation_field(middle, q)));
    if constexpr (requires { beam.axis_slopes(middle, q); })
      detail::add_axis<3>(d, l, beam.axis_slopes(middle, q));
    else
      detail::add_axis<3>(d, l, detail::slopes_of_chord<3>(d, l));
  }
  return d;
}

}  // namespace polybody
