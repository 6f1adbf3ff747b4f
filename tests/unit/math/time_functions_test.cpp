#include <polybody/math/time_functions.hpp>

#include <gtest/gtest.h>

#include <cmath>

#include "support/refusal.hpp"

using namespace polybody;

namespace time_laws_test {

static_assert(TimeFunction<Ramp> && TimeFunction<SmoothRamp> && TimeFunction<SpinUp> && TimeFunction<Constant> &&
              TimeFunction<Window>);
static_assert(TimeFunction<decltype([](double t) { return Motion{t, 1.0, 0.0}; })>);
static_assert(!TimeFunction<int> && !TimeFunction<decltype([](double) { return "text"; })>);
static_assert(HasBreakpoints<Ramp> && HasBreakpoints<Window>);
static_assert(HasIntegral<Ramp> && HasIntegral<SmoothRamp> && HasIntegral<Constant> && !HasIntegral<Window>);
static_assert(!HasBreakpoints<SmoothRamp> && !HasBreakpoints<SpinUp> && !HasBreakpoints<Constant>);

/// Rate and acceleration of `law` at t against fourth-order differences of value and rate.
template <TimeFunction L>
void expect_consistent(L const& law, double t) {
  double const h = 1e-3;
  auto const slope = [&](double Motion::* x) {
    auto const at = [&](double time) { return law(time).*x; };
    return (8 * (at(t + h) - at(t - h)) - (at(t + 2 * h) - at(t - 2 * h))) / (12 * h);
  };
  EXPECT_NEAR(law(t).rate, slope(&Motion::value), 1e-10) << "t = " << t;
  EXPECT_NEAR(law(t).acceleration, slope(&Motion::rate), 1e-10) << "t = " << t;
}

/// Value, rate and acceleration agree just before t and at t.
template <TimeFunction L>
void expect_smooth(L const& law, double t) {
  Motion const before = law(t - 1e-9), at = law(t);
  EXPECT_NEAR(before.value, at.value, 1e-7);
  EXPECT_NEAR(before.rate, at.rate, 1e-7);
  EXPECT_NEAR(before.acceleration, at.acceleration, 1e-7);
}

void expect_motion(Motion const& m, double value, double rate, double acceleration) {
  EXPECT_DOUBLE_EQ(m.value, value);
  EXPECT_DOUBLE_EQ(m.rate, rate);
  EXPECT_DOUBLE_EQ(m.acceleration, acceleration);
}

TEST(Ramp, RateAndAccelerationFollowTheValue) {
  Ramp const law{.target = -3.0, .duration = 2.0, .start = 0.5};
  for (double const t : {0.0, 0.6, 1.5, 2.4, 3.0}) expect_consistent(law, t);
  EXPECT_DOUBLE_EQ(law(1.5).value, -1.5);
}

// At a breakpoint the piece that begins there applies.
TEST(Ramp, CornerBelongsToThePieceThatBegins) {
  Ramp const law{.target = -3.0, .duration = 2.0, .start = 0.5};
  expect_motion(law(0.5), 0.0, -1.5, 0.0);
  expect_motion(law(std::nextafter(0.5, 0.0)), 0.0, 0.0, 0.0);
  expect_motion(law(2.5), -3.0, 0.0, 0.0);
  EXPECT_DOUBLE_EQ(law(std::nextafter(2.5, 0.0)).rate, -1.5);
  EXPECT_EQ(law.breakpoints(), (std::vector{0.5, 2.5}));
}

// At a breakpoint the rounding parabola has covered (w/2)²/(2w) = w/8 of the ramp's rise per second. It removes at
// the end what it adds at the start. Hence the value and ∫ value dt after the ramp equal those of the sharp ramp.
TEST(Ramp, RoundedCornersLeaveTheRestAsItWas) {
  Ramp const sharp{.target = -3.0, .duration = 2.0, .start = 0.5},
      law{.target = -3.0, .duration = 2.0, .start = 0.5, .rounding = 0.2};
  for (double const t : {0.0, 0.45, 0.55, 0.8, 1.5, 2.45, 2.58, 3.0}) {
    expect_consistent(law, t);
    double const h = 1e-3;
    EXPECT_NEAR((law.integral(t + h) - law.integral(t - h)) / (2.0 * h), law(t).value, 1e-5) << "t = " << t;
  }
  for (double const t : {0.4, 0.6, 2.4, 2.6}) EXPECT_NEAR(law(t - 1e-9).rate, law(t + 1e-9).rate, 1e-7) << "t = " << t;
  for (double const t : {0.0, 0.4, 0.6, 1.5, 2.4, 2.6, 5.0})
    EXPECT_NEAR(law(t).value, sharp(t).value, 1e-14) << "t = " << t;
  EXPECT_NEAR(law(0.5).value, -1.5 * 0.2 / 8.0, 1e-15);
  EXPECT_NEAR(law(2.5).value, -3.0 + 1.5 * 0.2 / 8.0, 1e-15);
  EXPECT_NEAR(law.integral(5.0), sharp.integral(5.0), 1e-14);
  EXPECT_NEAR(sharp.integral(5.0), -3.0 * 3.5, 1e-14);
  EXPECT_TRUE(law.breakpoints().empty());
  Ramp const too_round{.target = 1.0, .duration = 1.0, .rounding = 1.1};
  EXPECT_TRUE(has(refusal([&] { check_time_function(too_round, "drive"); }), "drive: the rounding 1.1 s"));
}

TEST(SmoothRamp, RateAndAccelerationFollowTheValue) {
  SmoothRamp const law{.target = 0.7, .duration = 2.0, .start = 0.5};
  for (double const t : {0.0, 0.6, 1.1, 1.5, 2.4, 3.0}) expect_consistent(law, t);
  EXPECT_DOUBLE_EQ(law(1.5).value, 0.35);  // half of the rise, by symmetry
}

TEST(SmoothRamp, StartsAndEndsAtRestWithoutAJump) {
  SmoothRamp const law{.target = 0.7, .duration = 2.0, .start = 0.5};
  expect_smooth(law, 0.5);
  expect_smooth(law, 2.5);
  expect_motion(law(0.5), 0.0, 0.0, 0.0);
  expect_motion(law(2.5), 0.7, 0.0, 0.0);
}

// A ramp without duration is a step, never 0/0.
TEST(SmoothRamp, OfNoDurationIsAStep) {
  SmoothRamp const law{.target = 0.7, .duration = 0.0, .start = 0.5};
  expect_motion(law(0.4), 0.0, 0.0, 0.0);
  expect_motion(law(0.5), 0.7, 0.0, 0.0);
}

// Spin-up manoeuvre [Kane, Ryan & Banerjee 1987; Simo & Vu-Quoc 1986]: ψ = (6/15)[t²/2 + (15/2π)²(cos(2πt/15) − 1)]
// for t ≤ 15 s, then 6t − 45.
TEST(SpinUp, IsTheManoeuvreOfKaneRyanAndBanerjee) {
  SpinUp const law{.speed = 6.0, .duration = 15.0};
  double const pi = std::numbers::pi, k = 15.0 / (2.0 * pi);
  for (double const t : {0.1, 2.5, 7.5, 10.0, 14.9, 15.0})
    EXPECT_NEAR(law(t).value, 6.0 / 15.0 * (0.5 * t * t + k * k * (std::cos(2.0 * pi * t / 15.0) - 1.0)), 1e-12);
  EXPECT_NEAR(law(15.0).value, 45.0, 1e-12);
  expect_motion(law(18.0), 6.0 * 18.0 - 45.0, 6.0, 0.0);
  expect_motion(law(-1.0), 0.0, 0.0, 0.0);
}

TEST(SpinUp, RateAndAccelerationFollowTheValue) {
  SpinUp const law{.speed = 6.0, .duration = 15.0};
  for (double const t : {-1.0, 0.1, 2.5, 7.5, 14.0, 16.0}) expect_consistent(law, t);
  expect_smooth(law, 0.0);
  expect_smooth(law, 15.0);
}

TEST(Constant, NeverMoves) {
  expect_motion(Constant{.value = 2.5}(-7.0), 2.5, 0.0, 0.0);
  expect_motion(Constant{}(3.0), 1.0, 0.0, 0.0);
}

TEST(Window, IsClosedAtItsBeginAndOpenAtItsEnd) {
  Window const law{.from = 1.0, .to = 2.5, .value = -80.0};
  expect_motion(law(std::nextafter(1.0, 0.0)), 0.0, 0.0, 0.0);
  expect_motion(law(1.0), -80.0, 0.0, 0.0);
  expect_motion(law(std::nextafter(2.5, 0.0)), -80.0, 0.0, 0.0);
  expect_motion(law(2.5), 0.0, 0.0, 0.0);
  EXPECT_EQ(law.breakpoints(), (std::vector{1.0, 2.5}));
}

TEST(Window, IsOpenForeverUnlessToldOtherwise) {
  EXPECT_EQ(Window{}(1e300).value, 1.0);
  EXPECT_EQ(Window{}(-1e-300).value, 0.0);
}

// ∫ value dt by finite differences of the integral, and by symmetry its value at rest after the ramp.
template <HasIntegral L>
void expect_integral(L const& law, std::initializer_list<double> times) {
  double const h = 1e-3;
  for (double const t : times) {
    double const slope =
        (8 * (law.integral(t + h) - law.integral(t - h)) - (law.integral(t + 2 * h) - law.integral(t - 2 * h))) /
        (12 * h);
    EXPECT_NEAR(slope, law(t).value, 1e-10) << t;
  }
}

TEST(Ramps, IntegralsGrowByTheValue) {
  Ramp const ramp{.target = -3.0, .duration = 2.0, .start = 0.5};
  SmoothRamp const smooth{.target = -3.0, .duration = 2.0, .start = 0.5};
  expect_integral(ramp, {0.0, 0.6, 1.5, 2.4, 3.0});
  expect_integral(smooth, {0.0, 0.6, 1.5, 2.4, 3.0});
  expect_integral(Constant{.value = 2.5}, {-7.0, 3.0});
  for (double const whole : {ramp.integral(3.5), smooth.integral(3.5)}) EXPECT_DOUBLE_EQ(whole, -3.0 * (1.0 + 1.0));
}

TEST(IntegralOf, IsThePlaceOfASpeedFromTimeZero) {
  IntegralOf<SmoothRamp> const place{{.target = 0.7, .duration = 2.0, .start = -0.5}};
  EXPECT_EQ(place(0.0).value, 0.0);
  for (double const t : {0.0, 0.6, 1.1, 1.4, 3.0}) {
    expect_consistent(place, t);
    EXPECT_EQ(place(t).rate, place.law(t).value);
  }
  EXPECT_TRUE(place.breakpoints().empty());
  EXPECT_EQ(IntegralOf<Ramp>({{.target = 1.0, .duration = 2.0, .start = 0.5}}).breakpoints(), (std::vector{0.5, 2.5}));
}

TEST(TimeLaws, RefuseToDriveThroughAJump) {
  EXPECT_TRUE(has(refusal([] { check_driving_function(Window{.from = 1.0, .value = 2.0}, "drive"); }),
                  "drive: the value jumps from 0 to 2 at t = 1 s"));
  EXPECT_TRUE(has(refusal([] { check_driving_function(Ramp{.target = 1.0, .duration = 0.0}, "drive"); }),
                  "drive: the duration"));
  EXPECT_NO_THROW(check_driving_function(Ramp{.target = 1e3, .duration = 1e-2, .start = 10.0}, "drive"));
  EXPECT_NO_THROW(check_driving_function(Constant{}, "drive"));
}

TEST(TimeLaws, RefuseNumbersThatCannotBeMeant) {
  double const nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(has(refusal([] { check_time_function(Ramp{.target = 1.0, .duration = 0.0}, "drive"); }),
                  "drive: the duration must be positive and finite, but is 0 s."));
  EXPECT_TRUE(has(refusal([] { check_time_function(SmoothRamp{.target = 1.0, .duration = -2.5}, "drive"); }),
                  "but is -2.5 s."));
  EXPECT_TRUE(
      has(refusal([&] { check_time_function(SmoothRamp{.target = nan, .duration = 1.0}, "drive"); }), "target"));
  EXPECT_TRUE(
      has(refusal([&] { check_time_function(Ramp{.target = 1.0, .duration = 1.0, .start = nan}, "drive"); }), "start"));
  EXPECT_TRUE(
      has(refusal([&] { check_time_function(SpinUp{.speed = 1.0, .duration = nan}, "hub"); }), "hub: the duration"));
  EXPECT_TRUE(
      has(refusal([] { check_time_function(Window{.from = 2.0, .to = 1.0}, "load"); }), "from = 2 s, to = 1 s"));
  EXPECT_TRUE(has(refusal([&] { check_time_function(Window{.value = nan}, "load"); }), "finite value"));
  EXPECT_NO_THROW(check_time_function(Window{}, "load"));
  EXPECT_NO_THROW(check_time_function([](double t) { return Motion{t, 1.0, 0.0}; }, "a lambda is not asked"));
}

}  // namespace time_laws_test
