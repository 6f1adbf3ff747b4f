#include <polybody/vehicle/terrain.hpp>

#include <gtest/gtest.h>

#include <polybody/testing/differences.hpp>

#include <random>

#include "support/held.hpp"
#include "support/refusal.hpp"

namespace polybody {
using namespace laws;
namespace terrain_test {

constexpr double pi = std::numbers::pi;
double const nan = std::numeric_limits<double>::quiet_NaN();
double const infinity = std::numeric_limits<double>::infinity();

// A user-defined terrain needs three functions. A height without slopes is not a terrain, nor is one that does not
// accept dual numbers.
struct Slope {
  double rise;
  void check(std::string const&) const {}
  double highest() const { return infinity; }
  template <StateScalar T>
  Height<T> height(T const& x, T const&) const {
    return {x * rise, T(rise), T(0.0)};
  }
};
struct NoSlopes : FlatGround {
  template <StateScalar T>
  T height(T const& x, T const&) const {
    return x;
  }
};
struct NoDuals : FlatGround {
  template <std::same_as<double> T>
  Height<T> height(T const&, T const&) const {
    return {0.0, 0.0, 0.0};
  }
};
static_assert(Terrain<Slope> && !Terrain<NoSlopes> && !Terrain<NoDuals> && !Terrain<double> && !Terrain<MonotoneTable>);

BumpCourse const bumps({{.x = 2.0, .length = 2.0, .height = 0.2},
                        {.x = 2.5, .length = 1.5, .height = -0.1, .y = 0.5, .width = 3.0},
                        {.x = 7.0, .length = 1.0, .height = 0.15, .y = -1.0, .width = 2.0}});

RoadProfile const road({{-1.0, 0.0}, {0.5, 0.3}, {1.0, 0.1}, {3.0, 0.25}, {3.5, -0.2}});

/// Random heights from −0.5 to 0.5 m, the same on every machine.
MatX rough(Index nx, Index ny) {
  std::mt19937 random(7);
  MatX z(nx, ny);
  for (Index j = 0; j < ny; ++j)
    for (Index i = 0; i < nx; ++i) z(i, j) = double(random()) / 4294967295.0 - 0.5;
  return z;
}
HeightField const field({.x0 = -1.0, .y0 = 2.0, .dx = 0.5, .dy = 0.8, .heights = rough(9, 7)});

/// Values of a function on a grid of nx × ny points from (−1, 2).
template <class F>
HeightField sampled(F const& f, Index nx, Index ny, double dx, double dy) {
  MatX z(nx, ny);
  for (Index j = 0; j < ny; ++j)
    for (Index i = 0; i < nx; ++i) z(i, j) = f(-1.0 + double(i) * dx, 2.0 + double(j) * dy);
  return HeightField({.x0 = -1.0, .y0 = 2.0, .dx = dx, .dy = dy, .heights = z});
}

/// Slopes against finite differences of heights, and dual-number derivatives of heights and slopes against finite
/// differences of these. With h = 1e-3 m differences have an error of h⁴ f⁽⁵⁾/30: less than 1e-9 for slopes of waves
/// of 1 m, 0.2 m high. For cubics the error is round-off only.
template <Terrain G>
void expect_exact_slopes(G const& ground, double x, double y) {
  SCOPED_TRACE("at " + number(x) + ", " + number(y));
  Height<double> const h = ground.template height<double>(x, y);
  Height<Dual<2>> const d = ground.template height<Dual<2>>(Dual<2>::variable(x, 0), Dual<2>::variable(y, 1));
  EXPECT_EQ(d.z.v, h.z);
  EXPECT_EQ(d.slope_x.v, h.slope_x);
  EXPECT_EQ(d.slope_y.v, h.slope_y);
  EXPECT_NEAR(d.z.d[0], h.slope_x, 1e-14);
  EXPECT_NEAR(d.z.d[1], h.slope_y, 1e-14);
  auto const along = [&](Vec2 const& way) {
    return slope_at_zero([&](double s) {
      Height<double> const g = ground.template height<double>(x + s * way[0], y + s * way[1]);
      return Vec3(g.z, g.slope_x, g.slope_y);
    });
  };
  Vec3 const by_x = along(Vec2(1.0, 0.0)), by_y = along(Vec2(0.0, 1.0));
  EXPECT_NEAR(by_x[0], h.slope_x, 1e-9);
  EXPECT_NEAR(by_y[0], h.slope_y, 1e-9);
  EXPECT_NEAR(by_x[1], d.slope_x.d[0], 1e-9);
  EXPECT_NEAR(by_y[1], d.slope_x.d[1], 1e-9);
  EXPECT_NEAR(by_x[2], d.slope_y.d[0], 1e-9);
  EXPECT_NEAR(by_y[2], d.slope_y.d[1], 1e-9);
}

/// Height and slope are continuous at a point. Over 2e-9 m they change by 2e-9 of the curvature, which is below 100/m
/// here.
template <Terrain G>
void expect_no_jump(G const& ground, Vec2 const& at, Vec2 const& across) {
  Vec2 const a = at - 1e-9 * across, b = at + 1e-9 * across;
  Height<double> const before = ground.template height<double>(a[0], a[1]),
                       after = ground.template height<double>(b[0], b[1]);
  EXPECT_NEAR(before.z, after.z, 2e-7) << at.transpose();
  EXPECT_NEAR(before.slope_x, after.slope_x, 2e-7) << at.transpose();
  EXPECT_NEAR(before.slope_y, after.slope_y, 2e-7) << at.transpose();
}

/// The greatest height among 400 × 400 points.
template <Terrain G>
double highest_seen(G const& ground, Vec2 const& from, Vec2 const& to) {
  double most = -infinity;
  for (int i = 0; i <= 400; ++i)
    for (int j = 0; j <= 400; ++j) {
      Vec2 const at = from + Vec2((to[0] - from[0]) * i / 400.0, (to[1] - from[1]) * j / 400.0);
      most = std::max(most, ground.template height<double>(at[0], at[1]).z);
    }
  return most;
}

// Points away from feet and grid lines, because the curvature jumps there.
TEST(Terrain, SlopesAreTheDerivativesOfTheHeight) {
  for (double const x : {-3.0, -1.2, -0.7, 0.1, 0.9, 1.7, 2.3, 2.9, 3.3, 4.1, 6.7, 7.2, 20.0})
    for (double const y : {-1.7, -0.6, 0.1, 0.9, 2.2, 3.0, 4.9, 7.3, 9.0}) {
      expect_exact_slopes(FlatGround{0.3}, x, y);
      expect_exact_slopes(Washboard{.amplitude = 0.05, .wavelength = 1.3}, x, y);
      expect_exact_slopes(bumps, x, y);
      expect_exact_slopes(road, x, y);
      expect_exact_slopes(field, x, y);
    }
}

// A point that moves along (x(t), y(t)) climbs at ż = h,x ẋ + h,y ẏ.
TEST(Terrain, DualNumbersMayCarryAnyDerivative) {
  Dual<1> const x(1.7, Dual<1>::Partials::Constant(3.0)), y(2.9, Dual<1>::Partials::Constant(-0.5));
  Height<double> const h = field.height(1.7, 2.9);
  EXPECT_NEAR(field.height(x, y).z.d[0], 3.0 * h.slope_x - 0.5 * h.slope_y, 1e-14);
}

TEST(Terrain, IsNotANumberWhereThePlaceIsNone) {
  for (auto const& [x, y] : {std::pair{nan, 3.0}, {3.0, nan}}) {
    EXPECT_TRUE(std::isnan(bumps.height(x, y).z));
    EXPECT_TRUE(std::isnan(road.height(x, y).z));
    EXPECT_TRUE(std::isnan(field.height(x, y).z));
  }
}

TEST(Terrain, FlatGroundIsFlat) {
  FlatGround const ground{.z = -0.4};
  EXPECT_EQ(ground.height(3.0, -5.0).z, -0.4);
  EXPECT_EQ(ground.height(3.0, -5.0).slope_x, 0.0);
  EXPECT_EQ(ground.highest(), -0.4);
}

TEST(Terrain, AWashboardRisesFirstAndIsHighAQuarterWaveOn) {
  Washboard const board{.amplitude = 0.03, .wavelength = 0.8};
  EXPECT_EQ(board.height(0.0, 5.0).z, 0.0);
  held({"M113 contact", "slope of a washboard where it begins", By::closed_form, "2π A/λ", "Washboard"},
       board.height(0.0, 5.0).slope_x, 2.0 * pi * 0.03 / 0.8, 1e-15);
  held({"M113 contact", "height of a washboard a quarter wave on [m]", By::closed_form, "A", "Washboard"},
       board.height(0.2, 5.0).z, 0.03, 1e-16);
  EXPECT_NEAR(board.height(-0.2 + 8.0, 5.0).z, -0.03, 1e-15);
  EXPECT_EQ(board.highest(), 0.03);
}

// By hand: H in the middle. At a quarter of the length from the middle the height is half of it and the slope is
// steepest, ∓ πH/L. Both are zero outside the feet.
TEST(BumpCourse, ABumpIsARaisedCosine) {
  BumpCourse const one({{.x = 4.0, .length = 2.0, .height = 0.1}});
  for (double const y : {-100.0, 0.0, 3.0}) {
    EXPECT_EQ(one.height(4.0, y).z, 0.1);
    EXPECT_EQ(one.height(4.0, y).slope_x, 0.0);
    held({"M113 contact", "height of a bump half way up [m]", By::closed_form, "½ H", "BumpCourse"},
         one.height(3.5, y).z, 0.05, 1e-16, {equals("y", y)});
    held({"M113 contact", "slope of a bump half way up", By::closed_form, "π H/L", "BumpCourse"},
         one.height(3.5, y).slope_x, 0.05 * pi, 1e-15, {equals("y", y)});
    EXPECT_NEAR(one.height(4.5, y).slope_x, -0.05 * pi, 1e-15);
    EXPECT_NEAR(one.height(4.0 + 1.0 / 3.0, y).z, 0.075, 1e-16);
    EXPECT_EQ(one.height(3.5, y).slope_y, 0.0);
    for (double const x : {-50.0, 3.0, 5.0, 6.0}) {
      EXPECT_EQ(one.height(x, y).z, 0.0);
      EXPECT_EQ(one.height(x, y).slope_x, 0.0);
    }
  }
}

// The transverse profile has the same shape: half of the height half way to the side.
TEST(BumpCourse, ABumpOfFiniteWidthTapersToItsSides) {
  BumpCourse const one({{.x = 4.0, .length = 2.0, .height = 0.1, .y = 1.0, .width = 3.0}});
  EXPECT_EQ(one.height(4.0, 1.0).z, 0.1);
  EXPECT_NEAR(one.height(4.0, 1.75).z, 0.05, 1e-16);
  EXPECT_NEAR(one.height(4.0, 1.75).slope_y, -0.1 * pi / 3.0, 1e-15);
  EXPECT_NEAR(one.height(3.5, 1.75).z, 0.025, 1e-16);
  EXPECT_EQ(one.height(4.0, 2.5).z, 0.0);
  EXPECT_EQ(one.height(4.0, -0.6).z, 0.0);
}

TEST(BumpCourse, BumpsAddUp) {
  Bump const a{.x = 1.0, .length = 2.0, .height = 0.1},
      b{.x = 1.6, .length = 1.0, .height = 0.05, .y = 0.2, .width = 2.0};
  BumpCourse const one({a}), other({b}), both({a, b});
  for (double const x : {0.3, 1.2, 1.5, 1.9}) {
    Height<double> const h = both.height(x, 0.4), ha = one.height(x, 0.4), hb = other.height(x, 0.4);
    EXPECT_NEAR(h.z, ha.z + hb.z, 1e-16);
    EXPECT_NEAR(h.slope_x, ha.slope_x + hb.slope_x, 1e-15);
    EXPECT_NEAR(h.slope_y, ha.slope_y + hb.slope_y, 1e-15);
  }
}

TEST(BumpCourse, DoesNotJumpAtTheFeet) {
  for (double const s : {-0.4, 0.1, 0.3}) {
    for (double const x : {1.0, 3.0}) expect_no_jump(bumps, Vec2(x, s), Vec2(1.0, 0.0));
    for (double const x : {1.75, 3.25}) expect_no_jump(bumps, Vec2(x, s), Vec2(1.0, 0.0));
    for (double const y : {-1.0, 2.0}) expect_no_jump(bumps, Vec2(2.5 + s, y), Vec2(0.0, 1.0));
    for (double const y : {-2.0, 0.0}) expect_no_jump(bumps, Vec2(7.0 + s, y), Vec2(0.0, 1.0));
  }
}

// The bound of a single bump is its own height. Only overlapping bumps are added; holes do not count.
TEST(BumpCourse, IsNowhereHigherThanItSays) {
  EXPECT_EQ(BumpCourse({}).highest(), 0.0);
  EXPECT_EQ(BumpCourse({{.x = 4.0, .length = 2.0, .height = 0.1}}).highest(), 0.1);
  EXPECT_EQ(BumpCourse({{.x = 4.0, .length = 2.0, .height = -0.1}}).highest(), 0.0);
  BumpCourse const twice({{.x = 4.0, .length = 2.0, .height = 0.1}, {.x = 4.0, .length = 1.0, .height = 0.2}});
  EXPECT_EQ(twice.highest(), 0.1 + 0.2);
  EXPECT_EQ(twice.height(4.0, 0.0).z, 0.1 + 0.2);
  BumpCourse const rows({{.x = 1.0, .length = 1.0, .height = 0.1}, {.x = 2.0, .length = 1.0, .height = 0.15}});
  EXPECT_EQ(rows.highest(), 0.15);
  BumpCourse const tracks({{.x = 1.0, .length = 1.0, .height = 0.1, .y = -1.0, .width = 1.0},
                           {.x = 1.0, .length = 1.0, .height = 0.15, .y = 1.0, .width = 1.0}});
  EXPECT_EQ(tracks.highest(), 0.15);
  EXPECT_EQ(bumps.highest(), 0.2);
  EXPECT_LE(highest_seen(bumps, {0.0, -3.0}, {8.0, 3.0}), 0.2);
}

TEST(RoadProfile, GoesThroughItsPointsAndIsConstantBeyondThem) {
  for (auto const& [x, z] : {std::pair{-1.0, 0.0}, {0.5, 0.3}, {1.0, 0.1}, {3.0, 0.25}, {3.5, -0.2}})
    EXPECT_NEAR(road.height(x, 8.0).z, z, 1e-15);
  for (double const far : {0.0, 1e-3, 7.0, 1e9}) {
    EXPECT_EQ(road.height(-1.0 - far, 8.0).z, 0.0);
    EXPECT_NEAR(road.height(3.5 + far, 8.0).z, -0.2, 1e-15);
    EXPECT_EQ(road.height(-1.0 - far, 8.0).slope_x, 0.0);
    EXPECT_EQ(road.height(3.5 + far, 8.0).slope_x, 0.0);
  }
}

// By hand: the slope is zero at the ends and, after Fritsch & Butland, 6/(3/1 + 3/2) = 4/3 at the middle point
// between chords of slope 1 and 2. Half-way between points a cubic is (z₀ + z₁)/2 + h (z₀′ − z₁′)/8.
TEST(RoadProfile, IsTheMonotoneCubicThatIsLevelAtItsEnds) {
  RoadProfile const hill({{0.0, 0.0}, {1.0, 1.0}, {2.0, 3.0}});
  EXPECT_NEAR(hill.height(1.0, 0.0).slope_x, 4.0 / 3.0, 1e-15);
  EXPECT_NEAR(hill.height(0.5, 0.0).z, 1.0 / 3.0, 1e-15);
  EXPECT_NEAR(hill.height(1.5, 0.0).z, 2.0 + 1.0 / 6.0, 1e-15);
  RoadProfile const ramp({{2.0, 0.1}, {7.0, 0.7}});  // H (3s² − 2s³), s = (x − 2)/5, steepest in the middle: 3H/2L
  EXPECT_NEAR(ramp.height(4.5, 0.0).slope_x, 0.18, 1e-15);
  EXPECT_NEAR(ramp.height(3.0, 0.0).z, 0.1 + 0.6 * (0.12 - 0.016), 1e-15);
}

TEST(RoadProfile, IsStraightBetweenPointsOnALine) {
  RoadProfile const line({{0.0, 0.0}, {1.0, 0.1}, {1.5, 0.15}, {4.0, 0.4}, {5.0, 0.5}});
  for (double x = 1.0; x <= 4.0; x += 0.0625) {
    EXPECT_NEAR(line.height(x, 0.0).z, 0.1 * x, 1e-15);
    EXPECT_NEAR(line.height(x, 0.0).slope_x, 0.1, 1e-14);
  }
}

TEST(RoadProfile, DoesNotJumpAtItsPoints) {
  for (double const x : {-1.0, 0.5, 1.0, 3.0, 3.5}) expect_no_jump(road, Vec2(x, 0.0), Vec2(1.0, 0.0));
}

// A kerb rises without a hump in front of or behind it, and plane parts remain plane. Round-off does not raise it,
// for points of ordinary size and for denormal ones.
TEST(RoadProfile, IsNowhereHigherThanItsPoints) {
  RoadProfile const kerb({{0.0, 0.0}, {1.0, 0.0}, {1.1, 0.15}, {3.0, 0.15}});
  for (double x = -1.0; x < 4.0; x += 1e-3) {
    Height<double> const h = kerb.height(x, 0.0);
    EXPECT_GE(h.slope_x, -1e-15) << x;
    if (x <= 1.0) {
      EXPECT_EQ(h.z, 0.0) << x;
    } else if (x >= 1.1) {
      EXPECT_EQ(h.z, 0.15) << x;
    }
  }
  EXPECT_EQ(kerb.highest(), 0.15);
  EXPECT_EQ(road.highest(), 0.3);
  // highest point at x = 0.5, which is among the points tested
  EXPECT_NEAR(highest_seen(road, {-3.5, 0.0}, {4.5, 1.0}), 0.3, 1e-15);
  EXPECT_EQ(RoadProfile({{0.0, -0.2}, {1.0, -0.2}}).highest(), -0.2);
  for (double const low : {-0.7, -2.4e-319})
    for (RoadProfile const& level :
         {RoadProfile({{-24.0, low}, {36.0, low}}), RoadProfile({{0.0, low}, {3.0, 2 * low}})})
      for (double x = -30.0; x < 40.0; x += 0.1) EXPECT_LE(level.height(x, 0.0).z, low) << x;
}

TEST(HeightField, GoesThroughItsPoints) {
  MatX const z = rough(9, 7);
  for (Index i = 0; i < 9; ++i)
    for (Index j = 0; j < 7; ++j)
      EXPECT_NEAR(field.height(-1.0 + 0.5 * double(i), 2.0 + 0.8 * double(j)).z, z(i, j), 1e-14);
}

// A Catmull–Rom curve has the value (−z₀ + 9z₁ + 9z₂ − z₃)/16 midway between its second and third point.
TEST(HeightField, IsOfCatmullAndRomBetweenFourPoints) {
  MatX const z = rough(9, 7);
  Vec4 const w = Vec4(-1.0, 9.0, 9.0, -1.0) / 16.0;
  for (Index i = 1; i < 7; ++i)
    for (Index j = 1; j < 5; ++j) {
      double const x = -1.0 + 0.5 * (double(i) + 0.5), y = 2.0 + 0.8 * (double(j) + 0.5);
      EXPECT_NEAR(field.height(x, y).z, w.dot(z.block<4, 4>(i - 1, j - 1) * w), 1e-14);
    }
}

// With two points per direction or more, and up to the border.
TEST(HeightField, ReproducesPlanesAndTheirTwist) {
  auto const f = [](double x, double y) { return 0.7 - 0.3 * x + 0.2 * y + 0.1 * x * y; };
  for (Index const n : {2, 3, 4, 6}) {
    HeightField const ground = sampled(f, n, 8 - n, 0.5, 0.8);
    for (double s = 0.0; s <= 1.0; s += 0.0625)
      for (double t = 0.0; t <= 1.0; t += 0.0625) {
        double const x = -1.0 + 0.5 * double(n - 1) * s, y = 2.0 + 0.8 * double(7 - n) * t;
        Height<double> const h = ground.height(x, y);
        EXPECT_NEAR(h.z, f(x, y), 1e-14) << n << ": " << x << ", " << y;
        EXPECT_NEAR(h.slope_x, -0.3 + 0.1 * y, 1e-13) << n << ": " << x << ", " << y;
        EXPECT_NEAR(h.slope_y, 0.2 + 0.1 * x, 1e-13) << n << ": " << x << ", " << y;
      }
  }
}

TEST(HeightField, ReproducesParabolasAwayFromItsBorder) {
  auto const f = [](double x, double y) { return (1.0 - x + 0.5 * x * x) * (0.3 + 0.2 * y - 0.1 * y * y); };
  HeightField const ground = sampled(f, 6, 4, 0.5, 0.25);
  for (double x = -0.5; x <= 1.0; x += 0.0625)
    for (double y = 2.25; y <= 2.5; y += 0.03125) EXPECT_NEAR(ground.height(x, y).z, f(x, y), 1e-14) << x << ", " << y;
}

// Slopes at the points have an error of h², at the border of h. So away from the border heights have an error of h³
// and slopes of h²: half the spacing leaves an eighth and a quarter. In the cells along the border the order is one
// less.
TEST(HeightField, ConvergesToASmoothGround) {
  auto const f = [](double x, double y) { return std::sin(2.0 * x) * std::cos(1.5 * y); };
  auto const errors = [&](Index n, double margin) {
    HeightField const ground = sampled(f, n + 1, n + 1, 3.0 / double(n), 2.0 / double(n));
    Vec2 worst = Vec2::Zero();
    for (int i = 0; i <= 300; ++i)
      for (int j = 0; j <= 300; ++j) {
        double const x = -1.0 + margin + (3.0 - 2.0 * margin) * i / 300.0,
                     y = 2.0 + margin + (2.0 - 2.0 * margin) * j / 300.0;
        Height<double> const h = ground.height(x, y);
        double const in_slope = std::max(std::abs(h.slope_x - 2.0 * std::cos(2.0 * x) * std::cos(1.5 * y)),
                                         std::abs(h.slope_y + 1.5 * std::sin(2.0 * x) * std::sin(1.5 * y)));
        worst = worst.cwiseMax(Vec2(std::abs(h.z - f(x, y)), in_slope));
      }
    return worst;
  };
  for (Index const n : {20, 40}) {
    Vec2 const inside = errors(n, 0.15).cwiseQuotient(errors(2 * n, 0.15));
    Vec2 const all = errors(n, 0.0).cwiseQuotient(errors(2 * n, 0.0));
    EXPECT_GT(inside[0], 7.0);
    EXPECT_GT(inside[1], 3.5);
    EXPECT_GT(all[0], 3.5);
    EXPECT_GT(all[1], 1.8);
  }
}

// The grid lines, the border, and the line beyond it at which the slope reaches zero.
TEST(HeightField, DoesNotJumpAtItsLines) {
  for (int i = -1; i <= 9; ++i)
    for (double const y : {0.0, 1.5, 2.0, 2.3, 3.6, 5.1, 6.8, 7.1, 7.6, 9.0})
      expect_no_jump(field, Vec2(-1.0 + 0.5 * i, y), Vec2(1.0, 0.0));
  for (int j = -1; j <= 7; ++j)
    for (double const x : {-3.0, -1.5, -1.2, -1.0, 0.2, 1.0, 2.9, 3.0, 3.1, 5.0})
      expect_no_jump(field, Vec2(x, 2.0 + 0.8 * j), Vec2(0.0, 1.0));
}

// By hand for the plane h = 1 + 0.3x − 0.2y on [0, 2] × [0, 3] with spacings 1 and 1.5. Beyond x = 2 the slope is 0.3
// (1 − u) and the height grows by 0.3 (u − u²/2), u = x − 2. From u = 1 on it is 0.15 more than at the border. Beyond
// y = 3 the height falls by 0.2 (v − v²/3), v = y − 3, finally by 0.15. Beyond x = 0 and y = 0 the rules are the
// same, and at the corners both apply.
TEST(HeightField, LevelsOutBeyondItsBorder) {
  MatX z(3, 3);
  for (Index i = 0; i < 3; ++i)
    for (Index j = 0; j < 3; ++j) z(i, j) = 1.0 + 0.3 * double(i) - 0.2 * 1.5 * double(j);
  HeightField const plane({.x0 = 0.0, .y0 = 0.0, .dx = 1.0, .dy = 1.5, .heights = z});
  auto const expect = [&](double x, double y, double height, double slope_x, double slope_y) {
    Height<double> const h = plane.height(x, y);
    EXPECT_NEAR(h.z, height, 1e-14) << x << ", " << y;
    EXPECT_NEAR(h.slope_x, slope_x, 1e-14) << x << ", " << y;
    EXPECT_NEAR(h.slope_y, slope_y, 1e-14) << x << ", " << y;
  };
  expect(2.5, 1.0, 1.4 + 0.3 * 0.375, 0.15, -0.2);
  expect(-0.5, 1.0, 0.8 - 0.3 * 0.375, 0.15, -0.2);
  expect(1.0, 3.75, 0.7 - 0.2 * (0.75 - 0.1875), 0.3, -0.1);
  expect(1.0, -0.75, 1.3 + 0.2 * (0.75 - 0.1875), 0.3, -0.1);
  for (double const far : {1.0, 1.5, 40.0, 1e12}) {
    expect(2.0 + far, 1.0, 1.4 + 0.15, 0.0, -0.2);
    expect(-far, 1.0, 0.8 - 0.15, 0.0, -0.2);
    expect(1.0, 3.0 + 1.5 * far, 0.7 - 0.15, 0.3, 0.0);
    expect(1.0, -1.5 * far, 1.3 + 0.15, 0.3, 0.0);
    expect(2.0 + far, -1.5 * far, 1.6 + 0.15 + 0.15, 0.0, 0.0);
    expect(-far, 3.0 + 1.5 * far, 0.4 - 0.15 - 0.15, 0.0, 0.0);
    EXPECT_EQ(plane.height(2.0 + far, 1.0).slope_x, 0.0);
    EXPECT_EQ(plane.height(1.0, -1.5 * far).slope_y, 0.0);
  }
  EXPECT_NEAR(plane.highest(), 1.9,
              1e-14);  // attained beyond the corner x = 2, y = 0: the bound equals the highest point of the ground
}

// Between its points the ground is higher than at any of them, and it may be higher still beyond the border. Hence
// the points are not a bound.
TEST(HeightField, IsNowhereHigherThanItSays) {
  // A ridge that is highest just before its steep side, 1.078 with points of 1, in all four orientations.
  Vec4 const ridge(0.9, 1.0, 1.0, 0.0);
  MatX const up = ridge.replicate(1, 3), down = ridge.reverse().replicate(1, 3);
  for (MatX const& z : {up, down, MatX(up.transpose()), MatX(down.transpose())}) {
    HeightField const ground({.x0 = 0.0, .y0 = 0.0, .dx = 0.5, .dy = 2.0, .heights = z});
    double const seen = highest_seen(ground, {-1.0, -3.0}, {3.0, 9.0});
    EXPECT_GT(seen, 1.07);
    EXPECT_GE(ground.highest(), seen);
  }
  double const within = highest_seen(field, {-1.0, 2.0}, {3.0, 6.8});
  EXPECT_GT(within, rough(9, 7).maxCoeff());
  EXPECT_GE(field.highest(), within);
  EXPECT_GE(field.highest(), highest_seen(field, {-2.0, 1.0}, {4.0, 8.0}));
  EXPECT_EQ(HeightField({.x0 = 0.0, .y0 = 0.0, .dx = 1.0, .dy = 1.0, .heights = MatX::Constant(4, 4, -0.3)}).highest(),
            -0.3);
}

TEST(Terrain, RefusesWhatIsNoGround) {
  EXPECT_TRUE(has(refusal([] { FlatGround{nan}.check("\"yard\""); }),
                  "\"yard\": the height of the ground must be finite, but is nan"));
  EXPECT_TRUE(has(refusal([] { Washboard{.amplitude = -1.0, .wavelength = 1.0}.check("\"lane\""); }),
                  "\"lane\": the amplitude must be zero or positive"));
  EXPECT_TRUE(has(refusal([] { Washboard{.amplitude = 1.0, .wavelength = 0.0}.check("\"lane\""); }),
                  "\"lane\": the wavelength must be positive"));
}

TEST(BumpCourse, RefusesWhatIsNoBump) {
  Bump const good{.x = 0.0, .length = 1.0, .height = 0.1};
  auto const said = [&](Bump const& bad) { return refusal([&] { BumpCourse({good, bad}, "\"course\""); }); };
  EXPECT_TRUE(has(said({.x = 0.0, .length = 0.0, .height = 0.1}), "\"course\": bump 2: the length must be positive"));
  EXPECT_TRUE(
      has(said({.x = 0.0, .length = infinity, .height = 0.1}), "the length must be positive and finite, but is inf"));
  EXPECT_TRUE(has(said({.x = 0.0, .length = 1.0, .height = nan}), "bump 2: its middle and height must be finite"));
  EXPECT_TRUE(has(said({.x = nan, .length = 1.0, .height = 0.1}), "bump 2: its middle and height must be finite"));
  EXPECT_TRUE(has(said({.x = 0.0, .length = 1.0, .height = 0.1, .y = infinity}),
                  "bump 2: its middle and height must be finite"));
  for (double const width : {-1.0, 0.0, nan})
    EXPECT_TRUE(has(said({.x = 0.0, .length = 1.0, .height = 0.1, .y = 0.0, .width = width}),
                    "bump 2: the width must be positive, but is " + number(width) +
                        " m. Omit the width for a bump across the whole ground."));
}

TEST(RoadProfile, RefusesPointsThatMakeNoRoad) {
  using Points = std::vector<RoadProfile::Point>;
  auto const said = [](Points const& points) { return refusal([&] { RoadProfile(points, "\"road\""); }); };
  EXPECT_TRUE(has(said({}), "\"road\": a table needs at least two points, but has 0"));
  EXPECT_TRUE(has(said({{1.0, 2.0}}), "but has 1"));
  EXPECT_TRUE(has(said({{0.0, 0.0}, {1.0, nan}}), "\"road\": point 2 of the table must be finite, but is (1, nan)"));
  EXPECT_TRUE(has(said({{-infinity, 0.0}, {1.0, 0.0}}), "point 1 of the table must be finite"));
  EXPECT_TRUE(
      has(said({{0.0, 0.0}, {1.0, 0.1}, {1.0, 0.2}}),
          "\"road\": the abscissae of the table must increase, but point 3 has x = 1 after x = 1. Sort the points"));
}

TEST(HeightField, RefusesWhatIsNoGrid) {
  HeightField::Grid const good{.x0 = 0.0, .y0 = 0.0, .dx = 1.0, .dy = 1.0, .heights = MatX::Zero(3, 4)};
  auto const said = [&](auto const& spoil) {
    HeightField::Grid bad = good;
    spoil(bad);
    return refusal([&] { HeightField(bad, "\"hill\""); });
  };
  using Grid = HeightField::Grid;
  EXPECT_TRUE(has(said([](Grid& g) { g.dx = 0.0; }), "\"hill\": the spacing dx must be positive and finite, but is 0"));
  EXPECT_TRUE(
      has(said([](Grid& g) { g.dy = -1.0; }), "\"hill\": the spacing dy must be positive and finite, but is -1"));
  EXPECT_TRUE(
      has(said([](Grid& g) { g.y0 = nan; }), "\"hill\": the position x0, y0 of the first point must be finite"));
  EXPECT_TRUE(has(said([](Grid& g) { g.heights(2, 3) = nan; }),
                  "\"hill\": heights(2, 3) must be finite, but is nan. Fill gaps"));
  EXPECT_TRUE(has(said([](Grid& g) { g.heights = MatX::Zero(1, 5); }),
                  "\"hill\": a grid needs at least two points along x and along y, but has 1 by 5. For"));
  EXPECT_TRUE(has(said([](Grid& g) { g.heights = MatX(); }), "but has 0 by 0"));
}

TEST(HeightField, RefusesHeightsWhoseSlopesOverflow) {
  HeightField::Grid const flat{.x0 = 0.0, .y0 = 0.0, .dx = 1.0, .dy = 1.0, .heights = MatX::Zero(3, 4)};
  auto const said = [&](double dy, double height) {
    HeightField::Grid bad = flat;
    bad.dy = dy;
    bad.heights(1, 2) = height;
    return refusal([&] { HeightField(bad, "\"hill\""); });
  };
  EXPECT_TRUE(has(said(1.0, 1e308), "\"hill\": its slopes or curvatures exceed 1e+150. Give heights and spacings"));
  EXPECT_TRUE(has(said(1e-60, 1e100), "curvatures exceed"));
  EXPECT_TRUE(has(said(1e-200, 0.0), "curvatures exceed"));
}

}  // namespace terrain_test
}  // namespace polybody
