#pragma once
/// \file
/// Derivatives of the strains of a section with respect to its nodes (maps P and Q of `StrainSection`) by dual numbers,
/// for rotation interpolations without closed forms.

#include <array>

#include <polybody/bodies/lrvf/rotation_interpolation.hpp>

namespace polybody::detail {

/// Quaternion q ⊞ δ with its derivatives at δ = 0. The components of δ are `size` times the three dual variables from
/// number `first` on.
template <int n>
Quaternion<Dual<n>> turning_quaternion(Quaternion<double> const& q, int first, double size = 1.0) {
  Quaternion<Dual<n>> out(q[0], q[1], q[2], q[3]);
  for (int i = 0; i < 3; ++i) {
    Quaternion<double> half(0.0, 0.0, 0.0, 0.0);
    half[i + 1] = 0.5 * size;
    Quaternion<double> const slope = quaternion_product<double>(q, half);
    for (int k = 0; k < 4; ++k) out[k].d[first + i] = slope[k];
  }
  return out;
}

/// Vectors that are constant in a derivative of the maps P and Q.
struct FixedRotation {
  Vec<double, 3> t, m;
  Vec<double, 6> w;
};

/// Derivatives of Pᵀ t + Qᵀ m, P w and Q w at ξ with respect to (δθ₁, δθ₂).
template <class I, StateScalar D = Dual<6>>  // compiled only if used
void strain_gradient(I const& interpolation, double xi, std::array<Quaternion<double>, 2> const& nodes,
                     FixedRotation const& fixed, StrainGradient& out) {
  StrainSection<D> at;
  interpolation.template at<D>(xi, turning_quaternion<6>(nodes[0], 0), turning_quaternion<6>(nodes[1], 3), at);
  out.pulled = zeros<Mat<double, 6, 6>>();
  out.spin = out.bend = zeros<Mat<double, 3, 6>>();
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 6; ++j)
      for (int k = 0; k < 6; ++k) {
        out.pulled(j, k) += fixed.t[i] * at.spin(i, j).d[k] + fixed.m[i] * at.bend(i, j).d[k];
        out.spin(i, k) += fixed.w[j] * at.spin(i, j).d[k];
        out.bend(i, k) += fixed.w[j] * at.bend(i, j).d[k];
      }
}

}  // namespace polybody::detail
