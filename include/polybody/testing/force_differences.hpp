#pragma once
/// \file
/// The wrenches of a force element as one vector, and their derivatives by differences.
///
/// Not in polybody.hpp: for tests.

#include <algorithm>
#include <array>

#include <polybody/forces/force_element.hpp>
#include <polybody/testing/differences.hpp>
#include <polybody/testing/frames.hpp>

namespace polybody::laws {

/// All wrenches of a force element, [f; m] for each marker.
template <ForceElement F>
VecX stacked_wrenches(F const& force, std::array<Frame<double>, F::markers> const& frames, double t) {
  VecX all(6 * F::markers);
  auto const w = force.template wrenches<double>(frames, t);
  for (std::size_t k = 0; k < w.size(); ++k) all.segment<6>(Index(6 * k)) << w[k].f, w[k].m;
  return all;
}

/// ck ∂w/∂pose + cd ∂w/∂twist by differences: what `wrench_gradient` must be.
template <ForceElement F>
MatX gradient_by_differences(F const& force, std::array<Frame<double>, F::markers> const& frames, double t, double ck,
                             double cd) {
  MatX gradient(6 * F::markers, 6 * F::markers);
  double const step = 1e-3 / std::max({1.0, ck, cd});
  for (Index j = 0; j < gradient.cols(); ++j)
    gradient.col(j) = slope_at_zero(
        [&](double h) {
          auto shifted = frames;
          Frame<double>& f = shifted[std::size_t(j / 6)];
          Vec6 const unit = Vec6::Unit(j % 6);
          f = moved<double>(f, unit * (ck * h));
          f.v += unit.head<3>() * (cd * h);
          f.w += unit.tail<3>() * (cd * h);
          return stacked_wrenches(force, shifted, t);
        },
        step);
  return gradient;
}

/// The largest entry of `wrench_gradient` less the differences, relative to 1 + the largest entry.
template <ForceElement F>
double gradient_mismatch(F const& force, std::array<Frame<double>, F::markers> const& frames, double t, double ck,
                         double cd) {
  MatX const expected = gradient_by_differences(force, frames, t, ck, cd);
  MatX const given = wrench_gradient(force, frames, t, ck, cd);
  return (given - expected).cwiseAbs().maxCoeff() / (1.0 + expected.cwiseAbs().maxCoeff());
}

}  // namespace polybody::laws
