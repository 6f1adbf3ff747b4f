#pragma once
#include <type_traits>

#include <polybody/joints/joint_refusals.hpp>
#include <polybody/joints/policies/constraint.hpp>
#include <polybody/joints/policies/penalty.hpp>

namespace polybody {

namespace detail {
/// The measure that policy P takes of geometry G: its rows, unless P names another one.
template <class G, class P>
constexpr auto measured_by() {
  if constexpr (requires { typename P::template Measured<G>; })
    return std::type_identity<typename P::template Measured<G>>{};
  else
    return std::type_identity<G>{};
}
}  // namespace detail

/// G has what P measures: a bushing measures the directions that G does not name as free.
template <class P, class G>
concept MeasurableGeometry = HasFreeDirections<G> || !requires { typename P::template Measured<G>; };

/// P adds rows, or answers as many components by a force as it measures of G.
template <class P, class G>
concept EnforceableGeometry =
    ConstrainingPolicy<P> ||
    (MeasurableGeometry<P, G> && CompliantLaw<P, decltype(detail::measured_by<G, P>())::type::rows>);

/// P adds rows, or G has a gap in each of its rows, which a force can answer.
template <class P, class G>
concept HolonomicOrConstrained = ConstrainingPolicy<P> || nonholonomic_equations<G>() == 0;

/// A joint is a geometry (which motions it stops) and a policy (how it stops them). `Joint{Revolute{.axis = axis}}` has
/// the policy `Constraint`, and `Joint{Revolute{.axis = axis}, Penalty{.stiffness = k, .damping = c}}` names another
/// one. If a policy has no numbers, `Joint<G, P>{geometry}` needs no policy.
template <class G, class P>
struct Joint {
  static_assert(JointGeometry<G> || detail::GeometryRefusal<G>::asked);
  static_assert(Policy<P> || detail::PolicyRefusal<P>::asked);
  using Geometry = G;    ///< which motions are stopped
  using PolicyType = P;  ///< how they are stopped
  /// What the policy answers: G, or what P measures in its place.
  using Measured = typename decltype(detail::measured_by<G, P>())::type;
  static constexpr int rows = Measured::rows;
  static_assert(
      !Policy<P> || !MeasurableGeometry<P, G> || EnforceableGeometry<P, G>,
      "The number of parameters of this policy must equal the number of constraint equations of the joint's geometry.");
  static_assert(!Policy<P> || HolonomicOrConstrained<P, G>,
                "This geometry is nonholonomic (it constrains velocities), so that a compliant policy has no violation "
                "to act on. Use Constraint.");
  G geometry = {};  ///< which motions are stopped
  P policy = {};    ///< how they are stopped

  /// The measure whose gap the policy answers: the geometry itself for most policies.
  decltype(auto) measure() const {
    if constexpr (std::is_same_v<Measured, G>)
      return (geometry);
    else
      return Measured{};
  }
};

template <class G>
Joint(G) -> Joint<G, Constraint>;
template <class G, class P>
Joint(G, P) -> Joint<G, P>;

}  // namespace polybody
