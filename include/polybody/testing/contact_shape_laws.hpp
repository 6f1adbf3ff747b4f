#pragma once
/// \file
/// Tests of properties that contact geometries with several contact points have: `ContactShapeLaws`.
///
/// Requires GoogleTest.

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <set>

#include <polybody/testing/contact_probe.hpp>
#include <polybody/testing/force_differences.hpp>
#include <polybody/testing/laws.hpp>

namespace polybody::laws {

/// Laws of contact geometries with any number of contact points. `ContactLaws` requires exactly one point, on the line
/// through the centre of a sphere. Example of a case:
///
///     struct CapsuleOnPlaneCase {
///       static CapsuleOnPlane geometry();
///       static constexpr bool plane = true;                       // body b is the half space below its plane
///       static double outside_a(Vec3 const& p);                   // distance from shape a [m], p in axes of marker a
///       static double outside_b(Vec3 const& p);                   // distance from shape b [m], p in axes of marker b
///       static std::vector<Touching> starts();                    // poses in which faces or axes are parallel
///     };
///     bool const capsule_obeys = obeys<CapsuleOnPlaneCase, ContactShapeLaws>("CapsuleOnPlane");
template <class Case>
struct ContactShapeLaws {
  static constexpr char const* suite = "ContactShapeLaws";
  using G = decltype(Case::geometry());  ///< type of the geometry
  using Contacts = Contact<G>;           ///< contact with spring and damper
  G const geometry = Case::geometry();   ///< geometry under test
  Numbers number;                        ///< random numbers with a fixed seed

  /// Contact with a friction `coefficient` and with `damping` [N s/m].
  Contacts law(double coefficient = 0.0, double damping = 0.0) const {
    return {.geometry = geometry,
            .normal = {.stiffness = 900.0, .damping = damping},
            .friction = {.coefficient = coefficient, .slip_speed = 0.3}};
  }
  std::vector<ContactPoint<double>> points(Touching const& f) const {
    std::vector<ContactPoint<double>> all;
    geometry.template for_each_point<double>(f[0], f[1], [&](ContactPoint<double> const& p) { all.push_back(p); });
    return all;
  }  ///< contact points for the frames f
  double deepest(Touching const& f) const {
    double most = 0.0;
    for (auto const& p : points(f)) most = std::max(most, p.depth);
    return most;
  }  ///< largest depth for the frames f [m]; zero without contact
  /// Moves a along a direction away from b until the largest depth is `depth` [m], by bisection.
  Touching at_depth(Touching f, double depth) {
    Vec3 const away = Case::plane ? Vec3(f[1].A.col(2)) : Vec3(number.template vec<3>().normalized());
    double near = Case::plane ? -5.0 : 0.0, far = 5.0;
    for (int k = 0; k < 60; ++k) {
      double const middle = 0.5 * (near + far);
      f[0].r = f[1].r + middle * away;
      (deepest(f) > depth ? near : far) = middle;
    }
    f[0].r = f[1].r + near * away;
    return f;
  }
  Touching touching(double depth) {
    return at_depth({number.frame(), number.frame()}, depth);
  }  ///< random frames and twists with the largest depth `depth` [m]

  // --- geometry -----------------------------------------------------------------------------------------------

  void points_lie_in_both_shapes() {
    for (int k = 0; k < 40; ++k) {
      Touching const f = touching(0.02);
      std::set<int> slots;
      for (auto const& p : points(f)) {
        EXPECT_NEAR(p.normal.norm(), 1.0, 1e-14);
        EXPECT_GT(p.depth, 0.0);
        EXPECT_LT(Case::outside_a(f[0].A.transpose() * (p.place - f[0].r)), 1e-12);
        EXPECT_LT(Case::outside_b(f[1].A.transpose() * (p.place - f[1].r)), 1e-12);
        // at a displacement by the depth along the normal, the point leaves one of the shapes
        double const beyond_b = Case::outside_b(f[1].A.transpose() * (p.place + 1.01 * p.depth * p.normal - f[1].r)),
                     beyond_a = Case::outside_a(f[0].A.transpose() * (p.place - 1.01 * p.depth * p.normal - f[0].r));
        EXPECT_GT(std::max(beyond_a, beyond_b), 0.0);
        EXPECT_TRUE(p.slot >= 0 && p.slot < most_points<G>());
        EXPECT_TRUE(slots.insert(p.slot).second);
      }
      EXPECT_FALSE(slots.empty());
    }
  }  ///< points lie in both shapes and leave a shape along the normal; their slots are different

  /// Change of each depth for all motions of a and b, by dual numbers: −n · displacement of a relative to b at the
  /// contact point.
  void normals_are_the_slopes_of_the_depths() {
    for (int k = 0; k < 20; ++k) {
      Touching const f = touching(0.02);
      using D = Dual<12>;
      Vec<D, 6> of_a, of_b;
      for (int i = 0; i < 6; ++i) {
        of_a[i] = D::variable(0.0, i);
        of_b[i] = D::variable(0.0, 6 + i);
      }
      auto const expected = points(f);
      std::size_t found = 0;
      geometry.template for_each_point<D>(moved<D>(f[0], of_a), moved<D>(f[1], of_b), [&](ContactPoint<D> const& q) {
        ASSERT_LT(found, expected.size());
        ContactPoint<double> const& p = expected[found++];
        EXPECT_EQ(q.slot, p.slot);
        EXPECT_NEAR(q.depth.v, p.depth, 1e-14);
        Vec<double, 12> slope;
        slope << -p.normal, -(p.place - f[0].r).cross(p.normal), p.normal, (p.place - f[1].r).cross(p.normal);
        EXPECT_LT((q.depth.d.matrix() - slope).norm(), 1e-11);
      });
      EXPECT_EQ(found, expected.size());
    }
  }

  void may_touch_is_false_only_where_nothing_touches() {
    int touched = 0, apart = 0;
    for (int k = 0; k < 3000; ++k) {
      Touching const f = {number.frame(), number.frame()};
      bool const touches = !points(f).empty(), may = geometry.may_touch(f[0], f[1]);
      touched += touches;
      apart += !may;
      EXPECT_TRUE(may || !touches);
      if constexpr (HasReach<G>) {
        EXPECT_TRUE(geometry.reach(f[1]).holds(f[0].r) || !may);
      }
    }
    EXPECT_GT(touched, 10);
    EXPECT_GT(apart, 200);
    for (int k = 0; k < 20; ++k) {
      Touching const near = touching(1e-9);
      EXPECT_TRUE(geometry.may_touch(near[0], near[1]));
      if constexpr (HasReach<G>) {
        EXPECT_TRUE(geometry.reach(near[1]).holds(near[0].r));
      }
    }
  }  ///< `may_touch` and `reach` include all contacts

  // --- contact ------------------------------------------------------------------------------------------------

  void action_is_reaction() {
    for (int k = 0; k < 10; ++k) {
      Touching const f = touching(0.02);
      auto const w = law(0.4, 3.0).template wrenches<double>(f, 0.0);
      EXPECT_LT((w[0].f + w[1].f).norm(), 1e-13 * (1.0 + w[0].f.norm()));
      Vec3 const moment = w[0].m + f[0].r.cross(w[0].f) + w[1].m + f[1].r.cross(w[1].f);
      EXPECT_LT(moment.norm(), 1e-12 * (1.0 + w[0].f.norm()));
    }
  }  ///< forces and moments of both bodies are balanced

  void rigid_motion_of_both_turns_the_wrench() {
    Touching const f = touching(0.02);
    Mat3 const turn = exp_so3<double>(number.template vec<3>());
    Vec3 const shift = number.template vec<3>();
    Touching const turned{carried(f[0], turn, shift), carried(f[1], turn, shift)};
    auto const before = law(0.4, 3.0).template wrenches<double>(f, 0.0),
               after = law(0.4, 3.0).template wrenches<double>(turned, 0.0);
    EXPECT_GT(before[0].f.norm(), 1e-3);
    for (std::size_t k = 0; k < 2; ++k) {
      EXPECT_LT((after[k].f - turn * before[k].f).norm(), 1e-9 * before[0].f.norm());
      EXPECT_LT((after[k].m - turn * before[k].m).norm(), 1e-9 * before[0].f.norm());
    }
  }  ///< a rotation and displacement of all frames rotates the wrenches

  void force_is_the_slope_of_the_potential() {
    for (int k = 0; k < 10; ++k) {
      Touching f = touching(0.02);
      auto const w = law().template wrenches<double>(f, 0.0);
      double power = 0.0;
      for (std::size_t i = 0; i < 2; ++i) power += w[i].f.dot(f[i].v) + w[i].m.dot(f[i].w);
      double const rate =
          slope_at_zero([&](double t) { return law().potential(Touching{later(f[0], t), later(f[1], t)}, 0.0); }, 1e-6);
      EXPECT_NEAR(power, -rate, 1e-6 * w[0].f.norm());
    }
  }  ///< the power of the force is the rate at which the potential decreases

  void gradient_is_the_derivative_of_the_wrenches() {
    for (int k = 0; k < 10; ++k) {
      Touching const f = touching(0.02);
      Contacts const rough = law(0.4, 3.0);
      for (auto const& by : {Vec2(1.0, 0.0), Vec2(0.0, 1.0)}) {
        auto const exact = wrench_gradient(rough, f, 0.0, by[0], by[1]);
        Mat<double, 12, 12> rows;
        for (Index j = 0; j < 12; ++j)
          rows.col(j) = slope_at_zero(
              [&](double h) { return stacked_wrenches(rough, shifted(f, j, by[0], by[1], h), 0.0); }, 1e-7);
        EXPECT_LT((exact - rows).cwiseAbs().maxCoeff(), 2e-5 * (1.0 + rows.cwiseAbs().maxCoeff()));
      }
    }
  }  ///< `wrench_gradient` equals the derivative by differences

  void does_nothing_apart() {
    for (double const gap : {1e-9, 0.2, 1.0}) {
      Touching f = touching(1e-12);
      f[0].r += gap * (Case::plane ? Vec3(f[1].A.col(2)) : Vec3((f[0].r - f[1].r).normalized()));
      EXPECT_EQ(stacked_wrenches(law(0.4, 3.0), f, 0.0).norm(), 0.0);
      EXPECT_EQ(law().potential(f, 0.0), 0.0);
    }
  }  ///< wrench and potential are zero for shapes that do not overlap

  void friction_and_damping_take_power() {
    for (int k = 0; k < 20; ++k) {
      Touching const f = touching(0.02);
      auto const power = [&](Contacts const& contact) {
        auto const w = contact.template wrenches<double>(f, 0.0);
        double sum = 0.0;
        for (std::size_t i = 0; i < 2; ++i) sum += w[i].f.dot(f[i].v) + w[i].m.dot(f[i].w);
        return sum;
      };
      EXPECT_LE(power(law(0.4)), power(law()));
      EXPECT_LE(power(law(0.0, 3.0)), power(law()) + 1e-12);
    }
  }  ///< friction and damping reduce the power of the contact

  void own_stiffness_is_symmetric_and_never_negative() {
    for (int k = 0; k < 10; ++k) {
      Touching const f = touching(0.02);
      std::array<Mat<double, 6, 6>, 2> own{Mat<double, 6, 6>::Zero(), Mat<double, 6, 6>::Zero()};
      law(0.4, 3.0).own_stiffness(f, 0.7, 31.0, own[0], own[1]);
      for (auto const& m : own) {
        EXPECT_LT((m - m.transpose()).norm(), 1e-13 * m.norm());
        Eigen::SelfAdjointEigenSolver<Mat<double, 6, 6>> const solver(m);
        EXPECT_GT(solver.eigenvalues()[0], -1e-12 * m.norm());
      }
    }
  }  ///< `own_stiffness` is symmetric, and no eigenvalue is negative

  // --- continuity ---------------------------------------------------------------------------------------------

  /// Largest change of the wrenches between successive positions on a path, divided by the number of positions per
  /// second. \param twist motion of a relative to `start` in one second
  double largest_jump(Touching const& start, Vec6 const& twist, int positions) const {
    double most = 0.0;
    VecX last;
    for (int k = 0; k <= positions; ++k) {
      double const t = double(k) / positions - 0.5;
      VecX const w = stacked_wrenches(law(), Touching{moved<double>(start[0], twist * t), start[1]}, 0.0);
      if (k > 0) most = std::max(most, (w - last).norm());
      last = w;
    }
    return most;
  }
  /// On paths through the poses of the case, the change of the wrenches from position to position is proportional to
  /// the distance of the positions. A jump would not become smaller.
  void force_is_continuous() {
    for (Touching const& start : Case::starts())
      for (int k = 0; k < 6; ++k) {
        Vec6 twist = number.template vec<6>(0.02);
        twist.tail<3>() *= 5.0;
        double const coarse = largest_jump(start, twist, 400), fine = largest_jump(start, twist, 16 * 400);
        EXPECT_GT(coarse, 1e-6);
        EXPECT_LT(fine, 0.3 * coarse) << coarse;
      }
  }

  static constexpr laws::Law<ContactShapeLaws> laws[] = {
      {"PointsLieInBothShapes", &ContactShapeLaws::points_lie_in_both_shapes},
      {"NormalsAreTheSlopesOfTheDepths", &ContactShapeLaws::normals_are_the_slopes_of_the_depths},
      {"MayTouchIsFalseOnlyWhereNothingTouches", &ContactShapeLaws::may_touch_is_false_only_where_nothing_touches},
      {"ActionIsReaction", &ContactShapeLaws::action_is_reaction},
      {"RigidMotionOfBothTurnsTheWrench", &ContactShapeLaws::rigid_motion_of_both_turns_the_wrench},
      {"ForceIsTheSlopeOfThePotential", &ContactShapeLaws::force_is_the_slope_of_the_potential},
      {"GradientIsTheDerivativeOfTheWrenches", &ContactShapeLaws::gradient_is_the_derivative_of_the_wrenches},
      {"DoesNothingApart", &ContactShapeLaws::does_nothing_apart},
      {"FrictionAndDampingTakePower", &ContactShapeLaws::friction_and_damping_take_power},
      {"OwnStiffnessIsSymmetricAndNeverNegative", &ContactShapeLaws::own_stiffness_is_symmetric_and_never_negative},
      {"ForceIsContinuous", &ContactShapeLaws::force_is_continuous},
  };
};

}  // namespace polybody::laws
