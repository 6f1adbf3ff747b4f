#pragma once
/// \file
/// Evaluation of points that slide along a body (bodies/shared/with_sliders.hpp).

#include <polybody/bodies/shared/with_sliders.hpp>
#include <polybody/kinematics/marker.hpp>
#include <polybody/run/run_options.hpp>

namespace polybody {

namespace detail {
/// Terminal event at which coordinate i reaches 0 or `length` [m].
inline Event slider_end_event(std::string const& name, Slider slider, Index i, double length) {
  return {.name = sentence_of({"slider ", slider.index, " of \"", name, "\" reaches an end"}),
          .value = [i, length](State const& x) { return std::min(x.q[i], length - x.q[i]); },
          .terminal = true};
}
}  // namespace detail

/// Position of a slider: arc length along the axis of its body [m]. \throws InvalidInput for a slider that the body
/// does not have.
template <class M, class B>
double slider_position(M const& model, State const& x, BodyHandle<WithSliders<B>> const& handle, Slider slider = {}) {
  auto const& e = model.entry(handle);
  return x.q[e.q0 + e.body.column_of(slider)];
}

/// Terminal event at which a slider reaches an end of its body. \throws InvalidInput for a slider that the body does
/// not have.
template <class M, class B>
Event slider_end_event(M const& model, BodyHandle<WithSliders<B>> const& handle, Slider slider = {}) {
  auto const& e = model.entry(handle);
  return detail::slider_end_event(e.name, slider, e.q0 + e.body.column_of(slider), e.body.length());
}

}  // namespace polybody
