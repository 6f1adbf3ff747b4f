#pragma once
/// \file
/// Questions about points that slide along a body (bodies/shared/sliding.hpp).

#include <polybody/bodies/shared/sliding.hpp>
#include <polybody/run/simulate.hpp>

namespace polybody {

/// Where a slider is along the axis of its body [m]. \throws InvalidInput for one that the body has not.
template <class M, class B>
double place(M const& model, State const& x, BodyHandle<Sliding<B>> const& handle, Slider slider = {}) {
  auto const& e = model.entry(handle);
  return x.q[e.q0 + e.body.column_of(slider)];
}

/// The event that a slider reaches an end of its body; it stops the run. \throws InvalidInput as above.
template <class M, class B>
Event reaches_an_end(M const& model, BodyHandle<Sliding<B>> const& handle, Slider slider = {}) {
  auto const& e = model.entry(handle);
  Index const i = e.q0 + e.body.column_of(slider);
  double const length = e.body.length();
  return {.name = "slider " + std::to_string(slider.index) + " of \"" + e.name + "\" reaches an end",
          .value = [i, length](State const& x) { return std::min(x.q[i], length - x.q[i]); },
          .stops = true};
}

}  // namespace polybody
