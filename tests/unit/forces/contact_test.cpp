#include <polybody/forces/contact.hpp>

#include <gtest/gtest.h>

#include <polybody/testing/contact_laws.hpp>

#include "support/refusal.hpp"

using namespace polybody;
using namespace polybody::laws;

namespace contact_test {

struct SphereOnPlaneCase {
  static constexpr double radius = 0.6;
  static SphereOnPlane geometry() { return {.radius = radius}; }
  static Vec3 centre(Numbers& number, Frame<double> const& b, double depth) {
    return b.r + b.A * Vec3(number(), number(), radius - depth);
  }
  static Mat3 turning(Frame<double> const&, Frame<double> const&) { return Mat3::Zero(); }
};

// n = d/|d|: ∂n/∂r_a = (1 − n nᵀ)/|d|.
struct SphereOnSphereCase {
  static constexpr double radius = 0.6, other = 0.9;
  static SphereOnSphere geometry() { return {.radius_a = radius, .radius_b = other}; }
  static Vec3 centre(Numbers& number, Frame<double> const& b, double depth) {
    return b.r + (radius + other - depth) * number.vec<3>().normalized();
  }
  static Mat3 turning(Frame<double> const& a, Frame<double> const& b) {
    Vec3 const d = a.r - b.r, n = d.normalized();
    return (Mat3::Identity() - n * n.transpose()) / d.norm();
  }
};

// Planar version, in the plane normal to the axis z.
struct SphereOnCylinderCase {
  static constexpr double radius = 0.3, cylinder = 0.7;
  static SphereOnCylinder geometry() { return {.radius = radius, .cylinder = cylinder}; }
  static Vec3 centre(Numbers& number, Frame<double> const& b, double depth) {
    double const angle = number(3.0), distance = radius + cylinder - depth;
    return b.r + b.A * Vec3(distance * std::cos(angle), distance * std::sin(angle), number(2.0));
  }
  static Mat3 turning(Frame<double> const& a, Frame<double> const& b) {
    Vec3 const z = b.A.col(2), d = (a.r - b.r) - (a.r - b.r).dot(z) * z, t = z.cross(d.normalized());
    return t * t.transpose() / d.norm();
  }
};

bool const obeyed[] = {obeys<SphereOnPlaneCase, ContactLaws>("SphereOnPlane"),
                       obeys<SphereOnSphereCase, ContactLaws>("SphereOnSphere"),
                       obeys<SphereOnCylinderCase, ContactLaws>("SphereOnCylinder")};

// --- values computed by hand ----------------------------------------------------------------------------------

// A ball of radius 0.5 penetrates a floor of 1000 N/m by 0.1 and slides along x at 3 m/s with v_s = 4 m/s. The normal
// force is 100 N. The friction force is 0.5 · 100 N · 3/5 against the velocity. It also rotates the ball forwards,
// with the radius as its moment arm.
TEST(SphereOnPlane, SlidingBallIsLiftedBrakedAndTurned) {
  Contact<SphereOnPlane> const law{.geometry = {.radius = 0.5},
                                   .normal = {.stiffness = 1000.0},
                                   .friction = {.coefficient = 0.5, .slip_speed = 4.0}};
  Touching const f{{{.r = {2, 1, 0.4}, .v = {3, 0, 0}}, {}}};
  auto const w = law.wrenches<double>(f, 0.0);
  EXPECT_LT((w[0].f - Vec3(-30, 0, 100)).norm(), 1e-12);
  EXPECT_LT((w[0].m - Vec3(0, 15, 0)).norm(), 1e-12);
  EXPECT_LT((w[1].m - Vec3(2, 1, -0.1).cross(Vec3(30, 0, -100))).norm(), 1e-12);
  // rolling: ω × ρ = −v
  Touching const rolling{{{.r = {2, 1, 0.4}, .v = {3, 0, 0}, .w = {0, 6, 0}}, {}}};
  EXPECT_LT((law.wrenches<double>(rolling, 0.0)[0].f - Vec3(0, 0, 100)).norm(), 1e-12);
}

// Flat contact at rest without friction: the ball's own block is completely exact.
TEST(SphereOnPlane, OwnStiffnessOfTheBallIsExactWithoutFriction) {
  Numbers number;
  ContactLaws<SphereOnPlaneCase> laws;
  Touching const f = laws.at_rest(0.1);
  Contact<SphereOnPlane> const law{.geometry = SphereOnPlaneCase::geometry(),
                                   .normal = {.stiffness = 900.0, .damping = 7.0}};
  auto const own = laws.own(law, f, 0.7, 31.0)[0], exact = laws.exact(law, f, 0.7, 31.0)[0];
  EXPECT_LT((own - exact).norm(), 1e-13 * exact.norm());
  Vec3 const n = f[1].A.col(2);
  EXPECT_LT((own.topLeftCorner<3, 3>() - (0.7 * 900.0 + 31.0 * 7.0) * n * n.transpose()).norm(), 1e-12 * own.norm());
}

// The inside of the plane is the side of negative z, at any depth.
TEST(SphereOnPlane, PushesOutOfTheFarSideToo) {
  SphereOnPlane const plane{.radius = 0.5};
  EXPECT_DOUBLE_EQ(point_of(plane, Frame<double>{.r = {0, 0, -2}}, Frame<double>{}).depth, 2.5);
}

// The overlap on the connecting line is from 1.0 − 0.6 to 0.5. The contact point is in its middle.
TEST(SphereOnSphere, TouchInTheMiddleOfTheOverlap) {
  SphereOnSphere const balls{.radius_a = 0.6, .radius_b = 0.5};
  ContactPoint<double> const p = point_of(balls, Frame<double>{.r = {0, 3, 0}}, Frame<double>{.r = {0, 2, 0}});
  EXPECT_LT((p.place - Vec3(0, 2.45, 0)).norm(), 1e-15);
  EXPECT_EQ(p.normal, Vec3(0, 1, 0));
  EXPECT_NEAR(p.depth, 0.1, 1e-15);
}
TEST(SphereOnSphere, ConcentricOnesHaveNoNormalAndDoNotTouch) {
  Contact<SphereOnSphere> const law{.geometry = {.radius_a = 0.5, .radius_b = 0.2}, .normal = {.stiffness = 10.0}};
  Touching const f{};
  EXPECT_EQ(stacked_wrenches(law, f, 0.0).norm(), 0.0);
  EXPECT_EQ(wrench_gradient(law, f, 0.0, 1.0, 1.0).norm(), 0.0);
}
TEST(SphereOnCylinder, SphereOnTheAxisHasNoNormalAndDoesNotTouch) {
  Contact<SphereOnCylinder> const law{.geometry = {.radius = 0.5, .cylinder = 0.2}, .normal = {.stiffness = 10.0}};
  Touching const f{{{.r = {0, 0, 3}}, {}}};
  EXPECT_EQ(stacked_wrenches(law, f, 0.0).norm(), 0.0);
  EXPECT_EQ(wrench_gradient(law, f, 0.0, 1.0, 1.0).norm(), 0.0);
}

// A point of radius zero is treated like a sphere.
TEST(SphereOnCylinder, TakesPointsOfABelt) {
  SphereOnCylinder const drum{.radius = 0.0, .cylinder = 2.0};
  ContactPoint<double> const p = point_of(drum, Frame<double>{.r = {0, 1.9, 7}}, Frame<double>{});
  EXPECT_NEAR(p.depth, 0.1, 1e-15);
  EXPECT_EQ(p.place, Vec3(0, 1.9, 7));
  EXPECT_EQ(p.normal, Vec3(0, 1, 0));
}

// --- bad input ------------------------------------------------------------------------------------------------

TEST(Contacts, RefuseNumbersThatCannotBeMeantByName) {
  double const nan = std::numeric_limits<double>::quiet_NaN();
  auto const told = [](auto const& law) { return refusal([&] { law.check("\"wheel\""); }); };
  SpringDamperContact const spring{.stiffness = 1.0};
  for (double const bad : {-1.0, nan, std::numeric_limits<double>::infinity()}) {
    EXPECT_TRUE(has(told(SphereOnPlane{.radius = bad}), "\"wheel\": the sphere's radius must be zero or positive"));
    EXPECT_TRUE(
        has(told(SphereOnSphere{.radius_a = bad, .radius_b = 1.0}), "\"wheel\": the radius of the first sphere"));
    EXPECT_TRUE(
        has(told(SphereOnSphere{.radius_a = 1.0, .radius_b = bad}), "\"wheel\": the radius of the second sphere"));
    EXPECT_TRUE(has(told(SphereOnCylinder{.radius = bad, .cylinder = 1.0}), "\"wheel\": the sphere's radius"));
    EXPECT_TRUE(has(told(SphereOnCylinder{.radius = 0.0, .cylinder = bad}),
                    "\"wheel\": the cylinder's radius must be positive"));
    // a contact checks all its parts
    EXPECT_TRUE(has(told(Contact<SphereOnPlane>{{.radius = bad}, spring}), "\"wheel\": the sphere's radius"));
    EXPECT_TRUE(
        has(told(Contact<SphereOnPlane>{{.radius = 1.0}, {.stiffness = bad}}), "\"wheel\": the contact stiffness"));
    EXPECT_TRUE(has(told(Contact<SphereOnPlane>{{.radius = 1.0}, spring, {.coefficient = bad, .slip_speed = 1.0}}),
                    "\"wheel\": the coefficient of friction"));
    EXPECT_TRUE(has(told(Contact<SphereOnPlane>{{.radius = 1.0}, spring, {.coefficient = 0.3, .slip_speed = bad}}),
                    "\"wheel\": the slip speed of the friction must be positive"));
  }
  EXPECT_TRUE(
      has(told(Contact<SphereOnPlane>{{.radius = 1.0}, spring, {.coefficient = 0.3}}), "\"wheel\": the slip speed"));
  EXPECT_NO_THROW(
      (Contact<SphereOnPlane>{{.radius = 0.0}, spring}.check("\"wheel\"")));  // without friction it has no slip speed
}

// --- the concepts ---------------------------------------------------------------------------------------------

struct WithoutBound {
  static constexpr MarkerKind needs = MarkerKind::point;
  void check(std::string const&) const {}
  template <StateScalar T, class Visit>
  void for_each_point(Frame<T> const&, Frame<T> const&, Visit&&) const {}
};
static_assert(!ContactGeometry<WithoutBound> && ContactGeometry<SphereOnCylinder>);
static_assert(ForceElement<Contact<SphereOnCylinder, HertzContact>>);
static_assert(HasPotential<Contact<SphereOnCylinder, HuntCrossleyContact>>);

}  // namespace contact_test
