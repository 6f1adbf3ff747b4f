// Rainflow counting: the example of the standard, histories with obvious cycles, and properties for every history.
#include <polybody/signals/rainflow.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <numbers>
#include <random>

#include "support/held.hpp"
#include "support/refusal.hpp"

namespace rainflow_test {

using namespace polybody;
using Points = std::vector<double>;

std::map<double, double> counts(std::vector<StressCycle> const& cycles) {
  std::map<double, double> of_range;
  for (StressCycle const& c : cycles) of_range[c.range] += c.count;
  return of_range;
}

TEST(TurningPoints, ArePeaksValleysAndEnds) {
  EXPECT_EQ(turning_points(Points{0, 1, 2, 2, 1, 1, -3, -3, 5}), (Points{0, 2, -3, 5}));
  EXPECT_EQ(turning_points(Points{4, 4, 4}), Points{4});
  EXPECT_EQ(turning_points(Points{1, 2, 3}), (Points{1, 3}));
  EXPECT_EQ(turning_points(Points{3, 3, 2, 2, 2, 2.5}), (Points{3, 2, 2.5}));
  EXPECT_TRUE(turning_points(Points{}).empty());
  EXPECT_TRUE(has(refusal([] { turning_points(Points{0, std::nan("")}); }), "sample 1 is not finite"));
}

// ASTM E1049-85, Fig. 6: peaks and valleys A … I. Compared are the order, the pairs and the table of the standard.
TEST(Rainflow, CountsTheExampleOfTheStandard) {
  Points const history{-2, 1, -3, 5, -1, 3, -4, 4, -2};
  std::vector<StressCycle> const expected{{3, -0.5, 0.5},  // A–B
                                          {4, -1, 0.5},    // B–C
                                          {4, 1, 1.0},     // E–F
                                          {8, 1, 0.5},    {9, 0.5, 0.5},
                                          {8, 0, 0.5},    {6, 1, 0.5}};  // C–D, D–G, G–H, H–I
  std::vector<StressCycle> const found = rainflow(history);
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    auto const claim = [](char const* what) {
      return Claim{"ASTM E1049-85", what, By::published, "Fig. 6 of the standard", "rainflow"};
    };
    Instance const at{equals("cycle", double(i + 1)), 1.0};
    held(claim("ranges of the cycles"), found[i].range, expected[i].range, 0.0, at);
    held(claim("means of the cycles"), found[i].mean, expected[i].mean, 0.0, at);
    held(claim("counts of the cycles"), found[i].count, expected[i].count, 0.0, at);
  }
  EXPECT_EQ(counts(found), (std::map<double, double>{{3, 0.5}, {4, 1.5}, {6, 0.5}, {8, 1.0}, {9, 0.5}}));
  EXPECT_EQ(binned(found, 2.5), (std::vector<double>{0, 2.0, 0.5, 1.5}));  // up to 2.5, 5, 7.5, 10
}

// n periods of a sine from zero. Every range between extrema is 2. These ranges count as halves, because the history
// begins and ends within one. The first and the last quarter are halves of range 1.
TEST(Rainflow, CountsASineOncePerPeriod) {
  Points wave;
  for (int i = 0; i <= 4000; ++i) wave.push_back(std::sin(2 * std::numbers::pi * i / 400.0));
  auto cycles = rainflow(wave);
  double large = 0.0, small = 0.0;
  for (StressCycle const& c : cycles) (c.range > 1.5 ? large : small) += c.count;
  EXPECT_EQ(large, 9.5);
  EXPECT_EQ(small, 1.0);
}

// By hand after §5.4.4: three cycles of 1 close within larger ranges. 0–10 is half a cycle, because it begins the
// history. 10, −10, 5, 0 remain.
TEST(Rainflow, FindsSmallCyclesWithinALargeOne) {
  auto const c = counts(rainflow(Points{0, 4, 3, 8, 7, 10, -10, 0, -1, 5, 0}));
  EXPECT_EQ(c, (std::map<double, double>{{1, 3.0}, {5, 0.5}, {10, 0.5}, {15, 0.5}, {20, 0.5}}));
}

// Properties of every history. Twice the sum of all ranges times their counts is the total path from point to point.
// The largest range is from the lowest to the highest point. The inverted history has the same cycles with opposite
// means.
TEST(Rainflow, KeepsTheWayTheSpanAndTheSymmetry) {
  std::mt19937 random(3);
  for (int trial = 0; trial < 50; ++trial) {
    Points history, opposite;
    for (int i = 0; i < 300; ++i) {
      history.push_back(double(int(random() % 41)) - 20.0);
      opposite.push_back(-history.back());
    }
    auto const cycles = rainflow(history), mirrored = rainflow(opposite);
    double way = 0.0, counted = 0.0, largest = 0.0;
    for (std::size_t i = 1; i < history.size(); ++i) way += std::abs(history[i] - history[i - 1]);
    for (StressCycle const& c : cycles) {
      counted += 2.0 * c.count * c.range;
      largest = std::max(largest, c.range);
    }
    EXPECT_EQ(counted, way);
    auto const [low, high] = std::minmax_element(history.begin(), history.end());
    EXPECT_EQ(largest, *high - *low);
    ASSERT_EQ(cycles.size(), mirrored.size());
    for (std::size_t i = 0; i < cycles.size(); ++i) {
      EXPECT_EQ(cycles[i].range, mirrored[i].range);
      EXPECT_EQ(cycles[i].mean, -mirrored[i].mean);
    }
  }
}

// N₀ = 2e6 at 100 MPa with m = 3: the life is 2e6 cycles of 100 MPa, and 8 times as many at 50 MPa. The standard's
// history in units of 10 MPa: D = (0.5·3³ + 1.5·4³ + 0.5·6³ + 8³ + 0.5·9³)/10³ / 2e6 = 1.094e3/1e3/2e6.
TEST(Damage, IsLinearInCyclesAndAPowerOfTheRange) {
  Basquin const curve{.range = 100e6, .cycles = 2e6, .exponent = 3.0};
  held({"closed forms", "cycles that a specimen lasts", By::closed_form, "N₀ (Δσ₀/Δσ)^m", "Basquin"}, curve.life(50e6),
       16e6, 1e-6);
  EXPECT_NEAR(damage(std::vector<StressCycle>{{100e6, 0.0, 2e6}}, curve), 1.0, 1e-14);
  Points history{-2, 1, -3, 5, -1, 3, -4, 4, -2};
  for (double& x : history) x *= 10e6;
  double const expected = (0.5 * 27 + 1.5 * 64 + 0.5 * 216 + 512 + 0.5 * 729) / 1e3 / 2e6;
  held({"closed forms", "damage of the standard's history", By::closed_form, "Σ n (Δσ/Δσ₀)^m/N₀", "Basquin"},
       damage(rainflow(history), curve), expected, 1e-13 * expected, {"all cycles"});
  Basquin const limited{.range = 100e6, .cycles = 2e6, .exponent = 3.0, .limit = 60e6};
  held({"closed forms", "damage of the standard's history", By::closed_form, "Σ n (Δσ/Δσ₀)^m/N₀", "Basquin"},
       damage(rainflow(history), limited), (512 + 0.5 * 729) / 1e3 / 2e6, 1e-13 * expected, {"above the limit"});
}

TEST(Damage, RefusesCurvesThatCannotBeMeant) {
  EXPECT_TRUE(has(refusal([] { damage({}, {.range = 0.0, .cycles = 1.0, .exponent = 3.0}); }), "Basquin: the range"));
  EXPECT_TRUE(has(refusal([] { damage({}, {.range = 1.0, .cycles = -1.0, .exponent = 3.0}); }), "number of cycles"));
  EXPECT_TRUE(has(refusal([] { damage({}, {.range = 1.0, .cycles = 1.0, .exponent = 0.0}); }), "exponent"));
  EXPECT_TRUE(has(refusal([] { damage({}, {.range = 1.0, .cycles = 1.0, .exponent = 3.0, .limit = -1.0}); }), "limit"));
  EXPECT_TRUE(has(refusal([] { binned({}, 0.0); }), "the width"));
  StressCycle const one[]{{.range = 5e7, .mean = 0.0, .count = 1.0}};
  EXPECT_TRUE(has(refusal([&] { binned(one, 1e-300); }), "must exceed 1e-7 of each range, but is 1e-300"));
}

}  // namespace rainflow_test
