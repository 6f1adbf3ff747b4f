#pragma once
/// \file
/// Axial strain and bending strain of a rigid track link, computed after a run from its record. See link_strain.hpp
/// for flexible links.

#include <polybody/stress/decoupled_stress.hpp>

#include "link_strain.hpp"

namespace polybody::m113 {

/// Mean axial strain of a rigid link at each time of its record.
template <class = void>  // compiled only if it is used
std::vector<double> link_strain(DecoupledStress const& stress) {
  std::vector<double> out(stress.times().size(), 0.0);
  for (double const s : strain_places) {
    std::vector<double> const there = stress.axial_strain(s);
    for (std::size_t i = 0; i < out.size(); ++i) out[i] += there[i] / double(strain_places.size());
  }
  return out;
}

/// Bending strain of a rigid link at each time of its record, in a section of this `height` [m].
template <class = void>
std::vector<double> link_bending(DecoupledStress const& stress, double height = cable_height) {
  std::vector<double> out;
  for (Vec6 const& n : stress.section_forces(0.5 * pitch)) out.push_back(bending_by_moment(height) * n[4]);
  return out;
}

/// Structure of a link: two elements with a node in the middle.
template <class = void>
Structure link_structure(Bar const& bar = link_bar()) {
  return structure_of(bar, 2);
}

}  // namespace polybody::m113
