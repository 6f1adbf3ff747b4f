#include <gtest/gtest.h>

#include <cstdint>
#include <limits>

#include <polybody/study/sampling.hpp>

#include "support/refusal.hpp"

using namespace polybody;

namespace points_test {

double const nan = std::numeric_limits<double>::quiet_NaN(), infinite = std::numeric_limits<double>::infinity();

TEST(StudyPoints, AGridHasEveryCombinationAndTheLastColumnVariesFastest) {
  Points const points = grid(axis("stiffness", "N/m", {1e6, 1e8}), formulations("integrator", {"Radau", "HHT"}),
                             axis("step", "s", {1e-2, 1e-3, 1e-4}));
  ASSERT_EQ(points.size(), 12u);
  EXPECT_EQ(points.columns()[0].head(), "stiffness [N/m]");
  EXPECT_EQ(points.columns()[1].head(), "integrator");
  for (std::size_t i = 0; i < 12; ++i) {
    Point const p = points[i];
    EXPECT_EQ(p.index(), i);
    EXPECT_EQ(p["stiffness"], i < 6 ? 1e6 : 1e8);
    EXPECT_EQ(p.choice("integrator"), i / 3 % 2);
    EXPECT_EQ(p.chosen("integrator"), i / 3 % 2 == 0 ? "Radau" : "HHT");
    EXPECT_EQ(p["step"], (std::vector{1e-2, 1e-3, 1e-4})[i % 3]);
  }
}

TEST(StudyPoints, AChoiceCallsWithItsOwnArgument) {
  Points const points = formulations("body", {"one", "two", "three"});
  auto const size = [](auto const& x) { return sizeof x; };
  EXPECT_EQ(points[0].with("body", size, char{}, std::int16_t{}, std::int64_t{}), 1u);
  EXPECT_EQ(points[1].with("body", size, char{}, std::int16_t{}, std::int64_t{}), 2u);
  EXPECT_EQ(points[2].with("body", size, char{}, std::int16_t{}, std::int64_t{}), 8u);
  EXPECT_TRUE(has(message_of<StudyUsageError>([&] { points[0].with("body", size, 1, 2); }), "has 3 choices"));
}

TEST(StudyPoints, ScalesHaveTheirEndsAndRoundNumbersBetween) {
  EXPECT_EQ(logarithmic(1e6, 1e10, 5), (std::vector{1e6, 1e7, 1e8, 1e9, 1e10}));
  EXPECT_EQ(logarithmic(1e-2, 1e-5, 4), (std::vector{1e-2, 1e-3, 1e-4, 1e-5}));
  EXPECT_EQ(linear(0.0, 1.0, 11), (std::vector{0.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0}));
  EXPECT_EQ(linear(-1.0 / 3.0, 1.0 / 3.0, 2), (std::vector{-1.0 / 3.0, 1.0 / 3.0}));  // end values have no round-off
}

TEST(StudyPoints, AGridOfOneAxisIsTheAxis) {
  Points const one = axis("step", "s", {1e-3, 1e-4}), same = grid(one);
  ASSERT_EQ(same.size(), 2u);
  EXPECT_EQ(same.columns().size(), 1u);
  for (std::size_t i = 0; i < 2; ++i) EXPECT_EQ(same.at(i, 0), one.at(i, 0));
}

TEST(StudyPoints, WhatCannotBeMeantIsRefused) {
  EXPECT_TRUE(has(refusal([] { linear(0.0, nan, 3); }), "needs finite first and last values"));
  EXPECT_TRUE(has(refusal([] { linear(0.0, 1.0, 1); }), "two values"));
  EXPECT_TRUE(has(refusal([] { logarithmic(0.0, 1.0, 3); }), "needs positive first and last values"));
  EXPECT_TRUE(has(refusal([] { logarithmic(1.0, infinite, 3); }), "needs finite first and last values"));
  EXPECT_TRUE(has(refusal([] { axis("step", "s", {}); }), "at least one point"));
  EXPECT_TRUE(has(refusal([] { axis("step", "s", {1.0, nan}); }), "column \"step\" is not finite"));
  EXPECT_TRUE(has(refusal([] { axis("", "s", {1.0}); }), "empty or not printable"));
  EXPECT_TRUE(has(refusal([] { axis("step\n", "s", {1.0}); }), "empty or not printable"));
  EXPECT_TRUE(
      has(refusal([] { grid(axis("step", "s", {1.0}), axis("step", "s", {1.0})); }), "duplicate column \"step\""));
  EXPECT_TRUE(
      has(refusal([] { list({{"a"}, {"b"}}, {{1.0, 2.0}, {1.0}}); }), "1 values, but the points have 2 columns"));
  EXPECT_TRUE(has(refusal([] { list({{"a", "", {"one"}}}, {{1.0}}); }), "none of the 1 choices"));
  EXPECT_TRUE(has(refusal([] { list({{"a", "", {"one", "two"}}}, {{0.5}}); }), "none of the 2 choices"));
  EXPECT_TRUE(has(refusal([] { list({}, {}); }), "at least one column"));
  EXPECT_TRUE(has(refusal([] { uniform("k", "", 2.0, 1.0); }), "lower end first"));
  EXPECT_TRUE(has(refusal([] { uniform("k", "", 0.0, infinite); }), "lower end first"));
  EXPECT_TRUE(has(refusal([] { log_uniform("k", "", 0.0, 1.0); }), "must be positive and finite"));
  EXPECT_TRUE(has(refusal([] { normal("k", "", 0.0, 0.0); }), "positive, finite standard deviation, but has 0 and 0"));
  EXPECT_TRUE(has(refusal([] { monte_carlo(0, 1, {uniform("k", "", 0.0, 1.0)}); }), "at least one point"));
  EXPECT_TRUE(has(refusal([] { latin_hypercube(3, 1, {}); }), "one column"));
  EXPECT_TRUE(has(refusal([] { latin_hypercube((1u << 20) + 1, 1, {uniform("k", "", 0.0, 1.0)}); }), "1048576"));
  Points const points = axis("step", "s", {1.0});
  EXPECT_TRUE(
      has(message_of<StudyUsageError>([&] { points[0]["stop"]; }), "no column \"stop\"; the points have \"step\""));
  EXPECT_TRUE(has(message_of<StudyUsageError>([&] { points[0].choice("step"); }), "contains numbers"));
}

TEST(StudySampling, TheGeneratorIsThatOfTheStandard) {
  // The 10000th number of std::mt19937_64 with its seed 5489 is 9981545732273789042  [ISO C++ 2020, rand.predef].
  Points const points = monte_carlo(10000, 5489, {uniform("u", "", 0.0, 1.0)});
  EXPECT_EQ(points.at(9999, 0), (double(std::uint64_t{9981545732273789042u} / 4096u) + 0.5) / 4503599627370496.0);
}

// Sums of the bits of samples, equal on every machine: x86-64, with g++ 12 and clang 16, -O0 … -O3, with and without
// fma.
std::uint64_t bits_of(Points const& points) {
  std::uint64_t sum = 0;
  for (double const x : points.values()) sum = 31 * sum + std::bit_cast<std::uint64_t>(x);
  return sum;
}

TEST(StudySampling, ASeedGivesTheSameBits) {
  std::vector<RandomAxis> const axes{uniform("a", "", -1.0, 3.0), log_uniform("b", "", 1e-3, 1e5),
                                     normal("c", "", 2.0, 0.3)};
  EXPECT_EQ(bits_of(monte_carlo(1000, 7, axes)), 12976568009904113546u);
  EXPECT_EQ(bits_of(latin_hypercube(1000, 7, axes)), 1496143916705127952u);
  EXPECT_NE(bits_of(monte_carlo(1000, 8, axes)), bits_of(monte_carlo(1000, 7, axes)));
}

TEST(StudySampling, ASmallMonteCarloSampleBeginsALargeOne) {
  std::vector<RandomAxis> const axes{uniform("a", "", 0.0, 1.0), normal("b", "", 0.0, 1.0)};
  Points const some = monte_carlo(20, 3, axes), more = monte_carlo(50, 3, axes);
  EXPECT_TRUE(std::equal(some.values().begin(), some.values().end(), more.values().begin()));
}

TEST(StudySampling, ALatinHypercubeHasOnePointInEachStratumOfEachAxis) {
  for (std::size_t const n : {1u, 2u, 7u, 64u, 1000u}) {
    Points const points = latin_hypercube(n, n, {uniform("a", "", 0.0, 1.0), uniform("b", "", 0.0, 1.0)});
    for (std::size_t j = 0; j < 2; ++j) {
      std::vector<int> in(n, 0);
      for (std::size_t i = 0; i < n; ++i) ++in.at(std::size_t(points.at(i, j) * double(n)));
      EXPECT_EQ(std::ranges::count(in, 1), std::ptrdiff_t(n));
    }
  }
}

// Strata of the axes are paired at random. Each of the 3! pairings of three has a probability of one sixth, within
// five standard deviations.
TEST(StudySampling, PairingsOfStrataAreEquallyProbable) {
  std::vector<int> count(6, 0);
  int const runs = 6000;
  for (int seed = 0; seed < runs; ++seed) {
    Points const p = latin_hypercube(3, std::uint64_t(seed), {uniform("a", "", 0.0, 3.0), uniform("b", "", 0.0, 3.0)});
    int place[3];
    for (std::size_t i = 0; i < 3; ++i) place[int(p.at(i, 0))] = int(p.at(i, 1));
    ++count[std::size_t(2 * place[0] + (place[1] > place[2] ? 1 : 0))];
  }
  for (int const n : count) EXPECT_NEAR(n, runs / 6.0, 5.0 * std::sqrt(runs * 5.0 / 36.0));
}

TEST(StudySampling, DistributionsHaveTheirMoments) {
  std::size_t const n = 4000;
  Points const p =
      latin_hypercube(n, 1, {uniform("a", "", 2.0, 6.0), log_uniform("b", "", 1e-2, 1e4), normal("c", "", 5.0, 0.5)});
  double mean[3] = {}, square[3] = {};
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < 3; ++j) {
      double const x = j == 1 ? std::log10(p.at(i, j)) : p.at(i, j);
      mean[j] += x / double(n);
      square[j] += x * x / double(n);
    }
  // Means of stratified samples have an error of at most one stratum. So have squares, except for the two outermost
  // strata of the normal distribution.
  EXPECT_NEAR(mean[0], 4.0, 4.0 / double(n));
  EXPECT_NEAR(square[0] - mean[0] * mean[0], 16.0 / 12.0, 0.01);
  EXPECT_NEAR(mean[1], 1.0, 6.0 / double(n));
  EXPECT_NEAR(square[1] - mean[1] * mean[1], 36.0 / 12.0, 0.02);
  EXPECT_NEAR(mean[2], 5.0, 1e-3);
  EXPECT_NEAR(square[2] - mean[2] * mean[2], 0.25, 2e-3);
}

TEST(StudySampling, OwnFunctionsAreAsGoodAsThoseOfTheCLibrary) {
  for (double x = 1e-300; x < 1e300; x *= 1.37) {
    EXPECT_NEAR(detail::portable_log(x), std::log(x), 4e-16 * std::max(1.0, std::abs(std::log(x))));
    double const l = std::log(x);
    EXPECT_NEAR(detail::portable_exp(l) / std::exp(l), 1.0, 1e-15);
  }
  EXPECT_EQ(detail::portable_exp(0.0), 1.0);
  EXPECT_EQ(detail::portable_log(1.0), 0.0);
  for (double u = 1e-15; u < 1.0; u = u < 0.01 ? 1.7 * u : u + 0.007) {
    double const x = detail::normal_quantile(u);
    EXPECT_NEAR(0.5 * std::erfc(-x / std::sqrt(2.0)) / u, 1.0, 1e-12) << u;
  }
  EXPECT_EQ(detail::normal_quantile(0.5), 0.0);
  EXPECT_NEAR(detail::normal_quantile(0.975), 1.959963984540054, 1e-14);  // [Abramowitz & Stegun 1964, Table 26.5]
  EXPECT_EQ(detail::normal_quantile(0.875), -detail::normal_quantile(0.125));
}

TEST(StudySampling, BoundsHoldWhereRoundingWouldPassThem) {
  RandomAxis const axis = log_uniform("k", "", 1e-3, 1e5);
  EXPECT_GE(axis.quantile(0x1p-53), 1e-3);
  EXPECT_LE(axis.quantile(1.0 - 0x1p-53), 1e5);
}

}  // namespace points_test
