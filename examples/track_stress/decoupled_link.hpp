#pragma once
// A recorded rigid link as a structure.
#include "m113/decoupled_link_strain.hpp"
#include "stress_runs.hpp"

namespace chapter4 {

// With the link's mass, also where its section is another.
inline Structure structure_of_link(Options const& o) {
  Bar bar = m113::link_bar({}, section_height(o));
  double const heavier = o.section == 1.0 ? 1.0 : o.masses.link.mass / flexible_mass(o);
  bar.material->density = heavier * bar.material->density;
  return m113::link_structure(bar);
}
// A link of another height has another moment of inertia about its pins, by up to a sixth.
inline StructureLoadOptions loads(Options const& o) {
  return o.section == 1.0 ? StructureLoadOptions{} : StructureLoadOptions{.balance_tolerance = 0.2};
}
inline DecoupledStress quasi_static(Options const& o, BodyRecord const& record) {
  return DecoupledStress::quasi_static(structure_of_link(o), record, loads(o));
}

}  // namespace chapter4
