#pragma once
/// \file
/// Tests of properties that all user-defined equations of motion have: `UserSystemLaws`. `system_of` makes a system
/// from such equations.
///
/// Requires GoogleTest.

#include <polybody/system/user_system.hpp>
#include <polybody/testing/differences.hpp>
#include <polybody/testing/laws.hpp>

namespace polybody::laws {

/// Laws of user-defined equations of motion, from which `system_of` makes a system. A case gives the equations, and the
/// coordinates at which the laws are tested:
///
///     struct DoublePendulumCase {
///       static DoublePendulum equations();
///       static VecX coordinates(Numbers&);  // optional; the default is random numbers in [−1, 1]
///     };
///     bool const pendulum_obeys = obeys<DoublePendulumCase, UserSystemLaws>("DoublePendulum");
template <class Case>
struct UserSystemLaws {
  using E = decltype(Case::equations());  ///< type of the equations
  static_assert(UserMechanics<E>);
  static constexpr double wild = 1e9;  ///< initial value of result arrays; every entry must be overwritten

  E const equations = Case::equations();   ///< equations under test
  Index const n = equations.velocities();  ///< number of generalised velocities
  double const t = 1.3;                    ///< time of the evaluation [s]
  Numbers number;                          ///< random numbers with a fixed seed

  /// Coordinates q (n) of the case, or random numbers in [−1, 1] if the case has no function `coordinates`.
  VecX coordinates() {
    if constexpr (requires { Case::coordinates(number); })
      return Case::coordinates(number);
    else
      return number.vector(n);
  }
  /// Mass matrix M (n×n). All entries have the value `before` before the evaluation.
  MatX mass(VecX const& q, double before = wild) const {
    MatX m = MatX::Constant(n, n, before);
    equations.mass(q, m);
    return m;
  }
  /// Force f (n) at the time t.
  VecX force(VecX const& q, VecX const& v) const {
    VecX f = VecX::Constant(n, wild);
    equations.force(q, v, t, f);
    return f;
  }
  /// Number of constraint equations; zero if the equations have none.
  Index rows() const {
    if constexpr (HasConstraintEquations<E>)
      return equations.rows();
    else
      return 0;
  }
  /// Constraint violation Φ (rows) at time `at` [s].
  VecX violation(VecX const& q, double at) const {
    VecX phi = VecX::Constant(rows(), wild);
    if constexpr (HasConstraintEquations<E>) equations.violation(q, at, phi);
    return phi;
  }
  /// Constraint Jacobian ∂Φ/∂q (rows×n) at time `at` [s].
  MatX jacobian(VecX const& q, double at) const {
    MatX g = MatX::Constant(rows(), n, wild);
    if constexpr (HasConstraintEquations<E>) equations.jacobian(q, at, g);
    return g;
  }
  /// Partial derivative ∂Φ/∂t (rows) at time `at` [s].
  VecX rate(VecX const& q, double at) const {
    VecX phi_t = VecX::Constant(rows(), wild);
    if constexpr (HasConstraintEquations<E>) equations.rate(q, at, phi_t);
    return phi_t;
  }

  /// M = Mᵀ and vᵀM v > 0, and M does not depend on the initial values of the result array.
  void mass_is_symmetric_and_positive() {
    VecX const q = coordinates();
    MatX const m = mass(q);
    EXPECT_EQ(m, mass(q, 0.0));
    EXPECT_LT((m - m.transpose()).norm(), 1e-14 * m.norm());
    for (int k = 0; k < 10; ++k) {
      VecX const v = number.vector(n);
      EXPECT_GT(v.dot(m * v), 0.0);
    }
  }

  /// `tangent` equals −(ck ∂f/∂q + cd ∂f/∂v) for given ck, cd, if the equations provide a tangent.
  void tangent_is_the_derivative_of_the_force() {
    if constexpr (HasForceTangent<E>) {
      VecX const q = coordinates(), v = number.vector(n);
      for (auto const& [ck, cd] : {std::pair{1.0, 0.0}, {0.0, 1.0}, {0.7, 31.0}}) {
        MatX k = MatX::Constant(n, n, wild), expected(n, n);
        equations.tangent(q, v, t, ck, cd, k);
        for (Index j = 0; j < n; ++j) {
          VecX const unit = VecX::Unit(n, j);
          VecX const by_position = slope_at_zero([&](double h) { return force(q + h * unit, v); });
          VecX const by_speed = slope_at_zero([&](double h) { return force(q, v + h * unit); });
          expected.col(j) = -(ck * by_position + cd * by_speed);
        }
        EXPECT_LT((k - expected).norm(), 1e-8 * (1.0 + expected.norm())) << ck << ' ' << cd;
      }
    }
  }

  /// G = ∂Φ/∂q and Φ_t = ∂Φ/∂t, for equations with constraint equations.
  void jacobian_and_rate_are_the_derivatives_of_the_violation() {
    VecX const q = coordinates();
    MatX const g = jacobian(q, t);
    for (Index j = 0; j < n; ++j) {
      VecX const slope = slope_at_zero([&](double h) { return violation(q + h * VecX::Unit(n, j), t); });
      EXPECT_LT((g.col(j) - slope).norm(), 1e-9 * (1.0 + g.norm())) << j;
    }
    VecX const by_time = slope_at_zero([&](double h) { return violation(q, t + h); });
    EXPECT_LT((rate(q, t) - by_time).norm(), 1e-9 * (1.0 + by_time.norm()));
  }

  /// γ = d/dt (G v + Φ_t) along q + v t at constant v, so that Φ̈ = G v̇ + γ, for equations with constraint equations.
  void gamma_is_the_second_derivative_without_accelerations() {
    if constexpr (HasConstraintEquations<E>) {
      VecX const q = coordinates(), v = number.vector(n);
      VecX gamma = VecX::Constant(rows(), wild);
      equations.gamma(q, v, t, gamma);
      VecX const expected =
          slope_at_zero([&](double h) { return VecX(jacobian(q + h * v, t + h) * v + rate(q + h * v, t + h)); });
      EXPECT_LT((gamma - expected).norm(), 1e-9 * (1.0 + expected.norm()));
    }
  }

  static constexpr char const* suite = "UserSystemLaws";
  static constexpr Law<UserSystemLaws> laws[] = {
      {"MassIsSymmetricAndPositive", &UserSystemLaws::mass_is_symmetric_and_positive},
      {"TangentIsTheDerivativeOfTheForce", &UserSystemLaws::tangent_is_the_derivative_of_the_force, HasForceTangent<E>},
      {"JacobianAndRateAreTheDerivativesOfTheViolation",
       &UserSystemLaws::jacobian_and_rate_are_the_derivatives_of_the_violation, HasConstraintEquations<E>},
      {"GammaIsTheSecondDerivativeWithoutAccelerations",
       &UserSystemLaws::gamma_is_the_second_derivative_without_accelerations, HasConstraintEquations<E>}};
};

}  // namespace polybody::laws
