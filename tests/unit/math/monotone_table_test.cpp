#include <polybody/math/monotone_table.hpp>

#include <gtest/gtest.h>

#include <polybody/testing/differences.hpp>

#include <numbers>

#include "support/refusal.hpp"

using namespace polybody;
using namespace polybody::laws;

namespace monotone_table_test {

// A rubber: soft in the middle, stiff at the ends, with uneven abscissae.
MonotoneTable const rubber{{{-3.0, -9.0}, {-1.0, -1.0}, {-0.5, -0.4}, {0.5, 0.2}, {1.5, 2.0}, {2.0, 7.0}}};

TEST(MonotoneTable, GoesThroughItsPoints) {
  for (auto const& [x, y] : {std::pair{-3.0, -9.0}, {-1.0, -1.0}, {-0.5, -0.4}, {0.5, 0.2}, {1.5, 2.0}, {2.0, 7.0}})
    EXPECT_NEAR(rubber(x), y, 1e-14);
}

TEST(MonotoneTable, OfPointsOnALineIsTheLine) {
  MonotoneTable const line{{{-2.0, -5.0}, {-0.1, -1.2}, {0.4, -0.2}, {3.0, 5.0}}}, two{{{0.0, -1.0}, {1.0, 1.0}}};
  for (double const x : {-10.0, -2.0, -0.7, 0.0, 0.4, 1.0, 3.0, 8.0})
    for (MonotoneTable const* const t : {&line, &two}) {
      EXPECT_NEAR((*t)(x), 2.0 * x - 1.0, 1e-13);
      EXPECT_NEAR(t->slope(x), 2.0, 1e-13);
      EXPECT_NEAR(t->integral(x), x * x - x, 1e-12);
    }
}

// The interpolant rises if the points rise, so a spring stays a spring. A plateau remains a plateau, and a peak is
// the highest point.
TEST(MonotoneTable, NeverOvershoots) {
  for (double x = -5.0; x < 4.0; x += 1e-3) EXPECT_GE(rubber.slope(x), 0.0) << x;
  MonotoneTable const stop{{{0.0, 0.0}, {1.0, 0.0}, {1.1, 5.0}, {2.0, 100.0}, {3.0, 60.0}, {4.0, 60.0}}};
  double highest = -1.0;
  for (double x = 0.0; x < 1.0; x += 1e-3) EXPECT_EQ(stop(x), 0.0) << x;
  for (double x = 0.0; x < 6.0; x += 1e-3) highest = std::max(highest, stop(x));
  EXPECT_NEAR(highest, 100.0, 1e-12);
  for (double x = 3.0; x < 6.0; x += 1e-3) EXPECT_NEAR(stop(x), 60.0, 1e-12) << x;
}

TEST(MonotoneTable, HasAContinuousSlope) {
  for (double const x : {-3.0, -1.0, -0.5, 0.5, 1.5, 2.0}) {
    EXPECT_NEAR(rubber(x - 1e-9), rubber(x + 1e-9), 1e-7);
    EXPECT_NEAR(rubber.slope(x - 1e-9), rubber.slope(x + 1e-9), 1e-6) << x;
  }
}

TEST(MonotoneTable, IsALineBeyondItsEnds) {
  for (double const end : {-3.0, 2.0})
    for (double const far : {1.0, 10.0}) {
      double const x = end + std::copysign(far, end);
      EXPECT_NEAR(rubber(x), rubber(end) + rubber.slope(end) * (x - end), 1e-12);
      EXPECT_EQ(rubber.slope(x), rubber.slope(end));
    }
}

TEST(MonotoneTable, SlopeIsTheDerivativeOfTheValueAndTheValueOfTheIntegral) {
  for (double const x : {-4.0, -2.0, -0.7, 0.0, 0.3, 1.1, 1.8, 5.0}) {
    EXPECT_NEAR(rubber.slope(x), slope_at_zero([&](double h) { return rubber(x + h); }), 1e-10) << x;
    EXPECT_NEAR(rubber(x), slope_at_zero([&](double h) { return rubber.integral(x + h); }), 1e-10) << x;
    Dual<1> const y = rubber(Dual<1>::variable(x, 0));
    EXPECT_EQ(y.v, rubber(x));
    EXPECT_EQ(y.d[0], rubber.slope(x));
  }
}

TEST(MonotoneTable, IntegralBeginsAtZero) {
  EXPECT_NEAR(rubber.integral(0.0), 0.0, 1e-15);
  MonotoneTable const aside{{{2.0, 3.0}, {4.0, 3.0}}};  // zero is below the first point
  EXPECT_NEAR(aside.integral(0.0), 0.0, 1e-15);
  EXPECT_NEAR(aside.integral(3.0), 9.0, 1e-14);
}

// Derivatives from secants have an error of h², so the values have an error of at most h³. A step of half the length
// leaves an eighth of the error for a smooth rising function, sinh over [−1, 2].
TEST(MonotoneTable, ConvergesToASmoothFunction) {
  auto const error = [](int n) {
    std::vector<MonotoneTable::Point> points;
    for (int i = 0; i <= n; ++i) {
      double const x = -1.0 + 3.0 * i / n;
      points.push_back({x, std::sinh(x)});
    }
    MonotoneTable const table(points);
    double worst = 0.0;
    for (double x = -1.0; x < 2.0; x += 1e-3) worst = std::max(worst, std::abs(table(x) - std::sinh(x)));
    return worst;
  };
  EXPECT_LT(error(30), 2e-3);
  EXPECT_GT(error(30) / error(60), 7.0);
  EXPECT_GT(error(60) / error(120), 7.0);
}

TEST(MonotoneTable, RefusesPointsThatMakeNoFunction) {
  using Points = std::vector<MonotoneTable::Point>;
  double const nan = std::numeric_limits<double>::quiet_NaN();
  auto const said = [](Points const& points) { return refusal([&] { MonotoneTable(points, "\"mount\""); }); };
  EXPECT_TRUE(has(said({}), "\"mount\": a table needs at least two points, but has 0"));
  EXPECT_TRUE(has(said({{1.0, 2.0}}), "but has 1"));
  EXPECT_TRUE(has(said({{0.0, 0.0}, {1.0, 2.0}, {0.5, 3.0}}),
                  "the abscissae of the table must increase, but point 3 has x = 0.5 after x = 1. Sort the points"));
  EXPECT_TRUE(has(said({{0.0, 0.0}, {0.0, 2.0}}), "point 2 has x = 0 after x = 0"));
  EXPECT_TRUE(has(said({{0.0, 0.0}, {1.0, nan}}), "point 2 of the table must be finite"));
  EXPECT_TRUE(has(said({{nan, 0.0}, {1.0, 1.0}}), "point 1 of the table must be finite"));
}

TEST(MonotoneTable, RefusesPointsWhoseSlopesOverflow) {
  using Points = std::vector<MonotoneTable::Point>;
  auto const said = [](Points const& points) { return refusal([&] { MonotoneTable(points, "\"mount\""); }); };
  EXPECT_TRUE(has(said({{0.0, 0.0}, {1.0, 0.0}, {1.0 + 1e-15, 1e200}}),
                  "\"mount\": a value, slope or area of the table between its points 2 and 3 is beyond 1e+150"));
  EXPECT_TRUE(has(said({{0.0, 0.0}, {1e-200, 1.0}}), "between its points 1 and 2 is beyond"));
  EXPECT_TRUE(has(said({{0.0, 1.0}, {1e-158, 1.0}}), "is beyond"));     // 1/h² overflows
  EXPECT_TRUE(has(said({{1e140, 0.0}, {2e140, 1e140}}), "is beyond"));  // the integral from 0
  EXPECT_TRUE(has(said({{0.0, -1e308}, {1.0, 1e308}}), "is beyond"));
  EXPECT_TRUE(has(said({{0.0, 1e308}, {1e10, 1e308}}), "is beyond"));
}

}  // namespace monotone_table_test
