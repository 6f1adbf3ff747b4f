#pragma once
/// \file
/// Force elements that depend on the multipliers of a joint, such as friction that follows the load of a bearing.
/// Theory: Eqs. 9.43, 9.44.

#include <polybody/forces/force_states.hpp>

namespace polybody {

/// Force element between the markers of a joint that depends on `multipliers` multipliers λ of that joint. It has the
/// functions of other elements with the additional argument λ (m) after the frames, and with states z, which may be
/// empty. The functions without λ are those of the unloaded joint. `follow(joint, axis)` sets the joint.
template <class F>
concept FollowsReaction = ForceElement<F> && requires { requires F::multipliers > 0; };

/// Adapter of an element that follows a reaction: an element for constant multipliers λ of type T.
template <FollowsReaction F, StateScalar T>
struct AtMultipliers {
  static constexpr int markers = F::markers, states = states_of<F>();  ///< those of F
  static constexpr bool is_load = F::is_load;
  static constexpr MarkerKind needs = F::needs;
  static constexpr MarkerKind needs_of_second = polybody::needs_of_second<F>();

  F const& force;                        ///< element, which must outlive this object
  Vec<T, F::multipliers> const& lambda;  ///< (m) multipliers, which must outlive this object

  void check(std::string const&) const {}
  template <StateScalar U>
  std::array<Wrench<U>, F::markers> wrenches(std::array<Frame<U>, F::markers> const& frames, double t) const
    requires(states == 0)
  {
    return force.template wrenches<U>(frames, converted<U>(), std::array<U, 0>{}, t);
  }
  template <StateScalar U>
  std::array<Wrench<U>, F::markers> wrenches(std::array<Frame<U>, F::markers> const& frames,
                                             std::array<U, std::size_t(states)> const& z, double t) const
    requires(states > 0)
  {
    return force.template wrenches<U>(frames, converted<U>(), z, t);
  }
  template <StateScalar U>
  std::array<U, std::size_t(states)> rates(std::array<Frame<U>, F::markers> const& frames,
                                           std::array<U, std::size_t(states)> const& z, double t) const
    requires(states > 0)
  {
    return force.template rates<U>(frames, converted<U>(), z, t);
  }
  double potential(std::array<Frame<double>, F::markers> const& frames, double t) const
    requires HasPotential<F>
  {
    return force.potential(frames, t);
  }
  double potential(std::array<Frame<double>, F::markers> const& frames,
                   std::array<double, std::size_t(states)> const& z, double t) const
    requires HasStatePotential<F>
  {
    return force.potential(frames, z, t);
  }
  double dissipation(std::array<Frame<double>, F::markers> const& frames,
                     std::array<double, std::size_t(states)> const& z, double t) const
    requires(HasStatePotential<F> && std::same_as<T, double>)
  {
    return force.dissipation(frames, lambda, z, t);
  }

 private:
  template <StateScalar U>
  Vec<U, F::multipliers> converted() const {
    Vec<U, F::multipliers> out;
    for (int i = 0; i < F::multipliers; ++i) out[i] = U(lambda[i]);
    return out;
  }
};

}  // namespace polybody
