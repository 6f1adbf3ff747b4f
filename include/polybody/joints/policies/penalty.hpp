#pragma once
/// \file
/// Penalty policies: a spring and a damper replace each constraint equation.
/// Theory: Eq. 5.7.

#include <polybody/joints/policies/policy.hpp>

namespace polybody {

/// Spring and damper on each constraint violation: λ = k g + c ġ instead of a multiplier, force −Gᵀλ [thesis Eq.
/// 3.11–3.14]. Units are those of the equation: [N/m], [N s/m] for lengths, [N m], [N m s] for angles and direction
/// cosines.
struct Penalty {
  static constexpr char const* name = "Penalty";
  static constexpr bool linear = true;  ///< true: λ is linear in g and ġ

  Required<double> stiffness;  ///< k [N/m], [N m/rad]
  Required<double> damping;    ///< c [N s/m], [N m s/rad]

  /// \throws InvalidInput unless k > 0 and c ≥ 0; `what` is the joint's name.
  void check(std::string const& what) const {
    require_positive(stiffness, what, ": the penalty stiffness");
    require_not_negative(damping, what, ": the penalty damping");
  }

  template <int m, StateScalar T>
  Vec<T, m> multiplier(Vec<T, m> const& g, Vec<T, m> const& g_rate) const {
    Vec<T, m> lambda;
    for (int i = 0; i < m; ++i) lambda[i] = g[i] * stiffness.value + g_rate[i] * damping.value;
    return lambda;
  }
  /// Derivative ck ∂λ/∂g + cd ∂λ/∂ġ (m×m) with given ck, cd.
  template <int m>
  Eigen::DiagonalMatrix<double, m> slope(double ck, double cd, Vec<double, m> const&, Vec<double, m> const&) const {
    Eigen::DiagonalMatrix<double, m> slope;
    for (int i = 0; i < m; ++i) slope.diagonal()[i] = ck * stiffness + cd * damping;
    return slope;
  }
  bool is_lossless() const { return damping == 0.0; }  ///< true without damping
  /// Energy of the spring at the violations g [J].
  template <int m>
  double potential(Vec<double, m> const& g) const {
    double sum = 0.0;
    for (int i = 0; i < m; ++i) sum += g[i] * g[i];
    return 0.5 * stiffness * sum;
  }
};

/// Penalty with parameters for each of the n constraint equations of a joint, such as `PenaltyPerEquation<5>` for a
/// Revolute.
template <int n>
struct PenaltyPerEquation {
  static constexpr char const* name = "PenaltyPerEquation";
  static constexpr bool linear = true;  ///< true: λ is linear in g and ġ

  Required<Vec<double, n>> stiffness;  ///< (n) k, units as for `Penalty`
  Required<Vec<double, n>> damping;    ///< (n) c, units as for `Penalty`

  /// \throws InvalidInput unless k > 0 and c ≥ 0 for every equation; `what` is the joint's name.
  void check(std::string const& what) const {
    for (int i = 0; i < n; ++i) {
      std::string const row = sentence_of({" of constraint equation ", i + 1});
      require_positive(stiffness.value[i], what + ": the penalty stiffness" + row);
      require_not_negative(damping.value[i], what + ": the penalty damping" + row);
    }
  }

  template <int m, StateScalar T>
    requires(m == n)
  Vec<T, m> multiplier(Vec<T, m> const& g, Vec<T, m> const& g_rate) const {
    Vec<T, m> lambda;
    for (int i = 0; i < m; ++i) lambda[i] = g[i] * stiffness.value[i] + g_rate[i] * damping.value[i];
    return lambda;
  }
  /// Derivative ck ∂λ/∂g + cd ∂λ/∂ġ (m×m) with given ck, cd.
  template <int m>
    requires(m == n)
  Eigen::DiagonalMatrix<double, m> slope(double ck, double cd, Vec<double, m> const&, Vec<double, m> const&) const {
    Eigen::DiagonalMatrix<double, m> slope;
    for (int i = 0; i < m; ++i) slope.diagonal()[i] = ck * stiffness.value[i] + cd * damping.value[i];
    return slope;
  }
  bool is_lossless() const { return damping.value.isZero(0.0); }  ///< true without damping
  /// Energy of the springs at the violations g [J].
  template <int m>
    requires(m == n)
  double potential(Vec<double, m> const& g) const {
    double sum = 0.0;
    for (int i = 0; i < m; ++i) sum += g[i] * (stiffness.value[i] * g[i]);
    return 0.5 * sum;
  }
};

}  // namespace polybody
