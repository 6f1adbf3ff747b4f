#pragma once
/// \file
/// Where the bodies of a contact group touch, and how hard.

#include <functional>

#include <polybody/system/lookup.hpp>
#include <polybody/system/system.hpp>

namespace polybody {

/// A point of contact as it is in a state.
struct TouchingPoint {
  Index body;                  ///< among the group's many, from 0
  std::string const* against;  ///< name of the one of the few
  Vec3 place;                  ///< (3) world axes [m]
  Vec3 normal;                 ///< (3) unit vector to the body
  double depth;                ///< [m]
  Vec3 force;                  ///< (3) on the body [N]
};

using TouchingPointVisit = std::function<void(TouchingPoint const&)>;  ///< what is called for each point in contact

namespace detail {
/// The points of one pair that press.
template <class Law>
void visit_touching(Law const& law, std::array<Frame<double>, 2> const& frames, Index body, std::string const& against,
                    TouchingPointVisit const& visit) {
  law.template for_each_point<double>(frames, [&](auto const& p, Vec3 const& v, double n) {
    if (n > 0.0) visit({body, &against, p.place, p.normal, p.depth, law.force_at(p, v, n)});
  });
}
}  // namespace detail

/// Calls visit(TouchingPoint) for every point of a contact group that presses; `system` must have been evaluated at the
/// state.
/// \throws InvalidInput for a handle of another model.
template <class F>
void for_each_contact(System const& system, ElementHandle<F> const& group, TouchingPointVisit const& visit) {
  ForceLayout const& place = system.layout().forces[std::size_t(index_of_force(system.layout(), group))];
  F const& contact = *static_cast<F const*>(place.force);
  auto const frame = [&](Index k) -> Frame<double> const& {
    return system.data().markers[std::size_t(place.markers[std::size_t(k)])].frame;
  };
  for (Index body = 0; body < contact.many(); ++body)
    contact.for_each_opponent([&](auto const& few) {
      if (few.law.may_touch(frame(body), frame(few.marker)))
        detail::visit_touching(few.law, {frame(body), frame(few.marker)}, body, few.name, visit);
    });
}

}  // namespace polybody
