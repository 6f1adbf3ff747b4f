#pragma once
/// \file
/// Strains and forces of the sections of beams, with the same names for every formulation.
/// Theory: Eq. 11.14.

#include <span>

#include <polybody/bodies/shared/bar.hpp>

namespace polybody {

/// Body that computes section strains and section forces at its coordinates q, with the same names for every
/// formulation. The strains and the forces are vectors of six in the axes of the deformed section, with x along the
/// beam:
///   section_strains  (ε, γ_y, γ_z, κ_x, κ_y, κ_z): stretch, shears, twist and curvatures [1], [1/m], relative to the
///                    undeformed shape;
///   section_forces   (N, Q_y, Q_z, M_x, M_y, M_z): axial and shear forces [N], torque and bending moments [N m],
///                    without damping. The part beyond the section exerts these forces on the part before the section.
/// Components that a formulation does not have are zero: a cable has no shear and no torsion. Cables and floating
/// frames also return zero for the shear force, which is the derivative of the bending moment along the axis. The axial
/// force of a floating frame does not include the pretension of the bar.
template <class B>
concept HasSections = requires(B const b, typename B::Point p, std::span<double const> q) {
  { b.section_strains(p, q) } -> std::convertible_to<Vec6>;
  { b.section_forces(p, q) } -> std::convertible_to<Vec6>;
};

/// Derivatives of the position of the axis with respect to the arc length of the reference, in world axes of the plane
/// (dim = 2) or of space (dim = 3).
template <int dim>
struct AxisSlopes {
  Mat<double, dim, 1> first;   ///< r′ [1]
  Mat<double, dim, 1> second;  ///< r″ [1/m]
};

/// Distances (y, z) of the point p from the axis [m]; zero if points of its type have no such distance.
template <class P, class T = double>  // compiled only if used
Vec<T, 2> off_axis(P const& p) {
  Vec<T, 2> x(0.0, 0.0);
  if constexpr (requires { p.y; }) x[0] = p.y;
  if constexpr (requires { p.z; }) x[1] = p.z;
  return x;
}

/// Strain ε − y κ_z + z κ_y of the fibre at (y, z) [m] of a section that remains plane. `strains` are the section
/// strains (`HasSections`).
inline double fibre_strain(Vec6 const& strains, double y, double z) {
  return strains[0] - y * strains[5] + z * strains[4];
}

/// Axial stress N/A − y M_z/I_z + z M_y/I_y [N/m²] of the fibre at (y, z) [m]. `forces` are the section forces
/// (`HasSections`).
/// \throws InvalidInput for a bar without section and material.
template <class = void>
double fibre_stress(Bar const& bar, Vec6 const& forces, double y, double z) {
  if (!bar.material)
    throw InvalidInput(
        "bar.no_section",
        {ErrorObject{"fibre_stress"},
         ": the bar has only constants. Give it a section and a material, from which the stress follows."});
  BarConstants const c = constants(bar);
  return bar.material->young * (forces[0] / c.EA - y * forces[5] / c.EI + z * forces[4] / *c.EI_y);
}

}  // namespace polybody
