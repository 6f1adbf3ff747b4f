#pragma once
/// \file
/// What the vehicle of m113_vehicle.hpp is made with besides the formulation of its tracks, and pins of a stiffness.
/// Not in polybody.hpp: of use to vehicles only.

#include <vector>

#include <polybody/joints/policies/bushing.hpp>
#include <polybody/joints/policies/penalty.hpp>
#include <polybody/vehicle/m113.hpp>
#include <polybody/vehicle/track_path.hpp>

namespace polybody::m113 {

/// Where the links of either side and the idler are at the start.
struct TrackStart {
  double idler_x = idler_reference_x;                        ///< [m]
  std::vector<TrackLink> links = wrap_track(track()).links;  ///< 64
};

/// Pins as penalties of `stiffness` [N/m]: rows that are direction cosines get that of forces at the ends of a link's
/// width.
template <class = void>  // compiled where it is used
PenaltyPerRow<5> penalty_pin(double stiffness) {
  Vec<double, 5> rows;
  rows << 1.0, 1.0, 1.0, pin_arm * pin_arm, pin_arm * pin_arm;
  return {.stiffness = Vec<double, 5>(stiffness * rows), .damping = Vec<double, 5>(pin_damping * rows)};
}
/// Pins as bushings of `stiffness` [N/m], whose third axis is the pin's.
template <class = void>
Bushing bushing_pin(double stiffness) {
  Vec3 const along(1.0, 1.0, 1.0), about(pin_arm * pin_arm, pin_arm * pin_arm, 0.0);
  return {.stiffness = Bushing::diagonal(stiffness * along, stiffness * about),
          .damping = Bushing::diagonal(pin_damping * along, pin_damping * about)};
}

/// How a track of ideal pins closes. Pins about parallel axes around a loop have three rows too many.
enum class Closure {
  stiff_spring,  ///< the 64th pin is no constraint but 10⁹ N/m between two points, as thesis Table 3.4 counts
  in_plane       ///< two rows hold its points together across the pin's axis: the loop needs no more
};

/// Where on a link that what it touches acts, as a wrench.
enum class ContactsAct {
  in_the_middle,   ///< all about the link's middle
  at_their_places  ///< wheels about the middle of a third of the link, teeth about the front pin, the ground about the
                   ///< pairs of corners of the pad, rims about the middle
};

/// Options of the vehicle besides the formulation of its tracks. The defaults are those of m113.hpp.
struct VehicleOptions {
  Solids masses = thesis;                   ///< of all bodies
  bool suspension = true;                   ///< else the arms are welded to the chassis, without springs
  double preload = m113::preload;           ///< of the tensioners [N]
  int cut = 0;                              ///< the pin of each track that closes the loop where pins are rows
  Closure closure = Closure::stiff_spring;  ///< of tracks of ideal pins
  TrackStart start = {};                    ///< of links and idler
  int link_elements = 0;                    ///< of each flexible link; 0: one, and two of a floating frame
  bool friction = true;                     ///< of all contacts
  double friction_factor = 1.0;             ///< of all coefficients of m113.hpp [1]
  ContactsAct contacts = ContactsAct::in_the_middle;  ///< on a link
  bool held = false;         ///< the chassis is welded to the ground and the arms to the chassis
  bool ground_body = false;  ///< as thesis Table 3.4 counts: the ground is a body too, welded to the world
};

/// \throws InvalidInput.
template <class = void>  // compiled where it is used
void check(VehicleOptions const& options) {
  if (options.start.links.size() != std::size_t(links))
    throw InvalidInput{"M113: the start needs the places of ", links, " links, but has ", options.start.links.size(),
                       "."};
  if (options.cut < 0 || options.cut >= links)
    throw InvalidInput{"M113: the pin that closes a track is one of 0 … 63, but ", options.cut, " is asked for."};
  if (options.link_elements < 0)
    throw InvalidInput{"M113: a flexible link has one element or more, but ", options.link_elements, " are asked for."};
  require_not_negative(options.friction_factor, "M113: the factor of the coefficients of friction");
}

}  // namespace polybody::m113
