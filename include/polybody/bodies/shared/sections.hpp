#pragma once
/// \file
/// Strains and forces of a beam's section, under the same names for every formulation. In the axes of the section as it
/// stands, x along the beam, as vectors of six:
///   section_strains  (ε, γ_y, γ_z, κ_x, κ_y, κ_z): stretch, shears, twist and curvatures [1], [1/m], those of the
///   reference taken off section_forces   (N, Q_y, Q_z, M_x, M_y, M_z): axial and shear forces [N], torque and bending
///   moments [N m], without damping
/// that the part beyond the section exerts on the part before it. What a formulation does not know is zero: a cable has
/// no shear and no torsion; shear force follows there, as in the floating frame, from the slope of the moment.

#include <span>

#include <polybody/bodies/shared/bar.hpp>

namespace polybody {

/// A body that tells them, at its coordinates q.
template <class B>
concept HasSections = requires(B const b, typename B::Point p, std::span<double const> q) {
  { b.section_strains(p, q) } -> std::convertible_to<Vec6>;
  { b.section_forces(p, q) } -> std::convertible_to<Vec6>;
};

/// (y, z) of the point p off the axis [m]; zero where its type has none.
template <class P>
Vec2 off_axis(P const& p) {
  Vec2 x = Vec2::Zero();
  if constexpr (requires { p.y; }) x[0] = p.y;
  if constexpr (requires { p.z; }) x[1] = p.z;
  return x;
}

/// Strain of the fibre (y, z) [m] of a section that stays plane, `strains` (Γ, K): ε − y κ_z + z κ_y.
inline double fibre_strain(Vec6 const& strains, double y, double z) {
  return strains[0] - y * strains[5] + z * strains[4];
}

/// Axial stress of that fibre under `forces` (N, M), N/A − y M_z/I_z + z M_y/I_y [N/m²]. \throws InvalidInput for a bar
/// without section and material.
template <class = void>
double fibre_stress(Bar const& bar, Vec6 const& forces, double y, double z) {
  if (!bar.material)
    throw InvalidInput("fibre_stress: the bar is given by constants; stresses need its section and material.");
  BarConstants const c = constants(bar);
  return bar.material->young * (forces[0] / c.EA - y * forces[5] / c.EI + z * forces[4] / *c.EI_y);
}

}  // namespace polybody
