#pragma once
/// \file
/// Multipliers of an eliminated joint from its reaction wrench.

#include <polybody/system/tree_body.hpp>

namespace polybody::detail {

/// Adds to λ (m entries) the correction δ that minimises ‖Gᵀδ + `residual`‖. \param map G of the carried body, m×6 by
/// columns, about the marker \param residual residual wrench [f; m] of the body about its centre of mass \param arm
/// vector from the centre of mass to the marker
template <class T>
void add_multipliers_that_hold(int m, T const* map, Vec<T, 6> residual, Vec<T, 3> const& arm, T* lambda) {
  for (int k = 0; k < 3; ++k)
    residual[3 + k] -= arm[(k + 1) % 3] * residual[(k + 2) % 3] - arm[(k + 2) % 3] * residual[(k + 1) % 3];
  auto gram = zeros<Mat<T, 6, 6>>();
  for (int k = m; k < 6; ++k) gram(k, k) = 1.0;
  T right[6] = {};
  for (int k = 0; k < m; ++k) {
    for (int l = 0; l < 6; ++l) right[k] -= map[m * l + k] * residual[l];
    for (int j = 0; j < m; ++j) {
      T sum = 0.0;
      for (int l = 0; l < 6; ++l) sum += map[m * l + k] * map[m * l + j];
      gram(k, j) = sum;
    }
  }
  invert_leading(gram, m);
  for (int k = 0; k < m; ++k) {
    T sum = 0.0;
    for (int j = 0; j < m; ++j) sum += gram(k, j) * right[j];
    lambda[k] += sum;
  }
}

}  // namespace polybody::detail
