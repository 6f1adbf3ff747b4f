#pragma once
/// \file
/// Joint: a geometry and a policy, with compile-time checks that they fit each other.

#include <type_traits>

#include <polybody/joints/joint_refusals.hpp>
#include <polybody/joints/policies/constraint.hpp>
#include <polybody/joints/policies/penalty.hpp>

namespace polybody {

namespace detail {
/// Constraint function that policy P uses for geometry G: G itself, unless P defines `Measured<G>`.
template <class G, class P>
constexpr auto measured_by() {
  if constexpr (requires { typename P::template Measured<G>; })
    return std::type_identity<typename P::template Measured<G>>{};
  else
    return std::type_identity<G>{};
}

/// Policy of a joint that is constructed from a geometry alone. The deduced type makes the refusal the first error.
template <class P>
constexpr auto default_policy() {
  static_assert(std::is_default_constructible_v<P>,
                "The parameters of this policy have no default values. Give them after the geometry: "
                "Joint<Revolute, Penalty>{Revolute{}, {.stiffness = 1e8, .damping = 1e4}}.");
  if constexpr (std::is_default_constructible_v<P>) return P{};
}
}  // namespace detail

/// G declares its free directions if P needs them: a bushing acts on all other directions.
template <class P, class G>
concept MeasurableGeometry = HasFreeDirections<G> || !requires { typename P::template Measured<G>; };

/// P adds constraint equations, or its force has one component for each equation of its constraint function for G.
template <class P, class G>
concept EnforceableGeometry =
    ConstrainingPolicy<P> ||
    (MeasurableGeometry<P, G> && CompliantLaw<P, decltype(detail::measured_by<G, P>())::type::rows>);

/// P adds constraint equations, or all equations of G are holonomic, so that a force can act on their violation.
template <class P, class G>
concept HolonomicOrConstrained = ConstrainingPolicy<P> || nonholonomic_equations<G>() == 0;

/// A joint consists of a geometry (the motions that it prevents) and a policy (the enforcement of its constraint
/// equations). `Joint{Revolute{.axis = axis}}` and the type `Joint<Revolute>` have the policy `Constraint`, and
/// `Joint{Revolute{.axis = axis}, Penalty{.stiffness = k, .damping = c}}` has another policy. If a policy has no
/// parameters, `Joint<G, P>{geometry}` needs no second argument.
template <class G, class P = Constraint>
struct Joint {
  static_assert(sizeof(G) > 0);  // the first use of G, so that its own refusals have a short context
  static_assert(JointGeometry<G> || detail::GeometryRefusal<G>::checked);
  static_assert(Policy<P> || detail::PolicyRefusal<P>::checked);
  using Geometry = G;    ///< motions that the joint prevents
  using PolicyType = P;  ///< enforcement of the constraint equations
  /// Constraint function of the policy: G, or `Measured<G>` of P.
  using Measured = typename decltype(detail::measured_by<G, P>())::type;
  static constexpr int rows = Measured::rows;
  static_assert(
      !Policy<P> || !MeasurableGeometry<P, G> || EnforceableGeometry<P, G>,
      "The number of parameters of this policy must equal the number of constraint equations of the joint's geometry.");
  static_assert(!Policy<P> || HolonomicOrConstrained<P, G>,
                "This geometry is nonholonomic (it constrains velocities), so that a compliant policy has no violation "
                "to act on. Use Constraint.");
  G geometry = {};                         ///< motions that the joint prevents
  P policy = detail::default_policy<P>();  ///< enforcement of the constraint equations

  /// Constraint function of the policy: the geometry itself for most policies.
  decltype(auto) measure() const {
    if constexpr (std::is_same_v<Measured, G>)
      return (geometry);
    else
      return Measured{};
  }
};

/// Type of `Joint{geometry}`.
template <class G>
Joint(G) -> Joint<G, Constraint>;
/// Type of `Joint{geometry, policy}`.
template <class G, class P>
Joint(G, P) -> Joint<G, P>;

}  // namespace polybody
