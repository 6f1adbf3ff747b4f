// Differences of histories.
#include <gtest/gtest.h>

#include <polybody/signals/samples.hpp>

#include <numbers>

#include "support/refusal.hpp"

using namespace polybody;

namespace rms_difference_test {

struct Sampled {
  std::vector<double> t, y;
  operator Samples() const { return {t, y}; }
};

Sampled sampled(double end_time, int n, auto&& f) {
  Sampled s;
  for (int i = 0; i <= n; ++i) {
    s.t.push_back(end_time * i / n);
    s.y.push_back(f(s.t.back()));
  }
  return s;
}

double wave(double t) { return std::sin(2.0 * std::numbers::pi * t); }

// Relative difference of sin and 1.1 sin: a tenth; of sin and sin shifted by φ: 2 sin(φ/2).
TEST(RmsDifference, OfWaves) {
  auto const apart = [](Sampled const& a, Sampled const& b) {
    RmsDifference d(0.0, 10.0);
    d.add(a, b);
    return d.value();
  };
  Sampled const b = sampled(5.0, 5000, wave);
  EXPECT_NEAR(apart(sampled(5.0, 5000, [](double t) { return 1.1 * wave(t); }), b), 0.1, 1e-12);
  EXPECT_NEAR(apart(sampled(5.0, 5000, [](double t) { return wave(t + 0.05); }), b),
              2.0 * std::sin(0.05 * std::numbers::pi), 1e-4);
  EXPECT_NEAR(apart(b, b), 0.0, 1e-15);
}

// Half of the step, and steps without a common multiple. The interpolation is linear, with an error of at most
// (2πh)²/8.
TEST(RmsDifference, OfOtherSteps) {
  Sampled const b = sampled(5.0, 1000, wave);
  for (auto const& [n, within] : {std::pair(2000, 1e-12), {1370, 1e-4}, {777, 4e-4}}) {
    RmsDifference d(0.0, 5.0);
    d.add(sampled(5.0, n, wave), b);
    EXPECT_LT(d.value(), within) << n;
    EXPECT_EQ(d.samples(), 1001u);
  }
}

TEST(RmsDifference, OfVectorsIsThatOfTheirLengths) {
  Sampled const x = sampled(1.0, 10, [](double) { return 3.0; }), y = sampled(1.0, 10, [](double) { return 4.0; });
  Sampled const x1 = sampled(1.0, 10, [](double) { return 3.3; }), y1 = sampled(1.0, 10, [](double) { return 3.6; });
  RmsDifference d(0.0, 1.0);
  d.add(x1, x);
  d.add(y1, y);
  EXPECT_NEAR(d.value(), 0.1, 1e-12);
}

TEST(RmsDifference, CountsTheTimeAskedForAndWhatBothHave) {
  auto const step = [](double t) { return t < 0.45 ? 1.0 : 2.0; };
  Sampled const b = sampled(1.0, 10, [](double) { return 1.0; }), a = sampled(1.0, 10, step),
                shorter = sampled(0.7, 7, step);
  RmsDifference before(0.0, 0.4), after(0.5, 1.0), both(0.0, 2.0);
  before.add(a, b);
  after.add(a, b);
  both.add(shorter, b);
  EXPECT_EQ(before.value(), 0.0);
  EXPECT_NEAR(after.value(), 1.0, 1e-12);
  EXPECT_EQ(both.samples(), 8u);
  EXPECT_NEAR(both.value(), std::sqrt(3.0 / 8.0), 1e-12);
}

TEST(RmsDifference, RefusesWhatCannotBeCompared) {
  Sampled const b = sampled(1.0, 10, wave);
  Sampled shorter = b, back = b, wild = b;
  shorter.t.pop_back();
  back.t[3] = back.t[2];
  wild.y[4] = std::numeric_limits<double>::quiet_NaN();
  RmsDifference d(2.0, 3.0), zero(0.0, 1.0);
  EXPECT_TRUE(has(refusal([&] { d.add(shorter, b); }), "10 times, but 11 values"));
  EXPECT_TRUE(has(refusal([&] { d.add(b, back); }), "times must increase, but t = 0.2 s follows 0.2 s"));
  EXPECT_TRUE(has(refusal([&] { d.add(wild, b); }), "sample 4 at t = 0.4 s is not finite"));
  d.add(b, b);
  EXPECT_TRUE(has(refusal([&] { (void)d.value(); }), "no sample between 2 s and 3 s within the times of the first"));
  zero.add(b, sampled(1.0, 10, [](double) { return 0.0; }));
  EXPECT_TRUE(has(refusal([&] { (void)zero.value(); }), "is zero"));
}

}  // namespace rms_difference_test
