#pragma once
/// \file
/// The links of a track as floating frames with modes. Not in polybody.hpp: of use to vehicles only, and it comes with
/// Eigen's sparse module.

#include <polybody/bodies/ffr/beam_structure.hpp>
#include <polybody/bodies/ffr/ffr.hpp>
#include <polybody/vehicle/track_links.hpp>

namespace polybody::m113 {

/// Two elements, unless more are asked for, with a boundary frame at each pin, the floating frame tied to the rear one
/// [Craig & Bampton 1968]: the six static shapes of the front pin's motion and the three lowest modes between the pins:
/// torsion, bending up and down, stretch.
template <>
struct LinkOf<Ffr> : detail::BeamLink<Ffr> {
  static constexpr Index modes_between = 3;
  static Ffr make(Solid const&, Placement const& at, int elements) {
    Bar const bar = link_bar(at);
    int const n = std::max(elements, 2);
    Structure structure = structure_of(bar, n);
    MatX shapes = craig_bampton(structure, {0, n}, modes_between);
    return Ffr(std::move(structure), std::move(shapes), {.placement = bar.placement});
  }
};

}  // namespace polybody::m113
