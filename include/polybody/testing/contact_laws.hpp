#pragma once
/// \file
/// Tests of properties that every contact geometry has: `ContactLaws`.
///
/// Requires GoogleTest.

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include <polybody/testing/contact_probe.hpp>
#include <polybody/testing/force_differences.hpp>
#include <polybody/testing/laws.hpp>

namespace polybody::laws {

/// Laws of contact geometries, alone and in a `Contact` with normal force and friction. Symbols: penetration d, normal
/// n, normal force N, force f and moment m on bodies a and b. Example of a case:
///
///     struct SphereOnPlaneCase {
///       static SphereOnPlane geometry();
///       static constexpr double radius;                                       // of the shape about marker a
///       static Vec3 centre(Numbers&, Frame<double> const& b, double depth);   // position of a at this penetration
///       static Mat3 turning(Frame<double> const& a, Frame<double> const& b);  // ∂n/∂r_a [1/m]
///     };
///     bool const sphere_obeys = obeys<SphereOnPlaneCase, ContactLaws>("SphereOnPlane");
template <class Case>
struct ContactLaws {
  static constexpr char const* suite = "ContactLaws";
  using G = decltype(Case::geometry());      ///< type of the geometry
  using Elastic = Contact<G, HertzContact>;  ///< contact with the normal force of Hertz
  G const geometry = Case::geometry();       ///< geometry under test
  Numbers number;                            ///< random numbers with a fixed seed

  /// Frames of two bodies with penetration `depth`, random orientations and velocities of about 1 m/s.
  Touching overlapping(double depth) {
    Touching f{number.frame(), number.frame()};
    f[0].r = Case::centre(number, f[1], depth);
    return f;
  }
  Touching at_rest(double depth) {
    Touching f = overlapping(depth);
    for (Frame<double>& x : f) x.v = x.w = Vec3::Zero();
    return f;
  }  ///< frames of two bodies at rest with penetration `depth`
  /// Velocity of body a relative to body b at the contact point p.
  static Vec3 relative(ContactPoint<double> const& p, Touching const& f) {
    return f[0].v + f[0].w.cross(p.place - f[0].r) - f[1].v - f[1].w.cross(p.place - f[1].r);
  }
  template <class Law>
  static Law with(Law law, double coefficient = 0.4) {
    law.friction = {.coefficient = coefficient, .slip_speed = 0.3};
    return law;
  }  ///< `law` with the friction coefficient `coefficient` and the slip velocity v_s = 0.3 m/s
  /// Contact with an elastic normal force and without damping.
  Elastic elastic() const { return {.geometry = geometry, .normal = {.modulus = 3e3, .radius = 0.04}}; }
  /// Calls `visit(contact)` for a contact with each type of normal force, without friction. The bodies of the tests
  /// separate so slowly that the normal force is not zero.
  template <class Visit>
  void with_each_contact(Visit&& visit) const {
    visit(Contact<G>{.geometry = geometry, .normal = {.stiffness = 900.0, .damping = 7.0}});
    visit(elastic());
    visit(Contact<G, HuntCrossleyContact>{.geometry = geometry, .normal = {.stiffness = 4e3, .damping = 0.05}});
  }
  template <class Law>
  static std::array<Mat<double, 6, 6>, 2> own(Law const& law, Touching const& f, double ck, double cd) {
    std::array<Mat<double, 6, 6>, 2> k{Mat<double, 6, 6>::Zero(), Mat<double, 6, 6>::Zero()};
    law.own_stiffness(f, ck, cd, k[0], k[1]);
    return k;
  }  ///< matrices `own_stiffness` (6×6) of `law` for body a and for body b
  /// Exact matrices (6×6) for bodies a and b, which `own_stiffness` of `law` approximates.
  template <class Law>
  static std::array<Mat<double, 6, 6>, 2> exact(Law const& law, Touching const& f, double ck, double cd) {
    Mat<double, 12, 12> const k = -wrench_gradient(law, f, 0.0, ck, cd);
    return {k.template topLeftCorner<6, 6>(), k.template bottomRightCorner<6, 6>()};
  }
  static double smallest_eigenvalue(Mat<double, 6, 6> const& m) {
    return Eigen::SelfAdjointEigenSolver<Mat<double, 6, 6>>(m).eigenvalues()[0];
  }  ///< smallest eigenvalue of a symmetric matrix m (6×6)

  // --- geometry -----------------------------------------------------------------------------------------------

  void touches_at_the_depth_it_is_given() {
    for (double const depth : {1e-9, 0.01, 0.1}) {
      Touching const f = overlapping(depth);
      ContactPoint<double> const p = point_of(geometry, f[0], f[1]);
      EXPECT_NEAR(p.depth, depth, 1e-14);
      EXPECT_NEAR(p.normal.norm(), 1.0, 1e-14);
      // the point lies inside of both shapes, on the line through a's centre along n
      Vec3 const arm = f[0].r - p.place;
      EXPECT_LT(arm.cross(p.normal).norm(), 1e-14);
      EXPECT_LE(arm.dot(p.normal), Case::radius + 1e-14);
      EXPECT_GE(arm.dot(p.normal), Case::radius - depth - 1e-14);
    }
  }  ///< d is the penetration of the case, |n| = 1, and the point lies inside of both shapes

  void normal_is_the_slope_of_the_depth() {
    for (int k = 0; k < 4; ++k) {
      Touching const f = overlapping(0.1);
      ContactPoint<double> const p = point_of(geometry, f[0], f[1]);
      // a displacement of a by any δ along n reduces the penetration by δ
      for (double const delta : {0.05, 1e-4, -0.03}) {
        Frame<double> apart = f[0];
        apart.r += delta * p.normal;
        EXPECT_NEAR(point_of(geometry, apart, f[1]).depth, p.depth - delta, 1e-14);
      }
      // change of d for all motions of a and b, by dual numbers: −n · displacement of a relative to b at the contact
      using D = Dual<12>;
      Vec<D, 6> of_a, of_b;
      for (int i = 0; i < 6; ++i) {
        of_a[i] = D::variable(0.0, i);
        of_b[i] = D::variable(0.0, 6 + i);
      }
      D const depth = point_of<D>(geometry, moved<D>(f[0], of_a), moved<D>(f[1], of_b)).depth;
      Vec<double, 12> expected;
      expected << -p.normal, -(p.place - f[0].r).cross(p.normal), p.normal, (p.place - f[1].r).cross(p.normal);
      EXPECT_LT((depth.d.matrix() - expected).norm(), 1e-13);
      // the same derivative by differences
      double const rate =
          slope_at_zero([&](double t) { return point_of(geometry, later(f[0], t), later(f[1], t)).depth; }, 1e-4);
      EXPECT_NEAR(rate, -p.normal.dot(relative(p, f)), 1e-9);
    }
  }  ///< ∂d/∂r_a = −n; the other derivatives of d follow from n and the contact point

  void normal_turns_as_the_shapes_are_curved() {
    for (int k = 0; k < 4; ++k) {
      Touching const f = overlapping(0.05);
      using D = Dual<3>;
      Vec<D, 6> of_a = Vec<D, 6>::Zero();
      for (int i = 0; i < 3; ++i) of_a[i] = D::variable(0.0, i);
      ContactPoint<D> const p = point_of<D>(geometry, moved<D>(f[0], of_a), moved<D>(f[1], Vec<D, 6>::Zero()));
      Mat3 turning;
      for (int i = 0; i < 3; ++i) turning.row(i) = p.normal[i].d.matrix().transpose();
      EXPECT_LT((turning - Case::turning(f[0], f[1])).norm(), 1e-13);
    }
  }  ///< ∂n/∂r_a is the matrix `Case::turning`

  void may_touch_is_false_only_where_nothing_touches() {
    int touching = 0, apart = 0;
    for (int k = 0; k < 2000; ++k) {
      Touching const f = {number.frame(), number.frame()};
      bool const touched = touch(geometry, f), may = geometry.may_touch(f[0], f[1]);
      touching += touched;
      apart += !may;
      EXPECT_TRUE(may || !touched);
      if constexpr (HasReach<G>) {
        EXPECT_TRUE(geometry.reach(f[1]).holds(f[0].r) || !may);
      }
    }
    EXPECT_GT(touching, 20);
    EXPECT_GT(apart, 200);
    for (int k = 0; k < 20; ++k) {
      Touching const near = overlapping(1e-12), far = overlapping(-1.0);
      EXPECT_TRUE(geometry.may_touch(near[0], near[1]));
      EXPECT_FALSE(geometry.may_touch(far[0], far[1]));  // a `may_touch` that is always true fails here
    }
  }  ///< `may_touch` and `reach` include all contacts; `may_touch` excludes shapes with a gap of 1 m

  // --- contact ------------------------------------------------------------------------------------------------

  void action_is_reaction() {
    with_each_contact([&](auto const& contact) {
      Touching const f = overlapping(0.1);
      auto const w = with(contact).template wrenches<double>(f, 0.0);
      double const size = w[0].f.norm();
      EXPECT_GT(size, 1.0);
      EXPECT_LT((w[0].f + w[1].f).norm(), 1e-14 * size);
      Vec3 const moment = w[0].m + f[0].r.cross(w[0].f) + w[1].m + f[1].r.cross(w[1].f);  // about the world's origin
      EXPECT_LT(moment.norm(), 1e-13 * size);
    });
  }  ///< f_a + f_b = 0, and the moments about the world's origin are balanced

  void presses_by_the_law_at_the_depth_and_its_rate() {
    with_each_contact([&](auto const& contact) {
      Touching const f = overlapping(0.1);
      ContactPoint<double> const p = point_of(geometry, f[0], f[1]);
      double const n = contact.normal.force(p.depth, -p.normal.dot(relative(p, f)));
      auto const w = contact.template wrenches<double>(f, 0.0);
      EXPECT_LT((w[0].f - n * p.normal).norm(), 1e-13 * n);
      EXPECT_LT((w[0].m - (p.place - f[0].r).cross(w[0].f)).norm(), 1e-13 * n);
      EXPECT_EQ(contact.potential(f, 0.0), contact.normal.potential(p.depth));
    });
  }  ///< f_a = N(d, ḋ) n acts at the contact point, and the potential U is that of the normal force at d

  void rigid_motion_of_both_turns_the_wrench() {
    with_each_contact([&](auto const& contact) {
      auto const rough = with(contact);
      Touching f = overlapping(0.1), turned = f;
      Mat3 const turn = exp_so3<double>(number.template vec<3>());
      Vec3 const shift = number.template vec<3>(), v = number.template vec<3>(), omega = number.template vec<3>(3.0);
      for (Frame<double>& x : turned) {
        x = carried(x, turn, shift);
        x.v += v + omega.cross(x.r);  // rotation and translation of the world
        x.w += omega;
      }
      auto const before = rough.template wrenches<double>(f, 0.0), after = rough.template wrenches<double>(turned, 0.0);
      double const size = before[0].f.norm();
      EXPECT_GT(size, 1.0);
      for (std::size_t k = 0; k < 2; ++k) {
        EXPECT_LT((after[k].f - turn * before[k].f).norm(), 1e-12 * size);
        EXPECT_LT((after[k].m - turn * before[k].m).norm(), 1e-12 * size);
      }
    });
  }  ///< a rotation and displacement of all frames and twists rotates the wrenches

  void friction_opposes_sliding_and_takes_power() {
    for (double const mu : {0.1, 0.4, 1.3}) {
      Touching const f = overlapping(0.1);
      Elastic const rough = with(elastic(), mu);
      ContactPoint<double> const p = point_of(geometry, f[0], f[1]);
      Vec3 const v = relative(p, f), slip = v - v.dot(p.normal) * p.normal;
      auto const w = rough.template wrenches<double>(f, 0.0), smooth = elastic().template wrenches<double>(f, 0.0);
      Vec3 const tangential = w[0].f - smooth[0].f;
      double const n = smooth[0].f.norm(), speed = slip.norm();
      EXPECT_GT(speed, 0.05);
      EXPECT_LT(std::abs(tangential.dot(p.normal)), 1e-13 * n);
      EXPECT_LT(tangential.norm(), mu * n);
      EXPECT_LT((tangential + mu * n * slip / std::sqrt(speed * speed + 0.3 * 0.3)).norm(), 1e-13 * n);
      // power of both wrenches: elastic power −U̇ and friction power
      double power = 0.0;
      for (std::size_t k = 0; k < 2; ++k) power += w[k].f.dot(f[k].v) + w[k].m.dot(f[k].w);
      auto const stored = [&](double t) { return rough.potential({later(f[0], t), later(f[1], t)}, 0.0); };
      double const taken = power + slope_at_zero(stored, 1e-4);
      EXPECT_LT(taken, 0.0);
      EXPECT_NEAR(taken, tangential.dot(slip), 1e-9 * std::abs(power));
    }
  }  ///< friction force F_t = −μ N v/√(v² + v_s²), with the slip velocity v; all of its power is dissipated

  void damping_takes_power() {
    Contact<G> const damped{.geometry = geometry, .normal = {.stiffness = 900.0, .damping = 7.0}};
    for (int k = 0; k < 5; ++k) {
      Touching const f = overlapping(0.1);
      auto const w = damped.template wrenches<double>(f, 0.0);
      ContactPoint<double> const p = point_of(geometry, f[0], f[1]);
      double const rate = p.normal.dot(relative(p, f));
      double power = 900.0 * p.depth * -rate;  // power stored in the spring
      for (std::size_t i = 0; i < 2; ++i) power += w[i].f.dot(f[i].v) + w[i].m.dot(f[i].w);
      EXPECT_NEAR(power, -7.0 * rate * rate, 1e-11);
    }
  }  ///< the damper dissipates the power c ḋ²

  void force_is_the_slope_of_the_potential() {
    Touching const f = overlapping(0.1);
    Elastic const contact = elastic();
    VecX const w = stacked_wrenches(contact, f, 0.0);
    for (Index j = 0; j < 12; ++j) {
      double const slope = slope_at_zero(
          [&](double h) {
            Touching shifted = f;
            Frame<double>& one = shifted[std::size_t(j / 6)];
            one = moved<double>(one, Vec6(Vec6::Unit(j % 6) * h));
            return contact.potential(shifted, 0.0);
          },
          1e-3);
      EXPECT_NEAR(w[j], -slope, 1e-7 * w.norm());  // error (h/d)⁴/30 = 3e-10 of a force proportional to d^(3/2)
    }
  }  ///< the wrenches are −∂U/∂pose without friction and damping

  void gradient_is_the_derivative_of_the_wrenches() {
    with_each_contact([&](auto const& contact) {
      Touching const f = overlapping(0.1);
      for (auto const& law : {contact, with(contact)}) {
        EXPECT_LT(gradient_mismatch(law, f, 0.0, 1.0, 0.0), 1e-8);
        EXPECT_LT(gradient_mismatch(law, f, 0.0, 0.0, 1.0), 1e-8);
        EXPECT_LT(gradient_mismatch(law, f, 0.0, 0.7, 31.0), 1e-8);
      }
    });
  }  ///< `wrench_gradient` equals ck ∂w/∂pose + cd ∂w/∂twist, computed by differences

  void does_nothing_apart() {
    with_each_contact([&](auto const& contact) {
      for (double const gap : {1e-12, 0.2, 1.0}) {
        Touching const f = overlapping(-gap);
        auto const rough = with(contact);
        EXPECT_EQ(stacked_wrenches(rough, f, 0.0).norm(), 0.0);
        EXPECT_EQ(rough.potential(f, 0.0), 0.0);
        for (auto const& k : own(rough, f, 1.0, 1.0)) EXPECT_EQ(k.norm(), 0.0);
        EXPECT_EQ(wrench_gradient(rough, f, 0.0, 1.0, 1.0).norm(), 0.0);
      }
    });
  }  ///< wrench, potential and stiffness are zero for shapes that do not overlap

  /// The force is zero if the bodies separate so fast that k d + c ḋ < 0.
  void lets_go_of_what_parts_too_fast() {
    Contact<G> const damped = with(Contact<G>{.geometry = geometry, .normal = {.stiffness = 900.0, .damping = 7.0}});
    Touching f = at_rest(0.01);
    f[0].v = 2.0 * point_of(geometry, f[0], f[1]).normal + Vec3(0.3, 0.2, 0.1);
    EXPECT_EQ(stacked_wrenches(damped, f, 0.0).norm(), 0.0);
    for (auto const& k : own(damped, f, 1.0, 1.0)) EXPECT_EQ(k.norm(), 0.0);
    EXPECT_GT(damped.potential(f, 0.0), 0.0);  // the spring is still compressed
  }

  // --- approximate tangent for Newton's method ----------------------------------------------------------------

  void own_stiffness_is_symmetric_and_never_negative() {
    with_each_contact([&](auto const& contact) {
      Touching const f = overlapping(0.1);
      for (auto const& k : own(with(contact), f, 0.7, 31.0)) {
        EXPECT_LT((k - k.transpose()).norm(), 1e-14 * k.norm());
        EXPECT_GT(smallest_eigenvalue(k), -1e-13 * k.norm());
        EXPECT_GT(k.norm(), 1.0);
      }
    });
  }  ///< `own_stiffness` is symmetric, and no eigenvalue is negative

  /// In the derivative of the force on body a with respect to the displacement of body a, `own_stiffness` omits one
  /// term, N ∂n/∂r_a. This term reduces the stiffness of curved shapes.
  void own_stiffness_leaves_out_only_how_the_normal_turns() {
    with_each_contact([&](auto const& contact) {
      Touching const f = at_rest(0.1);
      double const n = contact.normal.force(0.1, 0.0);
      Mat3 const left_out = own(contact, f, 1.0, 0.0)[0].template topLeftCorner<3, 3>() -
                            exact(contact, f, 1.0, 0.0)[0].template topLeftCorner<3, 3>();
      EXPECT_LT((left_out - n * Case::turning(f[0], f[1])).norm(), 1e-12 * n / 0.1);
    });
  }

  /// For moving bodies without friction, `own_stiffness` is exact for changes of the twists and for displacements along
  /// the normal n. A displacement of a along n does not change the direction of n.
  void own_stiffness_has_the_slopes_of_the_normal_force() {
    with_each_contact([&](auto const& contact) {
      Touching const f = overlapping(0.1);
      auto const of_twists = own(contact, f, 0.0, 1.0), exact_of_twists = exact(contact, f, 0.0, 1.0);
      for (std::size_t k = 0; k < 2; ++k)
        EXPECT_LT((of_twists[k] - exact_of_twists[k]).norm(), 1e-12 * (1.0 + exact_of_twists[k].norm()));
      Vec3 const n = point_of(geometry, f[0], f[1]).normal;
      Mat3 const shift = own(contact, f, 1.0, 0.0)[0].template topLeftCorner<3, 3>();
      Mat3 const exact_shift = exact(contact, f, 1.0, 0.0)[0].template topLeftCorner<3, 3>();
      EXPECT_NEAR(n.dot(shift * n), n.dot(exact_shift * n), 1e-12 * shift.norm());
      EXPECT_GT(n.dot(shift * n), 1.0);
    });
  }

  /// At rest `own_stiffness` is exact for changes of the twists, with and without friction. At slip velocity zero, the
  /// secant of the friction force equals its derivative.
  void own_stiffness_is_exact_in_the_twists_of_bodies_at_rest() {
    with_each_contact([&](auto const& contact) {
      for (auto const& law : {contact, with(contact)}) {
        Touching const f = at_rest(0.1);
        auto const stand_in = own(law, f, 0.0, 1.0), given = exact(law, f, 0.0, 1.0);
        for (std::size_t k = 0; k < 2; ++k) EXPECT_LT((stand_in[k] - given[k]).norm(), 1e-12 * (1.0 + given[k].norm()));
      }
    });
  }

  /// `own_stiffness` contains the secant of the friction force. During sliding the secant exceeds the derivative along
  /// the slip velocity u, and equals the derivative across u. The difference from the exact matrix is Jᵀ (μN/s)(u
  /// uᵀ/s²) J with s² = u² + v_s², where J is the Jacobian of u.
  void own_stiffness_of_friction_is_an_upper_bound() {
    for (double const mu : {0.1, 0.4, 1.3}) {
      Touching const f = overlapping(0.1);
      Elastic const rough = with(elastic(), mu);
      ContactPoint<double> const p = point_of(geometry, f[0], f[1]);
      Vec3 const v = relative(p, f), slip = v - v.dot(p.normal) * p.normal;
      double const n = rough.normal.force(p.depth, 0.0), s = std::sqrt(slip.squaredNorm() + 0.3 * 0.3);
      auto const stand_in = own(rough, f, 0.0, 1.0), given = exact(rough, f, 0.0, 1.0);
      for (std::size_t k = 0; k < 2; ++k) {
        Vec6 along;
        along << slip, (p.place - f[k].r).cross(slip);
        Mat<double, 6, 6> const more = mu * n / (s * s * s) * along * along.transpose();
        EXPECT_LT((stand_in[k] - given[k] - more).norm(), 1e-12 * stand_in[k].norm());
        EXPECT_GT(more.norm(), 1e-3 * stand_in[k].norm());
        EXPECT_GT(smallest_eigenvalue(stand_in[k] - given[k]), -1e-13 * stand_in[k].norm());
      }
    }
  }

  static constexpr Law<ContactLaws> laws[] = {
      {"TouchesAtTheDepthItIsGiven", &ContactLaws::touches_at_the_depth_it_is_given},
      {"NormalIsTheSlopeOfTheDepth", &ContactLaws::normal_is_the_slope_of_the_depth},
      {"NormalTurnsAsTheShapesAreCurved", &ContactLaws::normal_turns_as_the_shapes_are_curved},
      {"MayTouchIsFalseOnlyWhereNothingTouches", &ContactLaws::may_touch_is_false_only_where_nothing_touches},
      {"ActionIsReaction", &ContactLaws::action_is_reaction},
      {"PressesByTheLawAtTheDepthAndItsRate", &ContactLaws::presses_by_the_law_at_the_depth_and_its_rate},
      {"RigidMotionOfBothTurnsTheWrench", &ContactLaws::rigid_motion_of_both_turns_the_wrench},
      {"FrictionOpposesSlidingAndTakesPower", &ContactLaws::friction_opposes_sliding_and_takes_power},
      {"DampingTakesPower", &ContactLaws::damping_takes_power},
      {"ForceIsTheSlopeOfThePotential", &ContactLaws::force_is_the_slope_of_the_potential},
      {"GradientIsTheDerivativeOfTheWrenches", &ContactLaws::gradient_is_the_derivative_of_the_wrenches},
      {"DoesNothingApart", &ContactLaws::does_nothing_apart},
      {"LetsGoOfWhatPartsTooFast", &ContactLaws::lets_go_of_what_parts_too_fast},
      {"OwnStiffnessIsSymmetricAndNeverNegative", &ContactLaws::own_stiffness_is_symmetric_and_never_negative},
      {"OwnStiffnessLeavesOutOnlyHowTheNormalTurns", &ContactLaws::own_stiffness_leaves_out_only_how_the_normal_turns},
      {"OwnStiffnessHasTheSlopesOfTheNormalForce", &ContactLaws::own_stiffness_has_the_slopes_of_the_normal_force},
      {"OwnStiffnessIsExactInTheTwistsOfBodiesAtRest",
       &ContactLaws::own_stiffness_is_exact_in_the_twists_of_bodies_at_rest},
      {"OwnStiffnessOfFrictionIsAnUpperBound", &ContactLaws::own_stiffness_of_friction_is_an_upper_bound},
  };
};

}  // namespace polybody::laws
