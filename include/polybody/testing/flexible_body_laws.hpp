#pragma once
/// \file
/// Tests of properties that every flexible body has: `FlexibleBodyLaws`.
///
/// Requires GoogleTest.

#include <polybody/testing/body_laws.hpp>

namespace polybody::laws {

/// Laws that every flexible body satisfies in addition to `BodyLaws`. Both suites use the same case, whose body has
/// damping:
///
///     bool const lrvf_obeys = obeys<LrvfCase, BodyLaws, FlexibleBodyLaws>("Lrvf");
///
/// A case without a Bar has one more function:
///
///     static Dumbbell elsewhere();  // the same body at another position and orientation
template <class Case>
struct FlexibleBodyLaws : BodyLaws<Case> {
  typename BodyLaws<Case>::B const undamped = BodyOf<Case>::undamped();  ///< same body without damping
  VecX damping_force(VecX const& q, VecX const& v) {
    return this->template force<double>(q, v) - this->template force_of<double>(undamped, q, v);
  }  ///< (nv) damping force: difference of f with and without damping
  /// (nv) Elastic force and damping force, without the velocity terms of inertia.
  VecX internal_force(VecX const& q, VecX const& v) { return this->force_at_rest(q) + damping_force(q, v); }

  /// In the configuration of the tests, U > 0, f ≠ 0, and f depends on the velocities. Otherwise the other laws would
  /// compare zeros.
  void deformation_is_resisted_and_damped();
  /// f = 0 and U = 0 in the reference configuration of the same body at another placement.
  void rigid_motion_strains_nothing();
  /// f·w = 0 for the velocities w of a rigid motion and the internal force f(q, v) in any state of an objective body,
  /// including damping.
  void internal_forces_are_in_equilibrium();
  /// The damping force is zero for the velocities v of a rigid motion of an objective body.
  void rigid_velocity_is_not_damped();
  /// The power of damping is −vᵀD v < 0. D = Dᵀ is the difference of −∂f/∂v with and without damping.
  void damping_takes_energy();

  static constexpr char const* suite = "FlexibleBodyLaws";
  static constexpr Law<FlexibleBodyLaws> laws[] = {
      {"DeformationIsResistedAndDamped", &FlexibleBodyLaws::deformation_is_resisted_and_damped},
      {"RigidMotionStrainsNothing", &FlexibleBodyLaws::rigid_motion_strains_nothing},
      {"InternalForcesAreInEquilibrium", &FlexibleBodyLaws::internal_forces_are_in_equilibrium,
       FlexibleBodyLaws::objective},
      {"RigidVelocityIsNotDamped", &FlexibleBodyLaws::rigid_velocity_is_not_damped, FlexibleBodyLaws::objective},
      {"DampingTakesEnergy", &FlexibleBodyLaws::damping_takes_energy}};
};

template <class Case>
void FlexibleBodyLaws<Case>::deformation_is_resisted_and_damped() {
  VecX const q = this->configuration(), v = this->velocities();
  EXPECT_GT(this->strain_energy(q), 0.1);
  EXPECT_GT(this->force_at_rest(q).norm(), 1.0);
  EXPECT_GT(mismatch(this->template force<double>(q, v), this->force_at_rest(q)), 1e-3);
}

template <class Case>
void FlexibleBodyLaws<Case>::rigid_motion_strains_nothing() {
  auto const other = [] {
    if constexpr (MadeFromBar<Case>) {
      Bar bar = Case::bar();
      bar.placement = FlexibleBodyLaws::planar ? Placement::planar(-7.0, 3.0, 2.5)
                                               : Placement::at({-7.0, 3.0, 5.0}, {1.0, -0.4, 2.0});
      return Case::body(bar);
    } else {
      return Case::elsewhere();
    }
  }();
  VecX q(this->nq);
  other.reference(mutable_view(q));
  double const size = BodyOf<Case>::stiffness();
  EXPECT_LT(this->force_at_rest(q).norm(), 1e-10 * size);
  EXPECT_LT(this->strain_energy(q), 1e-20 * size);
}

template <class Case>
void FlexibleBodyLaws<Case>::internal_forces_are_in_equilibrium() {
  VecX const q = this->configuration(), v = this->velocities();
  VecX const rigid = this->rigid_velocity(q, this->velocity(), this->spin());
  VecX const f = this->internal_force(q, v);
  EXPECT_LT(std::abs(f.dot(rigid)), 1e-13 * (1.0 + f.norm() * rigid.norm()));
}

template <class Case>
void FlexibleBodyLaws<Case>::rigid_velocity_is_not_damped() {
  VecX const q = this->configuration(), v = this->rigid_velocity(q, this->velocity(), this->spin());
  EXPECT_GT(v.norm(), 0.1);
  EXPECT_LT(this->damping_force(q, v).norm(), 1e-13 * (1.0 + this->force_at_rest(q).norm()));
}

template <class Case>
void FlexibleBodyLaws<Case>::damping_takes_energy() {
  for (int i = 0; i < 20; ++i) {
    VecX const q = this->configuration(), v = this->velocities();
    double const power = this->damping_force(q, v).dot(v);
    MatX const d = this->tangent(q, v, 0.0, 1.0) - this->assembled_matrix([&](Index e, auto& k) {
      this->undamped.tangent(e, view(q), view(v), 0.0, 1.0, k);
    });
    EXPECT_LT(power, -1e-3);
    EXPECT_NEAR(power, -v.dot(d * v), 1e-12 * std::abs(power));
    EXPECT_LT(mismatch(d, d.transpose()), 1e-14);
  }
}

}  // namespace polybody::laws
