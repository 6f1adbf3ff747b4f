#pragma once
/// \file
/// The stretch and the bending of a track's link, from a coupled run and from a rigid run's record.
///
/// Not in polybody.hpp: of use to vehicles only.

#include <array>

#include <polybody/run/observe.hpp>
#include <polybody/stress/decoupled_stress.hpp>
#include <polybody/stress/section.hpp>
#include <polybody/vehicle/link_axes.hpp>
#include <polybody/vehicle/track_links.hpp>

namespace polybody::m113 {

/// Places where strain is taken, from the rear pin [m]: two Gauss points of either half. The mean over them is the
/// change of the link's length over its length, also where contact forces make the axial force jump in the middle.
inline constexpr std::array<double, 4> strain_places{
    pitch * (0.25 - 0.14433756729740644), pitch * (0.25 + 0.14433756729740644), pitch * (0.75 - 0.14433756729740644),
    pitch * (0.75 + 0.14433756729740644)};

/// Mean axial strain of a flexible link.
template <class M, class B>
double link_strain(M const& model, State const& x, BodyHandle<B> const& link) {
  double sum = 0.0;
  for (double const s : strain_places) sum += axial_strain(model, x, link.at(s));
  return sum / double(strain_places.size());
}

/// Mean axial strain of a rigid link at each time of its record.
inline std::vector<double> link_strain(DecoupledStress const& stress) {
  std::vector<double> out(stress.times().size(), 0.0);
  for (double const s : strain_places) {
    std::vector<double> const there = stress.axial_strain(s);
    for (std::size_t i = 0; i < out.size(); ++i) out[i] += there[i] / double(strain_places.size());
  }
  return out;
}

/// Axial strain in the fibre towards the wheels by a unit moment M_y about the pins' direction [1/(N m)]; `height` of
/// the section, here and below [m].
inline double bending_by_moment(double height = cable_height) {
  return 0.5 * height / *constants(link_bar({}, height)).EI_y;
}

/// Axial strain by bending in the fibre towards the wheels, just ahead of the middle, where contacts push. One cubic
/// element shows half of the effect of a force there, one linear element none; two elements have a node there and show
/// it in full. A cable needs `lateral`, the vehicle's y axis, to know the side of the wheels (link_axes.hpp).
template <class M, class B>
double link_bending(M const& model, State const& x, BodyHandle<B> const& link, Vec3 const& lateral,
                    double height = cable_height) {
  auto const middle = link.at(0.5 * pitch);
  Frame<double> const section = frame(model, x, middle);
  Vec3 const moment = section.A * section_forces(model, x, middle).template tail<3>();
  return bending_by_moment(height) * moment.dot(link_axes<B::observes>(section, lateral).col(1));
}

/// Bending strain of a rigid link at each time of its record.
inline std::vector<double> link_bending(DecoupledStress const& stress, double height = cable_height) {
  std::vector<double> out;
  for (Vec6 const& n : stress.section_forces(0.5 * pitch)) out.push_back(bending_by_moment(height) * n[4]);
  return out;
}

/// The same link as a structure, two elements with a node in the middle.
inline Structure link_structure(Bar const& bar = link_bar()) { return structure_of(bar, 2); }

/// (T₀ + m v²/p)/EA: the strain in a chain of links of mass m [kg] and pitch p that runs at speed v [m/s] and is pulled
/// by T₀ [N].
inline double running_strain(double speed, double pull, double height = cable_height, double mass = thesis.link.mass) {
  return (pull + mass * speed * speed / pitch) / constants(link_bar({}, height)).EA;
}

}  // namespace polybody::m113
