#pragma once
/// \file
/// Strains, forces and stress of a section at a marker in a state, for every formulation
/// (bodies/shared/sections.hpp).

#include <polybody/bodies/shared/sections.hpp>
#include <polybody/system/lookup.hpp>

namespace polybody {

namespace detail {
template <class M, class B, class F>
auto ask_section(M const& model, State const& x, Marker<B> const& marker, F&& f) {
  static_assert(HasSections<B>,
                "This function needs the marker of a flexible beam; a rigid body and the ground do not deform.");
  BodyInState<B> const b = body_in_state(model, x, marker, "section");
  return f(b.body, marker.point, b.q);
}
}  // namespace detail

/// Strains (ε, γ_y, γ_z, κ_x, κ_y, κ_z) of the marker's section. \throws InvalidInput for a marker of another model.
template <class M, class B>
Vec6 section_strains(M const& model, State const& x, Marker<B> const& marker) {
  return detail::ask_section(model, x, marker,
                             [](B const& b, auto const& p, auto q) { return b.section_strains(p, q); });
}
/// Section forces (N, Q_y, Q_z, M_x, M_y, M_z) of the marker's section [N], [N m].
template <class M, class B>
Vec6 section_forces(M const& model, State const& x, Marker<B> const& marker) {
  return detail::ask_section(model, x, marker,
                             [](B const& b, auto const& p, auto q) { return b.section_forces(p, q); });
}

/// Curvature of the axis relative to the reference state, √(κ_y² + κ_z²) [1/m].
template <class M, class B>
double curvature(M const& model, State const& x, Marker<B> const& marker) {
  Vec6 const e = section_strains(model, x, marker);
  return std::hypot(e[4], e[5]);
}
/// Axial strain of the fibre through the marker's point.
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
