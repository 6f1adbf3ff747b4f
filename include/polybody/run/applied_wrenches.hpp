#pragma once
/// \file
/// Wrenches of force elements in a state, contact points of contact groups, and powers of force elements and drives.
/// Theory: Eq. 3.1.

#include <algorithm>
#include <array>
#include <functional>
#include <vector>

#include <polybody/run/observe.hpp>
#include <polybody/system/lookup.hpp>
#include <polybody/system/system.hpp>

namespace polybody {

namespace detail {

/// Calls visit(k, action) for each wrench of force element `force`, with the index k of its marker.
template <class Visit>
void for_each_action_of(System const& system, Index force, Visit&& visit) {
  std::size_t k = 0;
  for (AppliedWrench<double> const& action : system.data().actions)
    if (action.source == force) visit(k++, action);
}

template <class = void>
double power_of_force(System const& system, Index force) {
  double sum = 0.0;
  for_each_action_of(system, force, [&](std::size_t, AppliedWrench<double> const& action) {
    Frame<double> const& f = system.data().markers[std::size_t(action.marker)].frame;
    for (int i = 0; i < 3; ++i) sum += action.w[i] * f.v[i] + action.w[3 + i] * f.w[i];
  });
  return sum;
}

template <class = void>
double power_of_joint(System const& system, State const& x, Index joint) {
  ConstraintBlock<double> const& block = rows_of(system, joint);
  double const* const lambda = block.multiplier(x.lambda);
  double sum = 0.0;
  for (int i = 0; block.rate && i < block.rows; ++i) sum += lambda[i] * block.rate[i];
  return sum;
}

}  // namespace detail

/// Forces [N] and moments [N m] of a force element on its markers, in the order of the markers: each about the origin
/// of its marker, world axes. For a group of forces, the result is a vector; each entry is the sum over all pairs of
/// its marker. `system` must have been evaluated at the state, and `System::push_forces` called afterwards.
/// \throws InvalidInput for a handle of another model.
template <class F>
auto applied_wrenches(System const& system, ElementHandle<F> const& force) {
  auto const index = index_of_force(system.layout(), force);
  auto const at = [](auto& out, std::size_t k, AppliedWrench<double> const& action) {
    out[k] = {Vec3(action.w[0], action.w[1], action.w[2]), Vec3(action.w[3], action.w[4], action.w[5])};
  };
  if constexpr (ForceElement<F>) {
    std::array<Wrench<double>, F::markers> out;
    detail::for_each_action_of(system, index, [&](std::size_t k, auto const& action) { at(out, k, action); });
    return out;
  } else {
    std::vector<Wrench<double>> out(system.layout().forces[std::size_t(index)].markers.size());
    detail::for_each_action_of(system, index, [&](std::size_t k, auto const& action) { at(out, k, action); });
    return out;
  }
}

/// Power of a force element on the bodies [W], Σ (f·v + m·ω) over its markers: positive if the element adds energy to
/// the bodies. `system` must have been evaluated at x, and `System::push_forces` called afterwards. \throws
/// InvalidInput for a handle of another model.
template <class F>
  requires(!requires { typename F::Geometry; })
double power(System const& system, State const&, ElementHandle<F> const& force) {
  return detail::power_of_force(system, index_of_force(system.layout(), force));
}
/// Power of a driving constraint on the bodies [W], λᵀΦ_t: the multipliers times the prescribed rates, positive if the
/// drive adds energy. For a prescribed angle ψ(t), ġ = θ̇ − ψ̇, and the power is the driving moment −λ times ψ̇. The
/// power is zero for joints without a function of time. In a compliant joint, λ(g, ġ) replaces the multipliers.
/// `system` must have been evaluated at x. The multipliers of x must belong to the time x.t (see `EnergyAudit`).
/// \throws InvalidInput for a handle of another model.
template <class J>
  requires requires { typename J::Geometry; }
double power(System const& system, State const& x, ElementHandle<J> const& joint) {
  return detail::power_of_joint(system, x, index_of_joint(system.layout(), joint));
}

/// Contact point in a state.
struct TouchingPoint {
  Index body;  ///< number of the body's marker among the `many()` markers of a group or the members of a set; 0 for one
               ///< contact
  std::string const*
      against;   ///< name of the partner or the second member in the contact; for one contact, its own name
  Vec3 place;    ///< (3) position, world axes [m]
  Vec3 normal;   ///< (3) unit vector towards the body
  double depth;  ///< penetration [m]
  Vec3 force;    ///< (3) contact force on the body [N]
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

/// Calls visit(TouchingPoint) for each contact point of a contact group, or of one contact, whose normal force is
/// positive. `system` must have been evaluated at the state.
/// \throws InvalidInput for a handle of another model.
template <class F>
void for_each_contact(System const& system, ElementHandle<F> const& group, TouchingPointVisit const& visit) {
  ForceLayout const& place = system.layout().forces[std::size_t(index_of_force(system.layout(), group))];
  F const& contact = *static_cast<F const*>(place.force);
  auto const frame = [&](Index k) -> Frame<double> const& {
    return system.data().markers[std::size_t(place.markers[std::size_t(k)])].frame;
  };
  if constexpr (ForceElement<F>) {
    if (!contact.may_touch(frame(0), frame(1))) return;
    if constexpr (HasStates<F>) {
      std::array<double, F::states> z;
      std::copy_n(system.data().states.begin() + (place.v0 - system.data().first_state), z.size(), z.begin());
      auto const at_point = [&](auto const& p, Vec3 const& force, double n) {
        if (n > 0.0) visit({0, &place.name, p.place, p.normal, p.depth, force});
      };
      contact.template for_each_touching<double>({frame(0), frame(1)}, z, at_point);
    } else {
      detail::visit_touching(contact, {frame(0), frame(1)}, 0, place.name, visit);
    }
  } else if constexpr (SearchingForceGroup<F>) {
    contact.for_each_pair(frame, [&](Index i, Index j, auto const& law) {
      detail::visit_touching(law, {frame(i), frame(j)}, i, contact.name_of(j), visit);
    });
  } else {
    for (Index body = 0; body < contact.many(); ++body)
      contact.for_each_partner([&](auto const& few) {
        if (few.law.may_touch(frame(body), frame(few.marker)))
          detail::visit_touching(few.law, {frame(body), frame(few.marker)}, body, few.name, visit);
      });
  }
}

}  // namespace polybody
