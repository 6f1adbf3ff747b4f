#pragma once
/// \file
/// Error messages for types that are not a geometry or not a policy; each names the missing member.

#include <utility>

#include <polybody/joints/policies/policy.hpp>

namespace polybody::detail {

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

/// Checks the members that the concept `JointGeometry` requires, one by one; a and b are frames of a scalar T.
template <class G>
struct GeometryRefusal {
  static_assert(
      requires {
        { G::name } -> std::convertible_to<char const*>;
        { G::needs } -> std::convertible_to<MarkerKind>;
        { G::world } -> std::convertible_to<World>;
      }, "A joint geometry needs static constants: char const* name, MarkerKind needs and World world.");
  static_assert(
      requires { requires 1 <= G::rows&& G::rows <= 6; },
      "A joint geometry needs a static constant: int rows, from 1 to 6.");
  static_assert(
      requires(G const g) {
        { g.triad() } -> std::convertible_to<Mat3>;
      },
      "A joint geometry needs triad() const, which returns a Mat3: the joint's axes at the reference configuration, in "
      "world axes.");
  static_assert(
      requires(G const g, Frame<double> const a, double t) {
        { g.template constraint_function<double>(a, a, t) } -> std::same_as<ConstraintTerms<G::rows, double>>;
      }, "A joint geometry needs constraint_function<T>(a, b, t) const, which returns ConstraintTerms<rows, T>.");
  static_assert(
      requires(G const g, Frame<double> const a, double t) {
        { g.template gamma<double>(a, a, t) } -> std::same_as<Vec<double, G::rows>>;
      },
      "A joint geometry needs gamma<T>(a, b, t) const, which returns Vec<T, rows>: the terms of the second derivative "
      "of its constraint function without accelerations.");
  static constexpr bool checked = true;
};

/// Instantiated for a type that is not a `Policy`.
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
  static_assert(ConstrainingPolicy<P> || given != 0,
                "A policy needs a static constant adds_constraints = true; or, if it replaces constraint equations by "
                "a force, check, multiplier, slope and potential.");
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
