#pragma once
/// \file
/// Wrenches of a force element as one vector, and their derivatives by differences.

#include <algorithm>
#include <array>

#include <polybody/forces/force_states.hpp>
#include <polybody/testing/differences.hpp>

namespace polybody::laws {

/// Wrenches of a force element, [f; m] for each marker.
template <ForceElement F>
VecX stacked_wrenches(F const& force, std::array<Frame<double>, F::markers> const& frames, double t) {
  VecX all(6 * F::markers);
  auto const w = force.template wrenches<double>(frames, t);
  for (std::size_t k = 0; k < w.size(); ++k) all.segment<6>(Index(6 * k)) << w[k].f, w[k].m;
  return all;
}

/// Wrenches of a force element at its first-order states z, followed by the rates of these states.
template <HasStates F>
VecX stacked_answer(F const& force, std::array<Frame<double>, F::markers> const& frames,
                    std::array<double, F::states> const& z, double t) {
  VecX all(6 * F::markers + F::states);
  all.head(6 * F::markers) = stacked_wrenches(AtStates<F, double>{force, z}, frames, t);
  auto const rates = force.template rates<double>(frames, z, t);
  std::copy(rates.begin(), rates.end(), all.data() + 6 * F::markers);
  return all;
}

/// Frames after a displacement by ck h in direction j of the stacked poses (6 per frame), and after a change of the
/// twist by cd h in the same direction.
template <std::size_t markers>
std::array<Frame<double>, markers> shifted(std::array<Frame<double>, markers> frames, Index j, double ck, double cd,
                                           double h) {
  Frame<double>& f = frames[std::size_t(j / 6)];
  Vec6 const unit = Vec6::Unit(j % 6);
  f = moved<double>(f, unit * (ck * h));
  f.v += unit.head<3>() * (cd * h);
  f.w += unit.tail<3>() * (cd * h);
  return frames;
}

/// Derivative ck ∂w/∂pose + cd ∂w/∂twist of the wrenches w by differences: reference for `wrench_gradient`.
template <ForceElement F>
MatX gradient_by_differences(F const& force, std::array<Frame<double>, F::markers> const& frames, double t, double ck,
                             double cd) {
  MatX gradient(6 * F::markers, 6 * F::markers);
  double const step = 1e-3 / std::max({1.0, ck, cd});
  for (Index j = 0; j < gradient.cols(); ++j)
    gradient.col(j) =
        slope_at_zero([&](double h) { return stacked_wrenches(force, shifted(frames, j, ck, cd, h), t); }, step);
  return gradient;
}
/// Derivative of the wrenches and state rates by differences, with the factors `by`: reference for
/// `gradient_with_states`.
template <HasStates F>
MatX gradient_by_differences(F const& force, std::array<Frame<double>, F::markers> const& frames,
                             std::array<double, F::states> const& z, double t, TangentFactors const& by) {
  Index const first = 6 * F::markers, n = first + F::states;
  MatX gradient(n, n);
  double const step = 1e-3 / std::max({1.0, by.pose, by.twist, by.states});
  for (Index j = 0; j < first; ++j)
    gradient.col(j) = slope_at_zero(
        [&](double h) { return stacked_answer(force, shifted(frames, j, by.pose, by.twist, h), z, t); }, step);
  for (Index j = first; j < n; ++j)
    gradient.col(j) = slope_at_zero(
        [&](double h) {
          auto near = z;
          near[std::size_t(j - first)] += by.states * h;
          return stacked_answer(force, frames, near, t);
        },
        step);
  return gradient;
}

/// Largest difference between `wrench_gradient` and `gradient_by_differences`, divided by 1 + the largest entry of the
/// latter.
template <ForceElement F>
double gradient_mismatch(F const& force, std::array<Frame<double>, F::markers> const& frames, double t, double ck,
                         double cd) {
  MatX const expected = gradient_by_differences(force, frames, t, ck, cd);
  MatX const given = wrench_gradient(force, frames, t, ck, cd);
  return (given - expected).cwiseAbs().maxCoeff() / (1.0 + expected.cwiseAbs().maxCoeff());
}

}  // namespace polybody::laws
