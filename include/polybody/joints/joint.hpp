#pragma once
/// \file
/// Joint: a geometry and a policy, with compile-time checks that they fit each other.

#include <type_traits>
#include <utility>

#include <polybody/joints/policies/penalty.hpp>
#include <polybody/joints/policies/policy.hpp>

namespace polybody::detail {

// Error messages for invalid types of geometries and policies. Each message names the missing member.

template <class P, int m>
concept HasMultiplier = requires(P const p, Vec<double, m> const g) {
  { p.template multiplier<m, double>(g, g) } -> std::convertible_to<Vec<double, m>>;
};
template <class P, int m>
concept HasPolicyTangent = requires(P const p, Vec<double, m> const g) {
  { p.template slope<m>(1.0, 1.0, g, g) } -> std::convertible_to<Mat<double, m, m>>;
};
template <class P, int m>
concept HasPolicyPotential = requires(P const p, Vec<double, m> const g) {
  { p.template potential<m>(g) } -> std::convertible_to<double>;
};

/// Checks the members that the concept `JointGeometry` requires, one by one. In its messages a and b are frames of the
/// scalar type T.
template <class G>
struct GeometryRefusal {
  static_assert(
      requires {
        { G::name } -> std::convertible_to<char const*>;
        { G::world } -> std::convertible_to<World>;
      }, "A joint geometry needs static constants: char const* name and World world.");
  static_assert(
      requires(G const g) {
        { g.triad() } -> std::convertible_to<Mat3>;
      },
      "A joint geometry needs triad() const, which returns a Mat3: the joint's axes at the reference configuration, in "
      "world axes.");
  static_assert(constraint_equations<G>() >= 1 && constraint_equations<G>() <= 6,
                "A joint geometry needs a list of 1 to 6 constraint equations, for example `using Equations = "
                "EquationList<Coincident>`, or its own functions and a static constant `int rows` from 1 to 6.");
  static_assert(
      HasEquationList<G> || requires {
        { G::needs } -> std::convertible_to<MarkerKind>;
      }, "A joint geometry without a list of constraint equations needs the static constant `MarkerKind needs`.");
  static_assert(HasEquationList<G> || HasOwnConstraintFunction<G>,
                "A joint geometry needs constraint_function<T>(a, b, t) const, which returns ConstraintTerms<rows, T>, "
                "or a list of constraint equations.");
  static_assert(HasEquationList<G> || HasOwnGamma<G>,
                "A joint geometry needs gamma<T>(a, b, t) const, which returns Vec<T, rows>: the terms of the second "
                "derivative of its constraint function without accelerations; or a list of constraint equations.");
  static constexpr bool checked = true;
};

/// Checks the members that the concept `Policy` requires, one by one.
template <class P>
struct PolicyRefusal {
  template <int... m>
  static constexpr int members(std::integer_sequence<int, m...>) {
    return ((HasMultiplier<P, m + 1> ? 1 : 0) | ...) | ((HasPolicyTangent<P, m + 1> ? 2 : 0) | ...) |
           ((HasPolicyPotential<P, m + 1> ? 4 : 0) | ...);
  }
  static constexpr int given = members(std::make_integer_sequence<int, 6>{});

  static_assert(!(ConstrainingPolicy<P> && CompliantPolicy<P>),
                "A policy must either add constraint equations (adds_constraints) or replace them by a force "
                "(multiplier), not both.");
  static_assert(
      ConstrainingPolicy<P> || given != 0,
      "A policy needs a static constant adds_constraints = true. A compliant policy, which replaces constraint "
      "equations by a force, needs the members check, multiplier, slope and potential instead.");
  static_assert(ConstrainingPolicy<P> || given == 0 || (given & 1) != 0,
                "A compliant policy needs multiplier<m, T>(g, rate) const, which returns lambda as Vec<T, m>.");
  static_assert(ConstrainingPolicy<P> || given == 0 || (given & 2) != 0,
                "A compliant policy needs slope<m>(ck, cd, g, rate) const, which returns ck d(lambda)/dg + cd "
                "d(lambda)/d(rate) (m x m).");
  static_assert(ConstrainingPolicy<P> || given == 0 || (given & 4) != 0,
                "A compliant policy needs potential<m>(g) const, which returns the energy that it stores.");
  static_assert(
      ConstrainingPolicy<P> || given != 7 || requires(P const p, std::string const what) { p.check(what); },
      "A compliant policy needs check(what) const, which throws InvalidInput for invalid parameters.");
  static constexpr bool checked = true;
};

}  // namespace polybody::detail

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

/// Policy of a joint that is constructed from a geometry alone. The return type is deduced, so that the compiler
/// reports the failed static_assert first.
template <class P>
constexpr auto default_policy() {
  static_assert(std::is_default_constructible_v<P>,
                "The parameters of this policy have no default values. Give them after the geometry: "
                "Joint<Revolute, Penalty>{Revolute{.axis = axis}, {.stiffness = 1e8, .damping = 1e4}}.");
  if constexpr (std::is_default_constructible_v<P>) return P{};
}
}  // namespace detail

/// G declares its free directions, or P does not use free directions. A bushing uses them: its force acts on all other
/// directions.
template <class P, class G>
concept MeasurableGeometry = HasFreeDirections<G> || !requires { typename P::template Measured<G>; };

/// Policy P can enforce geometry G: P adds constraint equations, or its force has one component for each equation.
template <class P, class G>
concept EnforceableGeometry =
    ConstrainingPolicy<P> ||
    (MeasurableGeometry<P, G> &&
     CompliantLaw<P, constraint_equations<typename decltype(detail::measured_by<G, P>())::type>()>);

/// P adds constraint equations, or all equations of G are holonomic, so that a force can act on their violation.
template <class P, class G>
concept HolonomicOrConstrained = ConstrainingPolicy<P> || nonholonomic_equations<G>() == 0;

/// A joint consists of a geometry (the motions that it prevents) and a policy (the enforcement of its constraint
/// equations). `Joint{Revolute{.axis = axis}}` and the type `Joint<Revolute>` have the policy `Constraint`, and
/// `Joint{Revolute{.axis = axis}, Penalty{.stiffness = k, .damping = c}}` has another policy. If a policy has no
/// parameters, `Joint<G, P>{geometry}` needs no second argument.
template <class G, class P = Constraint>
struct Joint {
  static_assert(sizeof(G) > 0);  // first use of G, so that the compiler reports errors in G with a short context
  static_assert(JointGeometry<G> || detail::GeometryRefusal<G>::checked);
  static_assert(Policy<P> || detail::PolicyRefusal<P>::checked);
  using Geometry = G;    ///< motions that the joint prevents
  using PolicyType = P;  ///< enforcement of the constraint equations
  /// Constraint function that the policy uses: G, or `Measured<G>` if P defines it.
  using Measured = typename decltype(detail::measured_by<G, P>())::type;
  static constexpr int rows = constraint_equations<Measured>();
  static_assert(
      !Policy<P> || !MeasurableGeometry<P, G> || EnforceableGeometry<P, G>,
      "The number of parameters of this policy must equal the number of constraint equations of the joint's geometry.");
  static_assert(!Policy<P> || HolonomicOrConstrained<P, G>,
                "This geometry is nonholonomic (it constrains velocities), so a compliant policy has no violation "
                "to act on. Use Constraint.");
  G geometry = {};                         ///< motions that the joint prevents
  P policy = detail::default_policy<P>();  ///< enforcement of the constraint equations

  /// Constraint function that the policy uses: the geometry itself for most policies.
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
