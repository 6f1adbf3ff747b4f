#pragma once
/// \file
/// Options of the vehicle of vehicle.hpp except the formulation of its tracks, and pins as penalties or bushings.

#include <vector>

#include <polybody/joints/policies/bushing.hpp>
#include <polybody/joints/policies/penalty.hpp>
#include <polybody/vehicle/track_path.hpp>

#include "data.hpp"

namespace polybody::m113 {

/// Initial positions of the idler and of the links of either side.
struct TrackStart {
  double idler_x = idler_reference_x;                        ///< position of the idler along x [m]
  std::vector<TrackLink> links = wrap_track(track()).links;  ///< placements of the 64 links
};

/// Pins as penalties of `stiffness` [N/m]. The rotational stiffness, for equations that are direction cosines, equals
/// the stiffness of springs at both ends of the link's width.
template <class = void>  // compiled only if it is used
PenaltyPerEquation<5> penalty_pin(double stiffness) {
  Vec<double, 5> rows;
  rows << 1.0, 1.0, 1.0, pin_arm * pin_arm, pin_arm * pin_arm;
  return {.stiffness = Vec<double, 5>(stiffness * rows), .damping = Vec<double, 5>(pin_damping * rows)};
}
/// Pins as bushings of `stiffness` [N/m]. The third axis of a bushing is the axis of the pin.
template <class = void>
Bushing bushing_pin(double stiffness) {
  Vec3 const along(1.0, 1.0, 1.0), about(pin_arm * pin_arm, pin_arm * pin_arm, 0.0);
  return {.stiffness = Bushing::diagonal(stiffness * along, stiffness * about),
          .damping = Bushing::diagonal(pin_damping * along, pin_damping * about)};
}

/// Closure of a track with ideal pins. A closed loop of pins with parallel axes has three redundant constraints.
enum class Closure {
  stiff_spring,  ///< the 64th pin is a spring of 10⁹ N/m between two points, not a constraint [Wallin 2016, Table 3.4]
  in_plane  ///< two equations keep the 64th pin's points together across its axis; more equations would be redundant
};

/// Point of a link at which contact forces act as a wrench.
enum class ContactsAct {
  in_the_middle,   ///< all contact forces act at the link's middle
  at_their_places  ///< wheels act at the middle of a third of the link, teeth at the front pin, the ground at the pairs
                   ///< of corners of the pad, rims at the middle
};

/// Options of the vehicle except the formulation of its tracks. The defaults are the values of data.hpp.
struct VehicleOptions {
  Solids masses = wallin_2016;     ///< masses and inertias of all bodies
  bool suspension = true;          ///< false: the arms are welded to the chassis, without springs
  double preload = m113::preload;  ///< preload of the tensioners [N]
  int cut = 0;                     ///< number of the pin that closes the loop of each track, if pins are constraints
  Closure closure = Closure::stiff_spring;  ///< closure of tracks with ideal pins
  TrackStart start = {};                    ///< initial positions of links and idlers
  int link_elements = 0;         ///< elements of each flexible link; 0: one element, or two in a floating frame
  bool friction = true;          ///< friction in all contacts
  double friction_factor = 1.0;  ///< factor of all friction coefficients of data.hpp [1]
  ContactsAct contacts = ContactsAct::in_the_middle;  ///< points of action on a link
  /// True if stiffness and damping of a contact in data.hpp are the sums over all contact points of a link on one body:
  /// two rims, two rings of teeth, four corners of the pad.
  bool shared_contacts = false;
  bool held = false;         ///< true: the chassis is welded to the ground, and the arms to the chassis
  bool ground_body = false;  ///< true: the ground is a body, welded to the world [Wallin 2016, Table 3.4]
};

/// Checks the options. \throws InvalidInput.
template <class = void>  // compiled only if it is used
void check(VehicleOptions const& options) {
  if (options.start.links.size() != std::size_t(links))
    throw InvalidInput("m113.option", {ErrorObject{"M113"}, ": the start needs the positions of ", links,
                                       " links, but has ", ErrorValue{options.start.links.size()}, "."});
  if (options.cut < 0 || options.cut >= links)
    throw InvalidInput("m113.option",
                       {ErrorObject{"M113"}, ": the pin that closes a track must lie in [0, 63], but is ",
                        ErrorValue{options.cut}, "."});
  if (options.link_elements < 0)
    throw InvalidInput("m113.option", {ErrorObject{"M113"},
                                       ": the number of elements of a flexible link must not be negative, but is ",
                                       ErrorValue{options.link_elements}, "."});
  require_not_negative(options.friction_factor, "M113: the factor of the coefficients of friction");
}

}  // namespace polybody::m113
