#pragma once
// User-defined policy: the requirements of the concept `polybody::CompliantLaw`, for any number of constraint
// equations.
#include <polybody/polybody.hpp>

namespace own {

using namespace polybody;

/// Rubber mount with hardening, for each constraint equation: λ = k g + κ g³ + c ġ (Duffing).
struct HardeningPenalty {
  static constexpr char const* name = "HardeningPenalty";

  Required<double> stiffness;  ///< k [N/m]
  Required<double> hardening;  ///< κ [N/m³]
  Required<double> damping;    ///< c [N s/m]

  /// Called by `connect`; `what` is the joint's name.
  void check(std::string const& what) const {
    require_positive(stiffness, what + ": the stiffness");
    require_not_negative(hardening, what + ": the hardening");
    require_not_negative(damping, what + ": the damping");
  }
  template <int m, StateScalar T>
  Vec<T, m> multiplier(Vec<T, m> const& g, Vec<T, m> const& rate) const {
    Vec<T, m> lambda;
    for (int i = 0; i < m; ++i)
      lambda[i] = g[i] * (stiffness.value + g[i] * g[i] * hardening.value) + rate[i] * damping.value;
    return lambda;
  }
  /// ck ∂λ/∂g + cd ∂λ/∂ġ (m×m).
  template <int m>
  Eigen::DiagonalMatrix<double, m> slope(double ck, double cd, Vec<double, m> const& g, Vec<double, m> const&) const {
    Eigen::DiagonalMatrix<double, m> slope;
    for (int i = 0; i < m; ++i) slope.diagonal()[i] = ck * (stiffness + 3.0 * hardening * g[i] * g[i]) + cd * damping;
    return slope;
  }
  /// ½ k g² + ¼ κ g⁴ [J].
  template <int m>
  double potential(Vec<double, m> const& g) const {
    double sum = 0.0;
    for (int i = 0; i < m; ++i) sum += g[i] * g[i] * (0.5 * stiffness + 0.25 * hardening * g[i] * g[i]);
    return sum;
  }
};

static_assert(CompliantPolicy<HardeningPenalty> && Policy<HardeningPenalty>);

}  // namespace own
