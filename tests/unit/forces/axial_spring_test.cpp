#include <polybody/forces/springs.hpp>

#include <gtest/gtest.h>

#include <polybody/testing/force_differences.hpp>

#include "support/refusal.hpp"

using namespace polybody;
using namespace polybody::laws;

namespace axial_spring_test {

using Ends = std::array<Frame<double>, 2>;

/// Marker b is at (s, 0.3, −0.2) from marker a in a's axes and moves at `rate` relative to them. Marker a itself
/// rotates and moves.
Ends sliding(double s, Vec3 const& rate) {
  Mat3 const axes = exp_so3<double>(Vec3(0.3, -0.8, 0.5));
  Frame<double> const a{.r = {1, 2, 3}, .A = axes, .v = {0.4, -0.2, 0.9}, .w = {0.7, 1.1, -0.6}};
  Vec3 const d = axes * Vec3(s, 0.3, -0.2);
  return {{a, {.r = a.r + d, .v = a.v + a.w.cross(d) + axes * rate}}};
}

TEST(AxialSpring, PushesAlongTheAxisOfItsFirstBody) {
  AxialSpring const spring{.stiffness = 10.0, .preload = 3.0};
  for (double const s : {0.0, 0.2, -0.5}) {
    Ends const ends = sliding(s, Vec3::Zero());
    Vec3 const x = ends[0].A.col(0);
    auto const w = spring.wrenches<double>(ends, 0.0);
    EXPECT_LT((w[1].f + x * (10.0 * s + 3.0)).norm(), 1e-14) << s;
    EXPECT_LT((w[0].f - x * (10.0 * s + 3.0)).norm(), 1e-14) << s;
  }
}

// Transverse motion of b and rotation of a do not contribute to the rate of s.
TEST(AxialSpring, DampsOnlyTheSlide) {
  AxialSpring const damper{.stiffness = 0.0, .damping = 4.0};
  Ends const ends = sliding(0.7, Vec3(0.5, 7.0, -3.0));
  auto const w = damper.wrenches<double>(ends, 0.0);
  EXPECT_LT((w[1].f + ends[0].A.col(0) * 2.0).norm(), 1e-13);
}

TEST(AxialSpring, MayActAlongAnyAxis) {
  Vec3 const axis = Vec3(1, -2, 2) / 3.0;
  AxialSpring const spring{.stiffness = 10.0, .damping = 4.0, .preload = 3.0, .axis = axis};
  Ends const ends = sliding(0.2, Vec3(0.5, 7.0, -3.0));
  double const s = axis.dot(Vec3(0.2, 0.3, -0.2)), rate = axis.dot(Vec3(0.5, 7.0, -3.0));
  EXPECT_LT((spring.wrenches<double>(ends, 0.0)[1].f + ends[0].A * axis * (10.0 * s + 4.0 * rate + 3.0)).norm(), 1e-13);
}

// f_a + f_b = 0 and m_a + r_a × f_a + m_b + r_b × f_b = 0.
TEST(AxialSpring, WrenchesBalanceAboutTheOrigin) {
  Numbers number;
  for (int k = 0; k < 5; ++k) {
    Ends const ends{number.frame(), number.frame()};
    auto const w = AxialSpring{.stiffness = 10.0, .damping = 3.0, .preload = -2.0}.wrenches<double>(ends, 0.0);
    EXPECT_EQ(w[0].f, -w[1].f);
    EXPECT_LT((w[0].m + ends[0].r.cross(w[0].f) + w[1].m + ends[1].r.cross(w[1].f)).norm(), 1e-12);
    EXPECT_EQ(w[1].m.norm(), 0.0);
    EXPECT_GT(w[0].m.norm(), 1e-3);
  }
}

TEST(AxialSpring, WrenchIsTheGradientOfItsPotential) {
  Numbers number;
  AxialSpring const spring{.stiffness = 10.0, .preload = 3.0, .axis = Vec3(1, -2, 2) / 3.0};
  for (int k = 0; k < 3; ++k) {
    Ends const ends{number.frame(), number.frame()};
    VecX const w = stacked_wrenches(spring, ends, 0.0);
    for (Index j = 0; j < 12; ++j) {
      double const slope = slope_at_zero([&](double h) {
        Ends shifted = ends;
        Frame<double>& f = shifted[std::size_t(j / 6)];
        f = moved<double>(f, Vec6(Vec6::Unit(j % 6) * h));
        return spring.potential(shifted, 0.0);
      });
      EXPECT_NEAR(w[j], -slope, 1e-9) << j;
    }
  }
}

// P = f_a·v_a + m_a·ω_a + f_b·v_b = −c ṡ², with ṡ by differences.
TEST(AxialSpring, DamperTakesPowerOut) {
  Numbers number;
  AxialSpring const damper{.stiffness = 0.0, .damping = 4.0};
  for (int k = 0; k < 5; ++k) {
    Ends const ends{number.frame(), number.frame()};
    auto const w = damper.wrenches<double>(ends, 0.0);
    double const rate = slope_at_zero([&](double h) {
      Frame<double> const a = later<double>(ends[0], h), b = later<double>(ends[1], h);
      return a.A.col(0).dot(b.r - a.r);
    });
    double const power = w[0].f.dot(ends[0].v) + w[0].m.dot(ends[0].w) + w[1].f.dot(ends[1].v) + w[1].m.dot(ends[1].w);
    EXPECT_NEAR(power, -4.0 * rate * rate, 1e-9);
    EXPECT_LT(power, 0.0);
  }
}

TEST(AxialSpring, GradientIsTheDerivativeOfTheWrenches) {
  Numbers number;
  for (AxialSpring const& spring :
       {AxialSpring{.stiffness = 10.0}, AxialSpring{.stiffness = 10.0, .preload = 3.0},
        AxialSpring{.stiffness = 0.0, .damping = 3.0},
        AxialSpring{.stiffness = 10.0, .damping = 3.0, .preload = 3.0, .axis = Vec3(1, -2, 2) / 3.0}}) {
    Ends const ends{number.frame(), number.frame()};
    EXPECT_LT(gradient_mismatch(spring, ends, 0.0, 1.0, 0.0), 1e-9);
    EXPECT_LT(gradient_mismatch(spring, ends, 0.0, 0.0, 1.0), 1e-9);
    EXPECT_LT(gradient_mismatch(spring, ends, 0.0, 0.7, 31.0), 1e-9);
  }
}

TEST(AxialSpring, RefusesNumbersThatCannotBeMeantByName) {
  double const nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
  for (double const bad : {-1.0, nan, infinity}) {
    EXPECT_TRUE(has(refusal([&] { AxialSpring{.stiffness = bad}.check("\"tensioner\""); }),
                    "\"tensioner\": the spring stiffness"));
    EXPECT_TRUE(has(refusal([&] { AxialSpring{.stiffness = 1.0, .damping = bad}.check("\"tensioner\""); }),
                    "\"tensioner\": the damping"));
  }
  for (double const bad : {nan, -infinity})
    EXPECT_TRUE(has(refusal([&] { AxialSpring{.stiffness = 1.0, .preload = bad}.check("\"tensioner\""); }),
                    "\"tensioner\": the preload must be finite"));
  for (Vec3 const& bad : {Vec3(0, 0, 0), Vec3(1, 1, 0), Vec3(nan, 0, 0)})
    EXPECT_TRUE(has(refusal([&] { AxialSpring{.stiffness = 1.0, .axis = bad}.check("\"tensioner\""); }),
                    "\"tensioner\": the axis"));
  EXPECT_NO_THROW((AxialSpring{.stiffness = 0.0, .damping = 0.0, .preload = -5.0}.check("\"tensioner\"")));
}

}  // namespace axial_spring_test
