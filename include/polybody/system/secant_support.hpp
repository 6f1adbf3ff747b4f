#pragma once
/// \file
/// Requirements of energy-conserving integration on bodies, policies and forces.

#include <polybody/bodies/shared/frame_secants.hpp>
#include <polybody/forces/reaction_force.hpp>
#include <polybody/math/secant.hpp>
#include <polybody/math/sequence.hpp>
#include <polybody/system/pools.hpp>

namespace polybody {

/// Policy with constraint equations, or with a force that is linear in the constraint violation. The mean of a linear
/// force over a step is the force at the mean violation.
template <class P>
concept HasMeanMultiplier = ConstrainingPolicy<P> || requires { requires P::linear; };

/// Force element with a potential that can be evaluated with secants.
template <class F>
concept HasSecantPotential =
    requires(F const force, std::array<Frame<Secant<12 * F::markers>>, F::markers> const frames, double t) {
      { force.potential(frames, t) } -> std::convertible_to<Secant<12 * F::markers>>;
    };

namespace detail {

/// True if a force element has no potential, or a potential that can be evaluated with secants.
/// `SecantSupportOf::elements` excludes force groups.
template <class F>
constexpr bool gives_secants() {
  if constexpr (ForceGroup<F>)
    return true;
  else
    return HasSecantPotential<F> || !HasPotential<F>;
}

template <class BodyPools, class JointPools, class ForcePools>
struct SecantSupportOf;
template <class... Bs, class... Js, class... Fs>
struct SecantSupportOf<std::tuple<BodyPool<Bs>...>, std::tuple<Sequence<JointEntry<Js>>...>,
                       std::tuple<Sequence<ForceEntry<Fs>>...>> {
  static constexpr bool bodies = ((HasDiscreteForce<Bs> || HasFrameSteps<Bs>) && ...);
  static constexpr bool policies = (HasMeanMultiplier<typename Js::PolicyType> && ...);
  static constexpr bool positions = ((nonholonomic_equations<typename Js::Geometry>() == 0) && ...);
  static constexpr bool elements = !(ForceGroup<Fs> || ...);
  static constexpr bool reactions = !(FollowsReaction<Fs> || ...);
  static constexpr bool potentials = (gives_secants<Fs>() && ...);
  static constexpr bool all = bodies && policies && positions && elements && reactions && potentials;
};

}  // namespace detail

/// Model without policies that eliminate unknowns. Its time steps use the full state.
template <class M>
concept FullStateModel = !M::eliminates;

/// Support for energy-conserving integration in the bodies, joints and forces of model M.
template <class M>
using SecantSupport = detail::SecantSupportOf<typename M::BodyPools, typename M::JointPools, typename M::ForcePools>;

/// Model that supports energy-conserving integration.
template <class M>
concept HasSecants = FullStateModel<M> && SecantSupport<M>::all;

}  // namespace polybody
