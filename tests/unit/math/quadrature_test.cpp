#include <polybody/math/element_functions.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <utility>

using namespace polybody;

namespace quadrature_test {

/// Runs `test` with n = 1 … 10 as a compile-time number.
template <class Test>
void for_each_rule(Test&& test) {
  [&]<int... i>(std::integer_sequence<int, i...>) {
    (test(std::integral_constant<int, i + 1>{}), ...);
  }(std::make_integer_sequence<int, 10>{});
}

template <int n>
double integral_of_power(int k) {
  double sum = 0.0;
  for (GaussPoint const& p : gauss<n>) sum += p.weight * std::pow(p.xi, k);
  return sum;
}

TEST(Quadrature, WeightsArePositiveAndAddUpToOne) {
  for_each_rule([](auto n) {
    double sum = 0.0;
    for (GaussPoint const& p : gauss<n()>) {
      EXPECT_GT(p.weight, 0.0);
      sum += p.weight;
    }
    EXPECT_NEAR(sum, 1.0, 1e-15) << n();
  });
}

TEST(Quadrature, PointsLieInsideInOrderAndSymmetric) {
  for_each_rule([](auto n) {
    for (int i = 0; i < n(); ++i) {
      GaussPoint const p = gauss<n()>[i], mirror = gauss<n()>[n() - 1 - i];
      EXPECT_GT(p.xi, i == 0 ? 0.0 : gauss<n()>[i == 0 ? 0 : i - 1].xi);
      EXPECT_LT(p.xi, 1.0);
      EXPECT_NEAR(p.xi + mirror.xi, 1.0, 1e-15) << n() << ' ' << i;
      EXPECT_NEAR(p.weight, mirror.weight, 1e-15) << n() << ' ' << i;
    }
  });
}

TEST(Quadrature, IsExactUpToDegreeTwiceNMinusOne) {
  for_each_rule([](auto n) {
    for (int k = 0; k < 2 * n(); ++k)
      EXPECT_NEAR(integral_of_power<n()>(k), 1.0 / (k + 1), 1e-15) << n() << " points, degree " << k;
  });
}

// The first degree that fails has the exact error E = (n!)⁴/((2n + 1) (2n)!²) [Abramowitz & Stegun 1964, 25.4.30, on
// an interval of length one].
TEST(Quadrature, MissesDegreeTwiceNByTheKnownRemainder) {
  for_each_rule([](auto n) {
    double const ratio = std::exp(2.0 * std::lgamma(n() + 1.0) - std::lgamma(2.0 * n() + 1.0));
    double const remainder = ratio * ratio / (2 * n() + 1);
    double const missed = 1.0 / (2 * n() + 1) - integral_of_power<n()>(2 * n());
    EXPECT_GT(remainder, 1e-12);  // far above round-off
    EXPECT_NEAR(missed, remainder, 1e-3 * remainder + 1e-15) << n();
  });
}

// Points of [Abramowitz & Stegun 1964, Table 25.4], transformed from [−1, 1] to [0, 1].
TEST(Quadrature, HasTheKnownPoints) {
  EXPECT_EQ(gauss<1>[0].xi, 0.5);
  EXPECT_EQ(gauss<1>[0].weight, 1.0);
  EXPECT_NEAR(gauss<2>[1].xi, 0.5 * (1.0 + 1.0 / std::sqrt(3.0)), 4e-16);
  EXPECT_NEAR(gauss<2>[1].weight, 0.5, 4e-16);
  EXPECT_NEAR(gauss<3>[0].xi, 0.5 * (1.0 - std::sqrt(0.6)), 4e-16);
  EXPECT_NEAR(gauss<3>[1].xi, 0.5, 4e-16);
  EXPECT_NEAR(gauss<3>[0].weight, 5.0 / 18.0, 4e-16);
  EXPECT_NEAR(gauss<3>[1].weight, 8.0 / 18.0, 4e-16);
  EXPECT_NEAR(gauss<5>[4].xi, 0.5 * (1.0 + 0.906179845938664), 1e-15);
  EXPECT_NEAR(gauss<5>[4].weight, 0.5 * 0.236926885056189, 1e-15);
  EXPECT_NEAR(gauss<10>[9].xi, 0.5 * (1.0 + 0.973906528517172), 1e-15);
  EXPECT_NEAR(gauss<10>[9].weight, 0.5 * 0.066671344308688, 1e-15);
}

TEST(Quadrature, IsAConstantOfTheCompiler) {
  static_assert(gauss<3>.size() == 3);
  static_assert(gauss<3>[2].xi > 0.88 && gauss<3>[2].xi < 0.89);
  auto const offered = []<int n>(std::integral_constant<int, n>) { return requires { gauss<n>; }; };
  EXPECT_TRUE(offered(std::integral_constant<int, 10>{}));
  EXPECT_FALSE(offered(std::integral_constant<int, 0>{}));
  EXPECT_FALSE(offered(std::integral_constant<int, 11>{}));
}

}  // namespace quadrature_test
