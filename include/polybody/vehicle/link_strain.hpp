#pragma once
/// \file
/// The stretch of a track's link, from a coupled run and from a rigid run's record. Not in polybody.hpp: of use to vehicles only.

#include <array>

#include <polybody/analysis/decoupled_stress.hpp>
#include <polybody/analysis/section.hpp>
#include <polybody/vehicle/track_links.hpp>

namespace polybody::m113 {

/// Where strain is asked for, from the rear pin [m]: at two Gauss points, so that the mean of both is that of the link, change of
/// length over length, though contact forces in the middle make the axial force jump there.
inline constexpr std::array<double, 2> strain_places{pitch * (0.5 - 0.28867513459481288), pitch * (0.5 + 0.28867513459481288)};

/// Mean axial strain of a flexible link.
template <class M, class B>
double link_strain(M const& model, State const& x, BodyHandle<B> const& link) {
  return 0.5 * (axial_strain(model, x, link.at(strain_places[0])) + axial_strain(model, x, link.at(strain_places[1])));
}

/// … of a rigid link at each time of its record.
inline std::vector<double> link_strain(DecoupledStress const& stress) {
  std::vector<double> out = stress.axial_strain(strain_places[0]);
  std::vector<double> const other = stress.axial_strain(strain_places[1]);
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = 0.5 * (out[i] + other[i]);
  return out;
}

/// What bending adds to that in the fibre towards the wheels, just ahead of the middle, where contacts push.
inline std::vector<double> link_bending(DecoupledStress const& stress) {
  double const by_moment = 0.5 * cable_height / *constants(link_bar()).EI_y;
  std::vector<double> out;
  for (Vec6 const& n : stress.section_forces(0.5 * pitch)) out.push_back(by_moment * n[4]);
  return out;
}

/// The same link as a structure, two elements with a node in the middle.
inline Structure link_structure() { return structure_of(link_bar(), 2); }

/// (T₀ + m v²/p)/EA: the strain in a chain of links of mass m and pitch p that runs at speed v [m/s] and is pulled by T₀ [N].
inline double running_strain(double speed, double pull) {
  return (pull + thesis.link.mass * speed * speed / pitch) / constants(link_bar()).EA;
}

}  // namespace polybody::m113
