#pragma once
#include <type_traits>

#include <polybody/joints/policies/constraint.hpp>
#include <polybody/joints/policies/penalty.hpp>

namespace polybody {

namespace detail {
/// What policy P measures of geometry G: its rows, unless P names something else.
template <class G, class P>
constexpr auto measured_by() {
  if constexpr (requires { typename P::template Measured<G>; })
    return std::type_identity<typename P::template Measured<G>>{};
  else
    return std::type_identity<G>{};
}
}  // namespace detail

/// A joint is a geometry (which motions it stops) and a policy (how it stops them).
template <JointGeometry G, Policy P>
struct Joint {
  using Geometry = G;
  using PolicyType = P;
  using Measured = typename decltype(detail::measured_by<G, P>())::type;
  static constexpr int rows = Measured::rows;
  static_assert(AddsRows<P> || AnswersRows<P, rows>,
                "This policy has numbers for another number of rows than the joint's geometry has.");
  static_assert(AddsRows<P> || velocity_rows<G>() == 0,
                "This geometry holds speeds, not positions (it rolls, or glides on a blade): there is no gap that a force could "
                "answer. Use Constraint.");
  G geometry = {};
  P policy = {};

  /// What gives the gap that the policy answers: the geometry itself for most.
  decltype(auto) measure() const {
    if constexpr (std::is_same_v<Measured, G>)
      return (geometry);
    else
      return Measured{};
  }
};

}  // namespace polybody
