#pragma once
/// \file
/// Lengths, strains and tensions of a belt's spans in a state.
/// Theory: Eqs. 3.16, 3.19.

#include <algorithm>

#include <polybody/forces/belt.hpp>
#include <polybody/run/state_checks.hpp>
#include <polybody/system/lookup.hpp>
#include <polybody/system/make_operations.hpp>
#include <polybody/system/system.hpp>

namespace polybody {

/// Spans of a belt in state x. `system` must have been evaluated at x. \throws InvalidInput for a handle of another
/// model.
template <int N>
std::array<BeltSpan, N> belt_spans(System const& system, State const& x, ElementHandle<BeltAndPulley<N>> const& belt) {
  ForceLayout const& place = system.layout().forces[std::size_t(index_of_force(system.layout(), belt))];
  std::array<Frame<double>, N> frames;
  std::array<double, N> z;
  for (std::size_t k = 0; k < N; ++k) frames[k] = system.data().markers[std::size_t(place.markers[k])].frame;
  std::copy_n(x.v.data() + place.v0, N, z.begin());
  return static_cast<BeltAndPulley<N> const*>(place.force)->spans(frames, z);
}
/// Spans of a belt in state x of a model. \throws InvalidInput for a handle of another model, or a state that does not
/// fit the model.
template <class M, int N>
std::array<BeltSpan, N> belt_spans(M const& model, State const& x, ElementHandle<BeltAndPulley<N>> const& belt) {
  System system(model);
  require_usable(system, x);
  system.evaluate(x.q, x.v, x.t);
  return belt_spans(system, x, belt);
}

}  // namespace polybody
