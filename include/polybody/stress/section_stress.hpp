#pragma once
/// \file
/// Stress at a point of a bar's section from the section forces (N, Q_y, Q_z, M_x, M_y, M_z) of
/// bodies/shared/sections.hpp; principal stresses and von Mises stress. Saint-Venant's theory is used, which is valid
/// away from the ends and from point loads.
///
/// Not included in polybody.hpp: few programs need it.

#include <polybody/bodies/shared/sections.hpp>

namespace polybody {

/// Stress at a point of the cross section of a bar.
struct SectionStress {
  double axial = 0.0;         ///< σ_x [N/m²]
  Vec2 shear = Vec2::Zero();  ///< (τ_xy, τ_xz) [N/m²]

  /// Principal stresses σ₁ ≥ 0 ≥ σ₃, σ/2 ± √((σ/2)² + τ²) [N/m²]; the middle one is zero.
  Vec2 principal() const {
    double const half = 0.5 * axial, radius = std::hypot(half, shear.norm());
    return {half + radius, half - radius};
  }
  /// Von Mises stress √(σ² + 3 τ²) [von Mises 1913].
  double von_mises() const { return std::hypot(axial, std::sqrt(3.0) * shear.norm()); }
};

namespace detail {

/// Shear stress in a circular section of radius r, with Poisson's ratio ν, I = π r⁴/4 and I_p = 2 I. Torque: τ = M_x
/// (−z, y)/I_p. Force P along x of section axes x, y [Timoshenko & Goodier 1970, §121]:
///   τ_x = (3+2ν)/(8(1+ν)) P/I (r² − x² − (1−2ν)/(3+2ν) y²),   τ_y = −(1+2ν)/(4(1+ν)) P/I x y.
inline Vec2 shear_of(Circle const& c, double nu, Vec6 const& n, double y, double z) {
  double const r2 = c.radius * c.radius, i = 0.25 * std::numbers::pi * r2 * r2;
  double const k = (3.0 + 2.0 * nu) / (8.0 * (1.0 + nu)) / i, ratio = (1.0 - 2.0 * nu) / (3.0 + 2.0 * nu),
               across = -(1.0 + 2.0 * nu) / (4.0 * (1.0 + nu)) / i * y * z;
  return Vec2(-z, y) * (0.5 * n[3] / i) + Vec2(n[1] * k * (r2 - y * y - ratio * z * z) + n[2] * across,
                                               n[2] * k * (r2 - z * z - ratio * y * y) + n[1] * across);
}

/// Shear stress in a rectangular section of height h, width w and area A. Force Q along y: 3/2 Q/A (1 − (2y/h)²), exact
/// for Poisson's ratio ν = 0. Torque: τ = (φ_z, −φ_y),
///   φ = Gϑ [h²/4 − y² − (8h²/π³) Σ_odd (−1)^((k−1)/2)/k³ · cosh(kπz/h)/cosh(kπw/2h) · cos(kπy/h)],   Gϑ = M_x/J
/// [Timoshenko & Goodier 1970, §109]. The axis y is parallel to the shorter side, so that the series converges fast.
inline Vec2 shear_of(Rectangle const& s, double torsion, Vec6 const& n, double y, double z) {
  double const area = s.height * s.width, pi = std::numbers::pi;
  bool const swap = s.height > s.width;
  double const h = swap ? s.width : s.height, w = swap ? s.height : s.width, a = swap ? z : y, b = swap ? y : z;
  double by_a = -2.0 * a, by_b = 0.0;  // derivatives of φ/Gϑ
  for (int k = 1; k < 60; k += 2) {
    double const p = k * pi / h, sign = (k - 1) % 4 == 0 ? 1.0 : -1.0,
                 scale = sign * 8.0 * h * h / (pi * pi * pi) / std::pow(k, 3);
    double const up = std::exp(p * (std::abs(b) - 0.5 * w)), down = std::exp(-p * (std::abs(b) + 0.5 * w)),
                 full = 1.0 + std::exp(-p * w);
    by_a += scale * p * (up + down) / full * std::sin(p * a);
    by_b -= scale * p * std::copysign(up - down, b) / full * std::cos(p * a);
  }
  Vec2 const turn = (n[3] / torsion) * (swap ? Vec2(by_a, -by_b) : Vec2(by_b, -by_a));
  auto const parabola = [&](double q, double x, double side) {
    return 1.5 * q / area * (1.0 - 4.0 * x * x / (side * side));
  };
  return turn + Vec2(parabola(n[1], y, s.height), parabola(n[2], z, s.width));
}

}  // namespace detail

/// Stress at the point (y, z) [m] of the section under section `forces` (N, Q_y, Q_z, M_x, M_y, M_z) [N], [N m].
/// \throws InvalidInput for a bar without section and material, and for a point outside the section.
template <class = void>
SectionStress section_stress(Bar const& bar, Vec6 const& forces, double y, double z) {
  SectionStress out;
  out.axial = fibre_stress(bar, forces, y, z);
  if (auto const* c = std::get_if<Circle>(&bar.section)) {
    if (!(std::hypot(y, z) <= c->radius * (1.0 + 1e-9)))
      throw InvalidInput("section.outside",
                         {ErrorObject{"section_stress"}, ": the point (", y, ", ", z, ") m lies outside the circle."});
    out.shear = detail::shear_of(*c, bar.material->poisson, forces, y, z);
  } else {
    Rectangle const& s = std::get<Rectangle>(bar.section);
    if (!(std::abs(y) <= 0.5 * s.height * (1.0 + 1e-9) && std::abs(z) <= 0.5 * s.width * (1.0 + 1e-9)))
      throw InvalidInput("section.outside", {ErrorObject{"section_stress"}, ": the point (", y, ", ", z,
                                             ") m lies outside the rectangle."});
    BarConstants const k = constants(bar);
    double const g = bar.material->young / (2.0 * (1.0 + bar.material->poisson));
    out.shear = detail::shear_of(s, k.GJ / g, forces, y, z);
  }
  return out;
}

}  // namespace polybody
