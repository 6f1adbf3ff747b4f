#pragma once
/// \file
/// Query of a contact group in a state: contact points and contact forces.

#include <functional>

#include <polybody/system/lookup.hpp>
#include <polybody/system/system.hpp>

namespace polybody {

/// Contact point in a state.
struct TouchingPoint {
  Index body;                  ///< index of the body's marker among the `many()` markers of the group
  std::string const* against;  ///< name of the partner in the contact
  Vec3 place;                  ///< (3) position, world axes [m]
  Vec3 normal;                 ///< (3) unit vector towards the body
  double depth;                ///< penetration [m]
  Vec3 force;                  ///< (3) contact force on the body [N]
};

using TouchingPointVisit = std::function<void(TouchingPoint const&)>;  ///< called for each contact point

namespace detail {
/// Calls `visit` for each contact point of one pair whose normal force is positive.
template <class Law>
void visit_touching(Law const& law, std::array<Frame<double>, 2> const& frames, Index body, std::string const& against,
                    TouchingPointVisit const& visit) {
  law.template for_each_point<double>(frames, [&](auto const& p, Vec3 const& v, double n) {
    if (n > 0.0) visit({body, &against, p.place, p.normal, p.depth, law.force_at(p, v, n)});
  });
}
}  // namespace detail

/// Calls visit(TouchingPoint) for each contact point of a contact group whose normal force is positive. `system` must
/// have been evaluated at the state.
/// \throws InvalidInput for a handle of another model.
template <class F>
void for_each_contact(System const& system, ElementHandle<F> const& group, TouchingPointVisit const& visit) {
  ForceLayout const& place = system.layout().forces[std::size_t(index_of_force(system.layout(), group))];
  F const& contact = *static_cast<F const*>(place.force);
  auto const frame = [&](Index k) -> Frame<double> const& {
    return system.data().markers[std::size_t(place.markers[std::size_t(k)])].frame;
  };
  for (Index body = 0; body < contact.many(); ++body)
    contact.for_each_partner([&](auto const& few) {
      if (few.law.may_touch(frame(body), frame(few.marker)))
        detail::visit_touching(few.law, {frame(body), frame(few.marker)}, body, few.name, visit);
    });
}

}  // namespace polybody
