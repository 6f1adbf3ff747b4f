#include <polybody/math/smooth_table.hpp>

#include <gtest/gtest.h>

#include <polybody/testing/differences.hpp>

#include "support/refusal.hpp"

using namespace polybody;
using namespace polybody::laws;

namespace smooth_table_test {

double cubic(double t) { return 1.0 + t * (2.0 + t * (-3.0 + t * 0.5)); }
double cubic_rate(double t) { return 2.0 + t * (-6.0 + t * 1.5); }

SmoothTable const bumpy({{0.0, 1.0}, {0.7, -2.0}, {1.0, 0.5}, {2.5, 0.0}});

// A clamped spline reproduces every cubic [de Boor 1978, ch. IV], for any points.
TEST(SmoothTable, ReproducesACubicByItsEnds) {
  std::vector<SmoothTable::Point> points;
  for (double const t : {-1.0, 0.2, 0.5, 2.0, 3.0}) points.push_back({t, cubic(t)});
  SmoothTable const table(points, {.first_rate = cubic_rate(-1.0), .last_rate = cubic_rate(3.0)});
  auto const integral = [](double t) { return t + t * t - t * t * t + t * t * t * t / 8.0; };
  for (double const t : {-1.0, -0.3, 0.2, 0.4, 1.7, 2.999}) {
    EXPECT_NEAR(table(t).value, cubic(t), 1e-13) << t;
    EXPECT_NEAR(table(t).rate, cubic_rate(t), 1e-13) << t;
    EXPECT_NEAR(table(t).acceleration, -6.0 + 3.0 * t, 1e-12) << t;
    EXPECT_NEAR(table.integral(t), integral(t) - integral(-1.0), 1e-13) << t;
  }
}

// Natural spline by hand through (0, 0), (1, 1), (2, 0): 2 (1 + 1) m₁ = 6 (−1 − 1), so m₁ = −3. The rate is 0 at the
// middle by symmetry and 1.5 at the start; the value half-way is 11/16.
TEST(SmoothTable, IsNaturalUnlessToldOtherwise) {
  SmoothTable const hat({{0.0, 0.0}, {1.0, 1.0}, {2.0, 0.0}});
  EXPECT_DOUBLE_EQ(hat(1.0).acceleration, -3.0);
  EXPECT_NEAR(hat(1.0).rate, 0.0, 1e-15);
  EXPECT_DOUBLE_EQ(hat(0.0).rate, 1.5);
  EXPECT_DOUBLE_EQ(hat(0.5).value, 0.6875);
  EXPECT_EQ(hat(0.0).acceleration, 0.0);
  EXPECT_EQ(hat(2.0).acceleration, 0.0);
}

TEST(SmoothTable, MeetsItsPointsWithoutAJumpUpToTheAcceleration) {
  for (auto const& [t, value] : {std::pair{0.0, 1.0}, {0.7, -2.0}, {1.0, 0.5}, {2.5, 0.0}}) {
    EXPECT_NEAR(bumpy(t).value, value, 1e-14);
    Motion const before = bumpy(std::nextafter(t, -1e9)), at = bumpy(t);
    EXPECT_NEAR(before.value, at.value, 1e-13) << t;
    EXPECT_NEAR(before.rate, at.rate, 1e-12) << t;
    EXPECT_NEAR(before.acceleration, at.acceleration, 1e-11) << t;
  }
  EXPECT_TRUE(bumpy.breakpoints().empty());
}

TEST(SmoothTable, RateAccelerationAndIntegralBelongToTheValue) {
  for (double const t : {-1.0, 0.3, 0.8, 1.9, 4.0}) {
    EXPECT_NEAR(slope_at_zero([&](double h) { return bumpy(t + h).value; }), bumpy(t).rate, 1e-10) << t;
    EXPECT_NEAR(slope_at_zero([&](double h) { return bumpy(t + h).rate; }), bumpy(t).acceleration, 1e-9) << t;
    EXPECT_NEAR(slope_at_zero([&](double h) { return bumpy.integral(t + h); }), bumpy(t).value, 1e-10) << t;
  }
}

// Beyond its ends it continues linearly. If an end is clamped, the acceleration jumps there: a breakpoint.
TEST(SmoothTable, GoesOnAtTheRateOfItsEnds) {
  SmoothTable const lift({{1.0, 2.0}, {3.0, 5.0}}, {.first_rate = 0.0, .last_rate = 0.5});
  EXPECT_EQ(lift(-4.0).value, 2.0);
  EXPECT_EQ(lift(-4.0).rate, 0.0);
  EXPECT_DOUBLE_EQ(lift(5.0).value, 6.0);
  EXPECT_DOUBLE_EQ(lift(5.0).rate, 0.5);
  EXPECT_EQ(lift(5.0).acceleration, 0.0);
  EXPECT_EQ(lift.breakpoints(), (std::vector{1.0, 3.0}));
}

// One end clamped, the other natural: two points at distance 1, chord slope s = 0, rate 1 at the start, m = 0 at the
// end. 2 m₀ = 6 (0 − 1), so m₀ = −3, and the rate at the end is 1 − 3/2.
TEST(SmoothTable, TakesOneRateAlone) {
  SmoothTable const one({{0.0, 4.0}, {1.0, 4.0}}, {.first_rate = 1.0});
  EXPECT_DOUBLE_EQ(one(0.0).rate, 1.0);
  EXPECT_DOUBLE_EQ(one(1.0).rate, -0.5);
  EXPECT_EQ(one.breakpoints(), (std::vector{0.0}));
  SmoothTable const other({{0.0, 4.0}, {1.0, 4.0}}, {.last_rate = -1.0});
  EXPECT_DOUBLE_EQ(other(0.0).rate, 0.5);
  EXPECT_EQ(other.breakpoints(), (std::vector{1.0}));
}

TEST(SmoothTable, RefusesPointsThatMakeNoTable) {
  using Points = std::vector<SmoothTable::Point>;
  auto const said = [](Points const& points) { return refusal([&] { SmoothTable{points}; }); };
  EXPECT_TRUE(has(said({}), "SmoothTable: at least two points are needed, but there are 0."));
  EXPECT_TRUE(has(said({{1.0, 2.0}}), "but there are 1."));
  EXPECT_TRUE(has(said({{0.0, 0.0}, {1.0, 0.0}, {1.0, 2.0}}), "point 3 at t = 1 s follows a point at 1 s"));
  EXPECT_TRUE(has(said({{0.0, 0.0}, {-1.0, 0.0}}), "the times must increase, but point 2 at t = -1 s"));
  EXPECT_TRUE(has(said({{0.0, 0.0}, {1.0, NAN}}), "point 2 must be finite"));
  EXPECT_TRUE(has(said({{-HUGE_VAL, 0.0}, {1.0, 0.0}}), "point 1 must be finite"));
  EXPECT_TRUE(has(refusal([] { SmoothTable({{0.0, 0.0}, {1.0, 0.0}}, {.last_rate = NAN}); }),
                  "the rate at the last point must be"));
  EXPECT_TRUE(has(refusal([] { SmoothTable({{1.0, 0.0}, {0.5, 0.0}}, {}, "\"drive\""); }),
                  "\"drive\": the times must increase"));
}

TEST(SmoothTable, RefusesPointsWhoseSplineOverflows) {
  using Points = std::vector<SmoothTable::Point>;
  auto const said = [](Points const& points) { return refusal([&] { SmoothTable(points, {}, "\"drive\""); }); };
  EXPECT_TRUE(has(said({{0.0, 0.0}, {1e-200, 1.0}}),
                  "\"drive\": a value, rate, acceleration or integral of the spline at point "
                  "1, t = 0 s, is beyond 1e+150. Give smaller values"));
  EXPECT_TRUE(has(said({{0.0, -1e308}, {1.0, 1e308}}), "is beyond"));
  EXPECT_TRUE(has(said({{0.0, 1e308}, {1e10, 1e308}}), "at point 1, t = 0 s, is beyond"));
  EXPECT_TRUE(has(said({{-1e308, 0.0}, {1e308, 1.0}}), "is beyond"));
  EXPECT_TRUE(has(refusal([] {  // only its integral overflows, and only between the points
                    SmoothTable({{0.0, 0.0}, {1e186, 0.0}}, {.first_rate = 1.0, .last_rate = 1.0}, "\"drive\"");
                  }),
                  "at point 1, t = 0 s, is beyond"));
}

}  // namespace smooth_table_test
