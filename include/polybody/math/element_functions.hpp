#pragma once
/// \file
/// Shape functions and quadrature of two-node elements on ξ ∈ [0, 1].
/// Theory: Eq. 2.13.

#include <array>

#include <polybody/math/compiler.hpp>

namespace polybody {

/// Values of `n` shape functions of an element of length l, and their derivatives with respect to the arc length
/// x = ξ l [m]. The units hold for shape functions without unit.
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

/// Integration point ξ ∈ [0, 1] and its weight. The weights of a rule have the sum one.
struct GaussPoint {
  double xi;      ///< position ξ in [0, 1]
  double weight;  ///< weight of the point
};

namespace detail {

struct LegendreValue {
  double p;   ///< P_n(x)
  double dp;  ///< P_n′(x)
};

/// Legendre polynomial P_n by (k+1) P_{k+1} = (2k+1) x P_k − k P_{k−1}; derivative (1 − x²) P_n′ = n (P_{n−1} − x P_n).
constexpr LegendreValue legendre(int n, double x) {
  double before = 1.0, now = x;
  for (int k = 1; k < n; ++k) {
    double const next = ((2 * k + 1) * x * now - k * before) / (k + 1);
    before = now;
    now = next;
  }
  return {now, n * (before - x * now) / (1.0 - x * x)};
}

/// Roots of the Legendre polynomial P_n in ascending order, by Newton's method. The initial values
/// −cos(π (i + 3/4)/(n + 1/2)) [Abramowitz & Stegun 22.16.6] are computed as a sine, by its series.
template <int n>
constexpr std::array<double, n> legendre_roots() {
  std::array<double, n> roots{};
  if constexpr (n > 1) {
    for (std::size_t i = 0; i < roots.size(); ++i) {
      double const angle = 3.14159265358979 * ((double(i) + 0.75) / (n + 0.5) - 0.5), square = angle * angle;
      double x = angle * (1.0 - square / 6.0 * (1.0 - square / 20.0 * (1.0 - square / 42.0)));
      for (int k = 0; k < 5; ++k) {
        LegendreValue const f = legendre(n, x);
        x -= f.p / f.dp;
      }
      roots[i] = x;
    }
  }
  return roots;
}

template <int n>
constexpr std::array<GaussPoint, n> gauss_rule() {
  std::array<GaussPoint, n> rule{};
  auto const roots = legendre_roots<n>();
  for (std::size_t i = 0; i < rule.size(); ++i) {
    double const dp = n == 1 ? 1.0 : legendre(n, roots[i]).dp;
    rule[i] = {0.5 * (1.0 + roots[i]), 1.0 / ((1.0 - roots[i] * roots[i]) * dp * dp)};
  }
  return rule;
}

}  // namespace detail

/// Gauss rule of n points: ∫₀¹ f(ξ) dξ ≈ Σ weight f(ξ).
template <int n>
  requires(n >= 1 && n <= 10)
inline constexpr std::array<GaussPoint, n> gauss = detail::gauss_rule<n>();

}  // namespace polybody
