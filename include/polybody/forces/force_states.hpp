#pragma once
/// \file
/// Force elements with first-order states, ż = h(frames, z, t): wrenches, rates and their tangent.

#include <polybody/forces/force_element.hpp>

namespace polybody {

/// Adapter of a force element with states: an element without states, which provides the wrenches at constant z.
template <HasStates F, StateScalar T>
struct AtStates {
  static constexpr int markers = F::markers;
  static constexpr bool is_load = F::is_load;
  static constexpr MarkerKind needs = F::needs;

  F const& force;                     ///< element, which must outlive this object
  std::array<T, F::states> const& z;  ///< states, which must outlive this object

  void check(std::string const&) const {}
  template <StateScalar U>
  std::array<Wrench<U>, F::markers> wrenches(std::array<Frame<U>, F::markers> const& frames, double t) const {
    return force.template wrenches<U>(frames, z, t);
  }
  double potential(std::array<Frame<double>, F::markers> const& frames, double t) const
    requires(HasStatePotential<F> && std::same_as<T, double>)
  {
    return force.potential(frames, z, t);
  }
  double dissipation(std::array<Frame<double>, F::markers> const& frames, double t) const
    requires(HasStatePotential<F> && std::same_as<T, double>)
  {
    return force.dissipation(frames, z, t);
  }
};

/// Factors of the derivatives with respect to poses, twists and states.
struct TangentFactors {
  double pose, twist, states;  ///< factor of each derivative; zero omits the derivative
};

/// Tangent of wrenches and rates, in this order, with respect to the frames and the states: (6N + S)×(6N + S) for N
/// markers and S states.
template <HasStates F>
Mat<double, 6 * F::markers + F::states, 6 * F::markers + F::states> gradient_with_states(
    F const& force, std::array<Frame<double>, F::markers> const& frames, std::array<double, F::states> const& z,
    double t, TangentFactors const& factors) {
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
