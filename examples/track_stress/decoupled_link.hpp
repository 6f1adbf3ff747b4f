#pragma once
// Structure of a rigid link, with which its stress is computed from recorded loads.
#include "m113/decoupled_link_strain.hpp"
#include "stress_runs.hpp"

namespace chapter4 {

// Structure with the mass of the rigid link, even if its section has another height.
inline Structure structure_of_link(LinkSettings const& o) {
  Bar bar = m113::link_bar({}, section_height(o), o.young * m113::youngs_modulus);
  double const heavier = o.section == 1.0 ? 1.0 : o.masses.link.mass / flexible_mass(o);
  bar.material->density = heavier * bar.material->density;
  return m113::link_structure(bar);
}
// Options of the loads. Another height of the section changes the moment of inertia about the pins by up to a sixth, so
// the balance needs a larger tolerance.
inline StructureLoadOptions loads(LinkSettings const& o) {
  return o.section == 1.0 ? StructureLoadOptions{} : StructureLoadOptions{.balance_tolerance = 0.2};
}
inline DecoupledStress quasi_static(LinkSettings const& o, BodyRecord const& record) {
  return DecoupledStress::quasi_static(structure_of_link(o), record, loads(o));
}

}  // namespace chapter4
