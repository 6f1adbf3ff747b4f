#pragma once
/// \file
/// Axial strain and bending strain of a flexible track link in a coupled run. See decoupled_link_strain.hpp for rigid
/// links.

#include <array>

#include <polybody/run/marker_frames.hpp>
#include <polybody/vehicle/link_axes.hpp>

#include "links.hpp"

namespace polybody::m113 {

/// Distances of the strain points from the rear pin [m]: two Gauss points in either half. The mean strain at these
/// points equals the change of the link's length divided by its length. This holds also if contact forces cause a jump
/// of the axial force in the middle.
inline constexpr std::array<double, 4> strain_places{
    pitch * (0.25 - 0.14433756729740644), pitch * (0.25 + 0.14433756729740644), pitch * (0.75 - 0.14433756729740644),
    pitch * (0.75 + 0.14433756729740644)};

/// Mean axial strain of a flexible link in a state of the model that returned the handle.
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

/// Axial strain in the fibre towards the wheels due to a unit moment M_y about the direction of the pins [1/(N m)].
/// `height` is the height of the section [m].
template <class = void>  // compiled only if it is used
double bending_by_moment(double height = cable_height) {
  return 0.5 * height / *constants(link_bar({}, height)).EI_y;
}

/// Axial strain due to bending in the fibre towards the wheels. The section has this `height` [m] and lies just in
/// front of the link's middle, at which contact forces act. One cubic element resolves half of the effect of a force at
/// the middle; one linear element does not resolve this effect. Two elements have a node at the middle and resolve the
/// effect fully. For a cable, `lateral` (the vehicle's y axis) is required to determine the side of the wheels
/// (link_axes.hpp).
template <class B>
double link_bending(BodyHandle<B> const& link, State const& x, Vec3 const& lateral, double height = cable_height) {
  BodyInState<B> const b = body_in_state(link, x);
  auto const middle = link.at(0.5 * pitch).point;
  Frame<double> const section = frame(b, middle);
  Vec3 const moment = section.A * b.body.section_forces(middle, b.q).template tail<3>();
  return bending_by_moment(height) * moment.dot(link_axes<B::observes>(section, lateral).col(1));
}

/// Strain (T₀ + m v²/p)/EA in a chain that moves at speed v [m/s] under the tension T₀ = `pull` [N]. Its links have
/// the mass m [kg], the pitch p and this `height` [m].
inline double running_strain(double speed, double pull, double height = cable_height,
                             double mass = wallin_2016.link.mass) {
  return (pull + mass * speed * speed / pitch) / constants(link_bar({}, height)).EA;
}

}  // namespace polybody::m113
