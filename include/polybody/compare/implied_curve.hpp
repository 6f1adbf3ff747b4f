#pragma once
/// \file
/// Space curve that a rotation field implies [thesis §2.3]. Its tangent is the first axis of the sections, t = R e₁:
///   r(s) = r₀ + ∫ t ds (Eq. 2.2),  κ = |t′| (Eq. 2.4),  τ = t·(t′ × t″)/κ²  (Frenet).
/// With R′ = R K̃ the derivative of the tangent is t′ = R (0, K₃, −K₂), so that
///   κ² = K₂² + K₃²,  τ = K₁ + (K₂ K₃′ − K₃ K₂′)/κ².

#include <concepts>
#include <vector>

#include <polybody/bodies/lrvf/lrvf.hpp>
#include <polybody/math/quadrature.hpp>

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

/// Points of the curve that the rotation field of a beam implies at the coordinates q: the first node and `samples`
/// points in each element.
template <NodalInterpolation Interpolation, StrainQuadrature Quadrature>
std::vector<Vec3> implied_curve(Lrvf<Interpolation, Quadrature> const& beam, std::span<double const> q,
                                int samples = 1) {
  auto const rotation = [&](double s) { return beam.rotation_field(beam.at(s), q).R; };
  return implied_curve(rotation, beam.length(), beam.elements() * samples, part<3>(q, 0));
}

}  // namespace polybody
