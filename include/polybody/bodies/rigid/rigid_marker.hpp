#pragma once
/// \file
/// Kinematics of a marker on a rigid body. They are computed in SIMD registers, because every evaluation of a model
/// computes them for every marker.

#include <polybody/kinematics/marker_kinematics.hpp>
#include <polybody/math/vec3_storage.hpp>

namespace polybody::detail {

/// Writes the marker kinematics of the point u with the axes `axes`, both in body axes, to `out`; `at` is the pose of
/// the body. The result is bitwise identical to that of the scalar loops in `Rigid::evaluate_marker`.
template <class Pose, class V = Vec3Storage<>>  // compiled only if used
void write_rigid_marker(Vec3 const& u, Mat3 const& axes, Pose const& at, MarkerKinematics<double>& out) {
  V const x = V::column(at.A, 0), y = V::column(at.A, 1), z = V::column(at.A, 2), w = V::load(at.w.data());
  auto const turned = [&](double const* by_body) { return V::combination(x, y, z, by_body); };
  V const arm = turned(u.data()), rate = cross(w, arm);
  (V::load(at.r.data()) + arm).store(out.frame.r.data());
  V::store_columns(turned(axes.data()), turned(axes.data() + 3), turned(axes.data() + 6), out.frame.A);
  (V::load(at.v.data()) + rate).store(out.frame.v.data());
  w.store(out.frame.w.data());
  cross(w, rate).store(out.bias.data());
  for (int i = 3; i < 6; ++i) out.bias[i] = 0.0;
  V::store_columns(x, y, z, out.body_axes);
  arm.store(out.arm.data());
}

}  // namespace polybody::detail
