#include <polybody/math/types.hpp>

#include <gtest/gtest.h>

#include <string>

#include "support/refusal.hpp"

using namespace polybody;

namespace types_test {

double const nan_ = std::numeric_limits<double>::quiet_NaN();
double const infinity = std::numeric_limits<double>::infinity();

// A required number has no default, and reads as a plain number.
static_assert(!std::is_default_constructible_v<Required<double>>);
static_assert(std::is_convertible_v<double, Required<double>>);
static_assert(std::is_convertible_v<Required<double>, double>);
static_assert(std::is_convertible_v<decltype(Vec3::Zero()), Required<Vec3>>);  // an expression
static_assert(!std::is_convertible_v<std::string, Required<double>> && !std::is_convertible_v<Vec3, Required<double>>);

struct Asks {
  Required<double> mass;
  double damping = 0.0;
};
static_assert(std::is_aggregate_v<Asks> && !std::is_default_constructible_v<Asks>);

TEST(Required, ReadsAsItsNumber) {
  constexpr Asks asks{.mass = 2.5};
  static_assert(asks.mass * 2.0 == 5.0);
  EXPECT_EQ(asks.mass + asks.mass, 5.0);
}

TEST(Checks, PositiveRefusesZeroNegativeNanAndInfinity) {
  EXPECT_NO_THROW(require_positive(1e-300, "mass"));
  for (double const x : {0.0, -1.0, -infinity, infinity, nan_})
    EXPECT_TRUE(has(refusal([&] { require_positive(x, "rod: the mass"); }), "rod: the mass")) << x;
}

TEST(Checks, NotNegativeAllowsZero) {
  EXPECT_NO_THROW(require_not_negative(0.0, "GJ"));
  for (double const x : {-1e-300, -infinity, infinity, nan_})
    EXPECT_TRUE(has(refusal([&] { require_not_negative(x, "rod: GJ"); }), "rod: GJ")) << x;
}

TEST(Checks, FiniteLooksAtEveryEntry) {
  EXPECT_NO_THROW(require_finite(MatX::Ones(2, 5), "data"));
  for (double const x : {infinity, -infinity, nan_})
    for (int i = 0; i < 10; ++i) {
      MatX m = MatX::Ones(2, 5);
      m(i % 2, i / 2) = x;
      EXPECT_TRUE(has(refusal([&] { require_finite(m, "the data"); }), "the data")) << x << ' ' << i;
    }
}

TEST(Checks, UnitAllowsRoundingOnly) {
  EXPECT_NO_THROW(require_unit(Vec3(1, 1, 1).normalized(), "axis"));
  EXPECT_NO_THROW(require_unit(Vec3(1 + 1e-10, 0, 0), "axis"));
  for (Vec3 const& axis : {Vec3(1 + 1e-8, 0, 0), Vec3(0, 0, 0), Vec3(1, 1, 0), Vec3(nan_, 0, 1)})
    EXPECT_TRUE(has(refusal([&] { require_unit(axis, "pin: the axis"); }), "pin: the axis"));
  // the message contains the length
  EXPECT_TRUE(has(refusal([] { require_unit(Vec3(2, 0, 0), "axis"); }), "has length 2."));
}

TEST(Checks, FindTheLargestEntry) {
  VecX x(3);
  x << 1.0, -3.0, 2.0;
  EXPECT_EQ(largest_size(x), 3.0);
  x[0] = -infinity;
  EXPECT_EQ(largest_size(x), infinity);
  for (Index i = 0; i < 3; ++i) {  // a NaN in any entry is kept
    x << 1.0, -3.0, 2.0;
    x[i] = nan_;
    EXPECT_TRUE(std::isnan(largest_size(x))) << i;
  }
  EXPECT_EQ(largest_size(VecX()), 0.0);
}

}  // namespace types_test
