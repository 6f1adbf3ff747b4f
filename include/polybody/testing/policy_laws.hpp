#pragma once
/// \file
/// Tests of properties that every compliant joint policy (penalty, bushing) has: `PolicyLaws`.
///
/// Requires GoogleTest.

#include <polybody/joints/policies/policy.hpp>
#include <polybody/testing/differences.hpp>
#include <polybody/testing/laws.hpp>

namespace polybody::laws {

/// Laws of all policies that replace constraint equations by a force −Gᵀλ(g, ġ), with the violation g. A case gives the
/// policy and the size of constraint violations:
///
///     struct PenaltyCase {
///       static constexpr int rows = 3;      // number of constraint equations
///       static Penalty policy();
///       static constexpr double violation = 0.1;  // size of g [m], [rad]; 1 if omitted
///     };
///     bool const penalty_obeys = obeys<PenaltyCase, PolicyLaws>("Penalty");
template <class Case>
struct PolicyLaws {
  using P = decltype(Case::policy());   ///< type of the policy
  static constexpr int m = Case::rows;  ///< number of constraint equations
  static_assert(CompliantLaw<P, m> && Policy<P>);
  using Row = Vec<double, m>;  ///< one number for each constraint equation

  P const policy = Case::policy();  ///< policy under test
  Numbers number;                   ///< random numbers with a fixed seed

  /// Size of the constraint violations [m], [rad]: value of the case, or 1.
  static double size() {
    if constexpr (requires { Case::violation; })
      return Case::violation;
    else
      return 1.0;
  }
  Row violation() { return number.template vec<m>(size()); }  ///< random violation g in [−size, size]
  Row rate() { return number.template vec<m>(); }             ///< random rate ġ in [−1, 1]
  Row multiplier(Row const& g, Row const& g_rate) const { return policy.template multiplier<m, double>(g, g_rate); }

  /// `slope`(ck, cd) equals ck ∂λ/∂g + cd ∂λ/∂ġ, computed with dual numbers, for given ck, cd.
  void slope_is_the_derivative_of_the_multiplier() {
    using D = Dual<1>;
    for (auto const& [ck, cd] : {std::pair{1.0, 0.0}, {0.0, 1.0}, {0.7, 31.0}}) {
      Row const g = violation(), g_rate = rate();
      Mat<double, m, m> const slope = policy.template slope<m>(ck, cd, g, g_rate);
      for (int j = 0; j < m; ++j) {
        Vec<D, m> of_g = g.template cast<D>(), of_rate = g_rate.template cast<D>();
        of_g[j].d[0] = ck;
        of_rate[j].d[0] = cd;
        Vec<D, m> const lambda = policy.template multiplier<m, D>(of_g, of_rate);
        for (int i = 0; i < m; ++i) EXPECT_NEAR(lambda[i].d[0], slope(i, j), 1e-12 * (1.0 + slope.norm()));
      }
    }
  }

  /// λ(g, 0) = ∂U/∂g.
  void elastic_multiplier_is_the_slope_of_the_potential() {
    Row const g = violation(), lambda = multiplier(g, Row::Zero());
    EXPECT_GT(lambda.norm(), 0.0);
    for (int i = 0; i < m; ++i) {
      double const slope = slope_at_zero(
          [&](double h) { return double(policy.template potential<m>(Row(g + Row::Unit(i) * h))); }, 1e-3 * size());
      EXPECT_NEAR(lambda[i], slope, 1e-8 * (1.0 + lambda.norm()));
    }
  }

  /// λ(0, 0) = 0 and U(0) = 0: the force is zero if the constraint equations are satisfied at rest.
  void closed_joint_is_at_rest() {
    EXPECT_EQ(multiplier(Row::Zero(), Row::Zero()).norm(), 0.0);
    EXPECT_EQ(policy.template potential<m>(Row::Zero()), 0.0);
  }

  /// (λ(g, ġ) − λ(g, 0))·ġ ≥ 0: the force that depends on ġ dissipates energy.
  void damping_takes_power() {
    for (int k = 0; k < 10; ++k) {
      Row const g = violation(), g_rate = rate();
      EXPECT_GE((multiplier(g, g_rate) - multiplier(g, Row::Zero())).dot(g_rate), 0.0);
    }
  }

  static constexpr char const* suite = "PolicyLaws";
  static constexpr Law<PolicyLaws> laws[] = {
      {"SlopeIsTheDerivativeOfTheMultiplier", &PolicyLaws::slope_is_the_derivative_of_the_multiplier},
      {"ElasticMultiplierIsTheSlopeOfThePotential", &PolicyLaws::elastic_multiplier_is_the_slope_of_the_potential},
      {"ClosedJointIsAtRest", &PolicyLaws::closed_joint_is_at_rest},
      {"DampingTakesPower", &PolicyLaws::damping_takes_power}};
};

}  // namespace polybody::laws
