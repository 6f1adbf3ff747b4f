#include <polybody/forces/springs.hpp>

#include <gtest/gtest.h>

#include <polybody/testing/force_differences.hpp>

#include "support/refusal.hpp"

using namespace polybody;
using namespace polybody::laws;

namespace spring_damper_test {

using Ends = std::array<Frame<double>, 2>;

Ends apart(Vec3 const& d, Vec3 const& rate = Vec3::Zero()) {
  return {{{.r = {1, 2, 3}}, {.r = Vec3(1, 2, 3) + d, .v = rate}}};
}

TEST(SpringDamper, StretchedPullsItsEndsTogether) {
  SpringDamper const spring{.stiffness = 10.0, .free_length = 1.5};
  auto const w = spring.wrenches<double>(apart({2, 0, 0}), 0.0);
  EXPECT_LT((w[0].f - Vec3(5, 0, 0)).norm(), 1e-14);
  EXPECT_LT((w[1].f + Vec3(5, 0, 0)).norm(), 1e-14);
  auto const pressed = spring.wrenches<double>(apart({1, 0, 0}), 0.0);
  EXPECT_LT((pressed[0].f - Vec3(-5, 0, 0)).norm(), 1e-14);
}

TEST(SpringDamper, LengtheningIsResisted) {
  SpringDamper const damper{.stiffness = 0.0, .damping = 4.0, .free_length = 1.0};
  auto const w = damper.wrenches<double>(apart({2, 0, 0}, {0.5, 7, 0}), 0.0);  // no effect of transverse velocity
  EXPECT_LT((w[0].f - Vec3(2, 0, 0)).norm(), 1e-14);
  EXPECT_LT((w[1].f + Vec3(2, 0, 0)).norm(), 1e-14);
}

TEST(SpringDamper, WrenchesAreEqualOppositeAndAlongTheLine) {
  Numbers number;
  for (int k = 0; k < 3; ++k) {
    Ends const ends{number.frame(), number.frame()};
    auto const w = SpringDamper{.stiffness = 10.0, .damping = 3.0, .free_length = 0.4}.wrenches<double>(ends, 0.0);
    EXPECT_EQ(w[0].f, -w[1].f);
    EXPECT_EQ(w[0].m.norm() + w[1].m.norm(), 0.0);
    EXPECT_LT(w[0].f.cross(ends[1].r - ends[0].r).norm(), 1e-13);
    EXPECT_GT(w[0].f.norm(), 1e-3);
  }
}

TEST(SpringDamper, ForceIsTheGradientOfItsPotential) {
  Numbers number;
  for (double const free_length : {0.0, 1.5}) {
    SpringDamper const spring{.stiffness = 10.0, .free_length = free_length};
    Ends const ends{number.frame(), number.frame()};
    VecX const w = stacked_wrenches(spring, ends, 0.0);
    for (Index j = 0; j < 12; ++j) {
      double const slope = slope_at_zero([&](double h) {
        Ends shifted = ends;
        Frame<double>& f = shifted[std::size_t(j / 6)];
        f = moved<double>(f, Vec6(Vec6::Unit(j % 6) * h));
        return spring.potential(shifted, 0.0);
      });
      EXPECT_NEAR(w[j], -slope, 1e-9);
    }
  }
}

TEST(SpringDamper, DamperTakesPowerOut) {
  Numbers number;
  SpringDamper const damper{.stiffness = 0.0, .damping = 4.0, .free_length = 1.0};
  for (int k = 0; k < 5; ++k) {
    Ends const ends{number.frame(), number.frame()};
    auto const w = damper.wrenches<double>(ends, 0.0);
    Vec3 const d = ends[1].r - ends[0].r, rate = ends[1].v - ends[0].v;
    double const stretching = d.dot(rate) / d.norm(), power = w[0].f.dot(ends[0].v) + w[1].f.dot(ends[1].v);
    EXPECT_NEAR(power, -4.0 * stretching * stretching, 1e-13);
    EXPECT_LT(power, 0.0);
  }
}

// l₀ = 0: f = k d is linear in d, so force and tangent are continuous through l = 0.
TEST(SpringDamper, WithoutFreeLengthPassesThroughZeroLengthSmoothly) {
  SpringDamper const spring{.stiffness = 10.0, .free_length = 0.0};
  for (double const x : {0.0, 1e-300, -1e-12, 1e-8, 1e-4}) {
    Ends const close{{{.r = {0, 0, 0}}, {.r = {x, 0, 0}}}};
    EXPECT_EQ(spring.wrenches<double>(close, 0.0)[0].f, Vec3(10.0 * x, 0, 0));
    auto const gradient = wrench_gradient(spring, close, 0.0, 1.0, 0.0);
    EXPECT_LT((gradient.block<3, 3>(0, 6) - 10.0 * Mat3::Identity()).norm(), 1e-14) << x;
  }
}

TEST(SpringDamper, GradientIsTheDerivativeOfTheWrenches) {
  Numbers number;
  for (SpringDamper const& spring :
       {SpringDamper{.stiffness = 10.0, .free_length = 1.5}, SpringDamper{.stiffness = 10.0, .free_length = 0.0},
        SpringDamper{.stiffness = 10.0, .damping = 3.0, .free_length = 1.5},
        SpringDamper{.stiffness = 10.0, .damping = 3.0, .free_length = 0.0}}) {
    Ends const ends{number.frame(), number.frame()};
    EXPECT_LT(gradient_mismatch(spring, ends, 0.0, 1.0, 0.0), 1e-9);
    EXPECT_LT(gradient_mismatch(spring, ends, 0.0, 0.0, 1.0), 1e-9);
    EXPECT_LT(gradient_mismatch(spring, ends, 0.0, 0.7, 31.0), 1e-9);
  }
}

TEST(SpringDamper, RefusesNumbersThatCannotBeMeantByName) {
  double const nan = std::numeric_limits<double>::quiet_NaN();
  for (double const bad : {-1.0, nan, std::numeric_limits<double>::infinity()}) {
    EXPECT_TRUE(has(refusal([&] { SpringDamper{.stiffness = bad, .free_length = 1.0}.check("\"strut\""); }),
                    "\"strut\": the spring stiffness"));
    EXPECT_TRUE(
        has(refusal([&] { SpringDamper{.stiffness = 1.0, .damping = bad, .free_length = 1.0}.check("\"strut\""); }),
            "\"strut\": the damping"));
    EXPECT_TRUE(has(refusal([&] { SpringDamper{.stiffness = 1.0, .free_length = bad}.check("\"strut\""); }),
                    "\"strut\": the free length"));
  }
}

}  // namespace spring_damper_test
