#pragma once
#include <polybody/joints/policies/policy.hpp>

namespace polybody {

/// Stiff joint: λ = k g + c ġ instead of a multiplier, force −Gᵀλ [thesis Eq. 3.11–3.14]. Row by row in the
/// rows' own units: [N/m], [N s/m] for lengths, [N m], [N m s] for angles and direction cosines.
struct Penalty {
  static constexpr char const* name = "Penalty";

  Required<double> stiffness;  ///< k
  Required<double> damping;    ///< c

  /// \throws InvalidInput unless k > 0 and c ≥ 0; `what` is the joint's name.
  void check(std::string const& what) const {
    require_positive(stiffness, what + ": the penalty stiffness");
    require_not_negative(damping, what + ": the penalty damping");
  }

  template <int m, StateScalar T>
  Vec<T, m> multiplier(Vec<T, m> const& g, Vec<T, m> const& g_rate) const {
    return g * T(stiffness.value) + g_rate * T(damping.value);
  }
  /// ck ∂λ/∂g + cd ∂λ/∂ġ, a diagonal (m).
  template <int m>
  Vec<double, m> slope(double ck, double cd) const {
    return Vec<double, m>::Constant(ck * stiffness + cd * damping);
  }
  /// The energy that the spring stores [J].
  template <int m>
  double potential(Vec<double, m> const& g) const {
    return 0.5 * stiffness * g.squaredNorm();
  }
};

static_assert(AddsForce<Penalty> && !AddsRows<Penalty>);

}  // namespace polybody
