#include <polybody/math/tape.hpp>

#include <gtest/gtest.h>

#include <polybody/math/types.hpp>

#include "support/refusal.hpp"

using namespace polybody;

namespace recorded_test {

/// Every operation at least once, for three numbers.
template <class T>
T everything(T const& x, T const& y, T const& z) {
  T sum = x * y / z + 2.0 * x - y * 3.0 + 1.0 / z - (x - 0.5) + (0.5 - y) + x * 1.0 + y * 0.0;
  sum += sin(x) * cos(y) + tan(z) + asin(0.3 * x) + acos(0.3 * y) + atan(z) + atan2(x, y);
  sum -= exp(x) * log(y) + pow(z, 2.5) + tanh(x) + sqrt(y) + abs(-z) + abs2(x) + hypot(y, z);
  sum *= max(x, y) + min(y, z);
  sum /= 2.0 + (+x) - (-y);
  return sum;
}

TEST(ReverseVar, OneSweepGivesTheDerivativesOfDualNumbers) {
  double const at[3] = {0.7, 1.1, 0.4};
  Dual<3> const expected =
      everything(Dual<3>::variable(at[0], 0), Dual<3>::variable(at[1], 1), Dual<3>::variable(at[2], 2));
  Tape recording;
  Tape::On const on(recording);
  ReverseVar const x[3] = {ReverseVar::variable(at[0]), ReverseVar::variable(at[1]), ReverseVar::variable(at[2])};
  ReverseVar const result = everything(x[0], x[1], x[2]);
  EXPECT_DOUBLE_EQ(result.v, expected.v);
  recording.clear_derivatives(recording.size());
  recording.slope(result.number) = 1.0;
  recording.sweep(recording.size());
  for (int i = 0; i < 3; ++i)
    EXPECT_NEAR(recording.slope(x[i].number), expected.d[i], 1e-14 * (1.0 + std::abs(expected.d[i]))) << i;
}

TEST(ReverseVar, SweepsAddUpOverSeveralResultsAndMayBeRepeated) {
  Tape recording;
  Tape::On const on(recording);
  Vec<ReverseVar, 3> r;
  for (int i = 0; i < 3; ++i) r[i] = ReverseVar::variable(1.0 + i);
  ReverseVar const squares = r.dot(r), sum = r.sum();
  for (double const factor : {1.0, 4.0}) {
    recording.clear_derivatives(recording.size());
    recording.slope(squares.number) += factor;
    recording.slope(sum.number) += 10.0;
    recording.sweep(recording.size());
    for (int i = 0; i < 3; ++i) EXPECT_EQ(recording.slope(r[i].number), factor * 2.0 * (1.0 + i) + 10.0);
  }
}

TEST(ReverseVar, ConstantsAreRecordedNowhere) {
  Tape recording;
  Tape::On const on(recording);
  ReverseVar const x = ReverseVar::variable(2.0);
  std::size_t const before = recording.size();
  ReverseVar const c = ReverseVar(3.0) * 2.0 + sin(ReverseVar(1.0));
  EXPECT_EQ(c.number, 0);
  EXPECT_EQ((x + c).number, x.number);
  EXPECT_EQ((x * 1.0).number, x.number);
  EXPECT_EQ((x * 0.0).number, 0);
  EXPECT_EQ(recording.size(), before);
}

TEST(ReverseVar, OfOneRecordingInAnotherGoBackToTheFirst) {
  Tape outer, inner;
  Tape::On const on(outer);
  ReverseVar const x = ReverseVar::variable(2.0);
  {
    Tape::On const also(inner);
    (void)ReverseVar::variable(1.0);
    EXPECT_EQ(inner.size(), 2u);
  }
  (void)(x * x);
  EXPECT_EQ(outer.size(), 3u);
}

TEST(ReverseVar, WithoutARecordingAreRefused) {
  EXPECT_TRUE(has(refusal([] { (void)ReverseVar::variable(1.0); }), "no tape was active"));
}

}  // namespace recorded_test
