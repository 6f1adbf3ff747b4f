#pragma once
/// \file
/// Common parts of the cases M1, M2, M3 and M7.

#include <gtest/gtest.h>

#include <polybody/integrators/generalised_alpha.hpp>
#include <polybody/run/marker_frames.hpp>
#include <polybody/run/probe.hpp>
#include <polybody/run/simulate.hpp>
#include <polybody/statics/equilibrium.hpp>

#include "support/flexible_mechanism.hpp"
#include "support/held.hpp"

namespace polybody::long_cases {

using namespace flexible;

/// Angle of a rotation R about the axis c, within one revolution of `near`: sin θ c is the axial vector of R, 2 cos θ
/// + 1 its trace.
inline double angle_about(Mat3 const& r, Vec3 const& c, double near) {
  Vec3 const axial(r(2, 1) - r(1, 2), r(0, 2) - r(2, 0), r(1, 0) - r(0, 1));
  double const angle = std::atan2(0.5 * c.dot(axial), 0.5 * (r.trace() - 1.0));
  return near + std::remainder(angle - near, 2.0 * std::numbers::pi);
}

/// Limit of two meshes whose errors have the given `ratio`.
inline double extrapolated(double coarse, double fine, double ratio) { return fine + (fine - coarse) / (ratio - 1.0); }

}  // namespace polybody::long_cases
