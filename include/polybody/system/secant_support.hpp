#pragma once
/// \file
/// What bodies, policies and forces must offer a step that conserves energy.

#include <polybody/bodies/shared/discrete_force.hpp>
#include <polybody/math/secant.hpp>
#include <polybody/math/sequence.hpp>
#include <polybody/system/pools.hpp>

namespace polybody {

/// A policy whose force is linear in the gap, so that its mean over a step is that of the mean gap; or one that brings
/// rows.
template <class P>
concept HasMeanMultiplier = ConstrainingPolicy<P> || requires { requires P::linear; };

/// A force element whose potential may be asked on secants.
template <class F>
concept HasSecantPotential =
    requires(F const force, std::array<Frame<Secant<12 * F::markers>>, F::markers> const frames, double t) {
      { force.potential(frames, t) } -> std::convertible_to<Secant<12 * F::markers>>;
    };

namespace detail {

/// A force that stores energy gives it on secants, too; a group of forces is judged by itself.
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
  static constexpr bool bodies = (HasDiscreteForce<Bs> && ...);
  static constexpr bool policies = (HasMeanMultiplier<typename Js::PolicyType> && ...);
  static constexpr bool positions = ((nonholonomic_equations<typename Js::Geometry>() == 0) && ...);
  static constexpr bool elements = !(ForceGroup<Fs> || ...);
  static constexpr bool potentials = (gives_secants<Fs>() && ...);
  static constexpr bool all = bodies && policies && positions && elements && potentials;
};

}  // namespace detail

/// A model that is stepped whole, as no policy eliminates anything.
template <class M>
concept FullStateModel = !M::eliminates;

/// What model M offers a step that conserves energy.
template <class M>
using SecantSupport = detail::SecantSupportOf<typename M::BodyPools, typename M::JointPools, typename M::ForcePools>;

/// What a step that conserves energy asks of a model.
template <class M>
concept HasSecants = FullStateModel<M> && SecantSupport<M>::all;

}  // namespace polybody
