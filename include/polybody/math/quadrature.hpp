#pragma once
/// \file
/// Gauss–Legendre rules of n points on [0, 1], computed at compile time. They are exact for polynomials up to degree
/// 2n − 1 [Abramowitz & Stegun 1964, 25.4.29].

#include <array>

#include <polybody/math/compiler.hpp>

namespace polybody {

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

/// Roots of the Legendre polynomial P_n. The roots of P_{n−1} and the ends ±1 bracket each root. Bisection of the
/// bracket yields the initial value for Newton's method.
template <int n>
constexpr std::array<double, n> legendre_roots() {
  std::array<double, n> roots{};
  if constexpr (n > 1) {
    constexpr auto fence = legendre_roots<n - 1>();
    for (std::size_t i = 0; i < roots.size(); ++i) {
      double lo = i == 0 ? -1.0 + 1e-12 : fence[i - 1];
      double hi = i + 1 == roots.size() ? 1.0 - 1e-12 : fence[i];
      bool const rising = legendre(n, hi).p > 0.0;
      for (int k = 0; k < 8; ++k) {
        double const mid = 0.5 * (lo + hi);
        if ((legendre(n, mid).p > 0.0) == rising)
          hi = mid;
        else
          lo = mid;
      }
      double x = 0.5 * (lo + hi);
      for (int k = 0; k < 5; ++k) {  // the initial error is below 1/256 of the bracket
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
