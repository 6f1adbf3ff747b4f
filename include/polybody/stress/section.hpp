#pragma once
/// \file
/// Curvature, strain and stress of a section at a marker in a state, for every formulation
/// (bodies/shared/sections.hpp).

#include <polybody/run/marker_frames.hpp>

namespace polybody {

/// Curvature of the axis relative to the reference state, √(κ_y² + κ_z²) [1/m].
template <class M, class B>
double curvature(M const& model, State const& x, Marker<B> const& marker) {
  Vec6 const e = section_strains(model, x, marker);
  return std::hypot(e[4], e[5]);
}
/// Axial strain [1] of the fibre through the marker's point.
template <class M, class B>
double axial_strain(M const& model, State const& x, Marker<B> const& marker) {
  Vec2 const off = off_axis(marker.point);
  return fibre_strain(section_strains(model, x, marker), off[0], off[1]);
}
/// Axial stress [N/m²] of the fibre through the marker's point; `bar` describes the body. \throws InvalidInput for a
/// bar without section and material.
template <class M, class B>
double axial_stress(M const& model, State const& x, Marker<B> const& marker, Bar const& bar) {
  Vec2 const off = off_axis(marker.point);
  return fibre_stress(bar, section_forces(model, x, marker), off[0], off[1]);
}

}  // namespace polybody
