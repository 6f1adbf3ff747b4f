#pragma once
/// \file
/// The stretch and the bending of a track's flexible link in a coupled run; decoupled_link_strain.hpp has those of a
/// rigid one. Not in polybody.hpp: of use to vehicles only.

#include <array>

#include <polybody/run/points.hpp>
#include <polybody/stress/section.hpp>
#include <polybody/vehicle/link_axes.hpp>
#include <polybody/vehicle/track_links.hpp>

namespace polybody::m113 {

/// Places where strain is taken, from the rear pin [m]: two Gauss points of either half. The mean over them is the
/// change of the link's length over its length, also where contact forces make the axial force jump in the middle.
inline constexpr std::array<double, 4> strain_places{
    pitch * (0.25 - 0.14433756729740644), pitch * (0.25 + 0.14433756729740644), pitch * (0.75 - 0.14433756729740644),
    pitch * (0.75 + 0.14433756729740644)};

/// Mean axial strain of a flexible link in a state of the model that made the handle.
template <class B>
double link_strain(BodyHandle<B> const& link, State const& x) {
  BodyInState<B> const b = body_in_state(link, x);
  double sum = 0.0;
  for (double const s : strain_places) {
    auto const point = link.at(s).point;
    Vec2 const off = off_axis(point);
    sum += fibre_strain(b.body.section_strains(point, b.q), off[0], off[1]);
  }
  return sum / double(strain_places.size());
}

/// Axial strain in the fibre towards the wheels by a unit moment M_y about the pins' direction [1/(N m)]; `height` of
/// the section, here and below [m].
template <class = void>  // compiled where it is used
double bending_by_moment(double height = cable_height) {
  return 0.5 * height / *constants(link_bar({}, height)).EI_y;
}

/// Axial strain by bending in the fibre towards the wheels, of a section of this `height` [m], just ahead of the
/// middle, where contacts push. One cubic element shows half of the effect of a force there, one linear element none;
/// two elements have a node there and show it in full. A cable needs `lateral`, the vehicle's y axis, to know the side
/// of the wheels (link_axes.hpp).
template <class B>
double link_bending(BodyHandle<B> const& link, State const& x, Vec3 const& lateral, double height = cable_height) {
  BodyInState<B> const b = body_in_state(link, x);
  auto const middle = link.at(0.5 * pitch).point;
  Frame<double> const section = frame(b, middle);
  Vec3 const moment = section.A * b.body.section_forces(middle, b.q).template tail<3>();
  return bending_by_moment(height) * moment.dot(link_axes<B::observes>(section, lateral).col(1));
}

/// (T₀ + m v²/p)/EA: the strain in a chain of links of mass m [kg], pitch p and `height` [m] that runs at speed v [m/s]
/// and is pulled by T₀ = `pull` [N].
inline double running_strain(double speed, double pull, double height = cable_height, double mass = thesis.link.mass) {
  return (pull + mass * speed * speed / pitch) / constants(link_bar({}, height)).EA;
}

}  // namespace polybody::m113
