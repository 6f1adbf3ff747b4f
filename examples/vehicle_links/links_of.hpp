#pragma once
// Links of one body formulation on pins of each policy. Each file of this folder compiles one formulation.
#include "../any_vehicle.hpp"
#include "integrators.hpp"
#include "m113/link_strain.hpp"
#include "surface.hpp"

namespace chapter3 {

// True for links without deformations.
template <class B>
inline constexpr bool is_rigid = formulation_family<B> == families::rigid;

template <class B>
RigidLink rigid_link(BodyHandle<B> const& link) {
  return {link.name, [link](LoadRecorder& to) { to.add(link); },
          [link](LoadRecorder const& from) -> BodyRecord const& { return from.of(link); }};
}

// Watched link of a vehicle, with its outputs: strain and bending of a flexible link, and stress of a finite element
// link. The loads of a rigid link are recorded instead.
template <class V, class Links>
WatchedLink watched(LinkSettings const& o, std::shared_ptr<V const> const& vehicle, Links const& links) {
  auto const link = vehicle->side(m113::Side::left).links[watched_link];
  if constexpr (is_rigid<typename V::LinkType>) {
    WatchedLink of{.rigid = rigid_link(link)};
    for (auto const& side : vehicle->sides)
      for (auto const& one : side.links) of.rigid_links.push_back(rigid_link(one));
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

// Function that returns the link factory for links of type B and the settings.
template <class B>
using LinksMade = std::function<m113::LinkOf<B>(LinkSettings const&)>;
template <class B>
m113::LinkOf<B> with_section(LinkSettings const& o) {
  m113::LinkOf<B> links;
  if constexpr (requires { links.height; }) links.height = section_height(o);
  if constexpr (requires { links.young; }) links.young = o.young * m113::youngs_modulus;
  return links;
}

// Policy P of pins, and its name for --policy.
template <class P>
struct NamedPolicy {
  char const* name;
  P (*policy)(double stiffness);
};
inline auto const pin_policies =
    std::tuple(NamedPolicy<Constraint>{"constraint", [](double) { return Constraint{}; }},
               NamedPolicy<PenaltyPerEquation<5>>{"penalty", [](double k) { return m113::penalty_pin(k); }},
               NamedPolicy<Bushing>{"bushing", [](double k) { return m113::bushing_pin(k); }},
               NamedPolicy<AncfLinear>{"ancf-linear", [](double) { return AncfLinear{}; }},
               NamedPolicy<JointCoordinates>{"joint-coordinates", [](double) { return JointCoordinates{}; }});

template <class B, class Usual, class P>
LinksOnPins on_pins(BodyName const& body, NamedPolicy<P> const& policy, LinksMade<B> const& made) {
  LinksOnPins out{{.body = body,
                   .policy = policy.name,
                   .usual = std::is_same_v<P, Usual>,
                   .family = combinations::family_of<B>(body.mesh),
                   .enforcement = P::name},
                  B::observes != MarkerKind::axis};
  if (CompliantPolicy<P>) out.body.model += std::string(", ") + policy.name;
  if (is_rigid<B>) out.stable_step = CompliantPolicy<P> ? 2.5e-5 : 1e-4;
  constexpr char const* refused = combinations::connect_refusal<Joint<Revolute, P>, B, B>();
  if constexpr (*refused == '\0') {
    using Model = typename m113::Vehicle<B, P, BumpCourse>::ModelType;
    out.make = [pins = policy.policy, made](LinkSettings const& o, VehicleParts const& parts) {
      m113::LinkOf<B> const links = made(o);
      auto const vehicle = made_vehicle<B>(pins(o.spring_pins), parts, links);
      return LinkVehicle{any_vehicle(vehicle, combinations::compatible<Model>(integrators(o))),
                         watched(o, vehicle, links)};
    };
    out.refusals = combinations::integrator_refusals<Model>(Integrators{});
  } else {
    out.refusals.assign(std::tuple_size_v<Integrators>, refused);
  }
  return out;
}

// Links of type B on pins of each policy. `Usual` is the policy without --policy.
template <class B, class Usual>
std::vector<LinksOnPins> links_of(BodyName const& body, LinksMade<B> const& made = with_section<B>) {
  return std::apply([&](auto const&... p) { return std::vector{on_pins<B, Usual>(body, p, made)...}; }, pin_policies);
}

}  // namespace chapter3
