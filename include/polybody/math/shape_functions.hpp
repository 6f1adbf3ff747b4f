#pragma once
/// \file
/// Shape functions of two-node elements on ξ ∈ [0, 1].

#include <array>

#include <polybody/math/compiler.hpp>

namespace polybody {

/// Values of `n` shape functions of an element of length l, and their derivatives with respect to the arc length
/// x = ξ l [m]. Units of derivatives are those of shape functions without unit.
template <int n>
struct ShapeValues {
  std::array<double, n> s;    ///< values s
  std::array<double, n> ds;   ///< ∂s/∂x [1/m]
  std::array<double, n> dds;  ///< ∂²s/∂x² [1/m²]
};

/// Linear shape functions on an element of length `length` [m]: s₁ = 1 − ξ, s₂ = ξ.
constexpr ShapeValues<2> linear_shape(double xi, double length) {
  return {{1.0 - xi, xi}, {-1.0 / length, 1.0 / length}, {0.0, 0.0}};
}

/// Cubic Hermite shape functions on an element of length l = `length` [m]. They multiply the positions r and gradients
/// r′ of both nodes, (r₀, r₀′, r₁, r₁′):
/// s₁ = 1 − 3ξ² + 2ξ³, s₂ = l(ξ − 2ξ² + ξ³), s₃ = 3ξ² − 2ξ³, s₄ = l(−ξ² + ξ³)
/// [thesis Eq. 3.16, s₃ with the sign of Eq. 4.8].
constexpr ShapeValues<4> hermite_shape(double xi, double length) {
  double const x2 = xi * xi, x3 = x2 * xi, l = length;
  return {{1.0 - 3.0 * x2 + 2.0 * x3, l * (xi - 2.0 * x2 + x3), 3.0 * x2 - 2.0 * x3, l * (x3 - x2)},
          {(6.0 * x2 - 6.0 * xi) / l, 1.0 - 4.0 * xi + 3.0 * x2, (6.0 * xi - 6.0 * x2) / l, 3.0 * x2 - 2.0 * xi},
          {(12.0 * xi - 6.0) / (l * l), (6.0 * xi - 4.0) / l, (6.0 - 12.0 * xi) / (l * l), (6.0 * xi - 2.0) / l}};
}

}  // namespace polybody
