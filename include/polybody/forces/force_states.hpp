#pragma once
/// \file
/// Force elements with first-order states of their own, ż = h(frames, z, t): what they give, and its gradient.

#include <polybody/forces/force_element.hpp>

namespace polybody {

/// A force element at given states: one without any, for all that asks for its wrenches alone.
template <HasStates F, StateScalar T>
struct AtStates {
  static constexpr int markers = F::markers;
  static constexpr bool is_load = F::is_load;
  static constexpr Observes needs = F::needs;

  F const& force;                     ///< the element, which must outlive this
  std::array<T, F::states> const& z;  ///< its states, which must outlive this

  void check(std::string const&) const {}
  template <StateScalar U>
  std::array<Wrench<U>, F::markers> wrenches(std::array<Frame<U>, F::markers> const& frames, double t) const {
    return force.template wrenches<U>(frames, z, t);
  }
};

/// What derivatives with respect to poses, twists and states are multiplied by.
struct SlopeFactors {
  double pose, twist, states;  ///< factors of the derivatives by poses, twists and states; zero leaves them out
};

/// Gradients of wrenches and rates, in this order, with respect to the frames and the states, (6N + S)×(6N + S).
template <HasStates F>
Mat<double, 6 * F::markers + F::states, 6 * F::markers + F::states> gradient_with_states(
    F const& force, std::array<Frame<double>, F::markers> const& frames, std::array<double, F::states> const& z,
    double t, SlopeFactors const& factors) {
  constexpr int first = 6 * F::markers, n = first + F::states;
  auto const moved = detail::seeded_frames<n>(frames, factors.pose, factors.twist);
  std::array<Dual<n>, F::states> states;
  for (std::size_t s = 0; s < states.size(); ++s) states[s] = detail::seeded<n>(z[s], first + int(s), factors.states);
  Mat<double, n, n> gradient;
  detail::copy_slopes(force.template wrenches<Dual<n>>(moved, states, t), gradient);
  std::array<Dual<n>, F::states> const rates = force.template rates<Dual<n>>(moved, states, t);
  for (int s = 0; s < F::states; ++s)
    for (int j = 0; j < n; ++j) gradient(first + s, j) = rates[std::size_t(s)].d[j];
  return gradient;
}

}  // namespace polybody
