#pragma once
// Combinations of links of one body formulation with pins of each policy. Each file of links compiles one formulation.
#include "../any_vehicle.hpp"
#include "m113/link_strain.hpp"
#include "stress_runs.hpp"
#include "surface.hpp"

namespace chapter4 {

// Watched link of a vehicle, with its outputs: strain and bending of a flexible link, and stress of a finite element
// link. The loads of a rigid link are recorded instead.
template <class V, class Links>
WatchedLink watched(Options const& o, std::shared_ptr<V const> const& vehicle, Links const& links) {
  auto const link = vehicle->side(m113::Side::left).links[watched_link];
  if constexpr (HasRigidPoints<typename V::LinkType>) {
    WatchedLink of{.rigid = link};
    for (auto const& side : vehicle->sides)
      of.rigid_links.insert(of.rigid_links.end(), side.links.begin(), side.links.end());
    return of;
  } else {
    if constexpr (requires { links.model; })
      if (links.model)
        return {.see = [o, vehicle, link](State const& x, LinkHistory& h) {
          add_surface(h, o, x.q.segment(vehicle->model.entry(link).q0 + 7, link.body().deformations()));
        }};
    return {.see = [height = section_height(o), young = o.young, vehicle, link](State const& x, LinkHistory& h) {
      h.strain.push_back(m113::link_strain(link, x));
      Vec3 const lateral = vehicle->hull(x).A.col(1);
      h.bending.push_back(m113::link_bending(link, x, lateral, height) / young);
    }};
  }
}

// Reason for which pins of type Policy cannot connect links of type Body; empty if they can. Model::connect refuses the
// same combinations.
template <class Body, class Policy>
constexpr char const* refusal() {
  using Pin = Joint<Revolute, Policy>;
  if constexpr (LinearPolicy<Policy> && !HasLinearPoints<Body>)
    return "the frames of its ends are not linear in its coordinates";
  else if constexpr (!CarriableBody<Policy, Body>)
    return "it has no frame that a joint could carry";
  else if constexpr (!SufficientFirstMarker<Pin, Body> || !SufficientSecondMarker<Pin, Body>)
    return "its ends have an axis and no frame, so the axis of a pin is not defined";
  else
    return "";
}

// Function that returns the link factory for links of type Body and the options.
template <class Body>
using LinksMade = std::function<m113::LinkOf<Body>(Options const&)>;

template <class Body, class Policy>
Combination combination(std::string const& links, std::string const& pins, bool usual, Policy const& policy,
                        LinksMade<Body> const& made) {
  Combination c{links, pins, usual, refusal<Body, Policy>(), Body::observes != MarkerKind::axis};
  if constexpr (*refusal<Body, Policy>() == '\0')
    c.make = [=](Options const& o, VehicleParts const& parts) {
      m113::LinkOf<Body> const of_links = made(o);
      auto const vehicle = made_vehicle<Body>(policy, parts, of_links);
      return StressVehicle{any_vehicle(vehicle, stepped_by<GeneralisedAlpha>), watched(o, vehicle, of_links)};
    };
  return c;
}

template <class Body>
m113::LinkOf<Body> with_section(Options const& o) {
  m113::LinkOf<Body> links;
  if constexpr (requires { links.height; }) links.height = section_height(o);
  if constexpr (requires { links.young; }) links.young = o.young * m113::youngs_modulus;
  return links;
}

// Links of Body under each policy of the pins, in the order of all_pins.
template <class Body, Policy Usual>
std::vector<Combination> links_of(std::string const& name, LinksMade<Body> const& made = with_section<Body>) {
  auto const by = [&](std::size_t pins, auto const& policy) {
    bool const usual = std::is_same_v<std::remove_cvref_t<decltype(policy)>, Usual>;
    return combination<Body>(name, all_pins[pins], usual, policy, made);
  };
  return {by(0, Constraint{}), by(1, m113::penalty_pin(m113::pin_stiffness)),
          by(2, m113::bushing_pin(m113::pin_stiffness)), by(3, AncfLinear{}), by(4, JointCoordinates{})};
}

}  // namespace chapter4
