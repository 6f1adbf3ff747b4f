#pragma once
/// \file
/// Questions about points that slide along a body (bodies/shared/sliding.hpp).

#include <polybody/bodies/shared/sliding.hpp>
#include <polybody/kinematics/marker.hpp>
#include <polybody/run/event.hpp>

namespace polybody {

namespace detail {
/// The event that coordinate i reaches 0 or `length`; it stops the run.
inline Event reaches_an_end(std::string const& name, Slider slider, Index i, double length) {
  return {.name = sentence_of({"slider ", slider.index, " of \"", name, "\" reaches an end"}),
          .value = [i, length](State const& x) { return std::min(x.q[i], length - x.q[i]); },
          .stops = true};
}
}  // namespace detail

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
  return detail::reaches_an_end(e.name, slider, e.q0 + e.body.column_of(slider), e.body.length());
}

}  // namespace polybody
