#pragma once
/// \file
/// Work of a force and a moment over a step, from their values at both ends.

#include <cmath>

#include <polybody/math/types.hpp>

namespace polybody::detail {

/// Rotation vector (3) from axes `a0` to `a1` (3×3 by columns), in world axes [rad]. The number of full revolutions
/// agrees with `mean` (3), the rotation by the mean angular velocity [rad].
inline Vec3 turn_between(double const* a0, double const* a1, Vec3 const& mean) {
  Vec3 s = Vec3::Zero();
  double trace = 0.0;
  for (int c = 0; c < 3; ++c) {
    double const *const x = a0 + 3 * c, *const y = a1 + 3 * c;
    for (int i = 0; i < 3; ++i) {
      int const j = (i + 1) % 3, k = (i + 2) % 3;
      s[i] += 0.5 * (x[j] * y[k] - x[k] * y[j]);
      trace += x[i] * y[i];
    }
  }
  double const sine = s.norm(), angle = std::atan2(sine, 0.5 * (trace - 1.0));
  if (!(sine > 1e-9)) return angle < 1.0 && mean.norm() < 3.0 ? s : mean;
  constexpr double turn = 6.283185307179586;
  double const turns = std::round((mean.dot(s) / sine - angle) / turn);
  return s * ((angle + (std::isfinite(turns) ? turns : 0.0) * turn) / sine);
}

/// ½ (f₀ + f₁)·Δr + ½ (m₀ + m₁)·Δφ [J] of an applied wrench over a step of length h [s]. x and y contain r, A, [f; m]
/// and ω of its marker at the beginning and the end of the step.
inline double work_along_path(double const* x, double const* y, double h) {
  double work = 0.0;
  bool turns = false;
  for (int i = 0; i < 3; ++i) {
    work += 0.5 * (x[12 + i] + y[12 + i]) * (y[i] - x[i]);
    turns = turns || x[15 + i] != 0.0 || y[15 + i] != 0.0;
  }
  if (!turns) return work;
  Vec3 mean;
  for (int i = 0; i < 3; ++i) mean[i] = 0.5 * h * (x[18 + i] + y[18 + i]);
  Vec3 const turn = turn_between(x + 3, y + 3, mean);
  for (int i = 0; i < 3; ++i) work += 0.5 * (x[15 + i] + y[15 + i]) * turn[i];
  return work;
}

}  // namespace polybody::detail
