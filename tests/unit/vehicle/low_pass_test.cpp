// Low-pass filter of the pin force in the atlas.
#include "atlas/low_pass.hpp"

#include <gtest/gtest.h>

namespace low_pass_test {

double const cut_off = 30.0, omega = 2.0 * std::numbers::pi * cut_off;

// Amplitude of the filtered sine of this frequency [Hz] from 0.5 to 0.6 s.
double amplitude(double frequency) {
  atlas::LowPass filter(cut_off);
  double most = 0.0;
  for (int k = 0; k <= 12000; ++k) {
    double const t = 5e-5 * k, y = filter(t, std::sin(2.0 * std::numbers::pi * frequency * t));
    if (t > 0.5) most = std::max(most, std::abs(y));
  }
  return most;
}

// |H| = 1/√(1 + (f/f_c)⁴) of a Butterworth filter of second order.
TEST(LowPass, HasTheAmplitudesOfAButterworthFilter) {
  for (double const frequency : {5.0, 30.0, 90.0})
    EXPECT_NEAR(amplitude(frequency), 1.0 / std::sqrt(1.0 + std::pow(frequency / cut_off, 4)), 5e-4) << frequency;
}

TEST(LowPass, StartsAtZeroAndApproachesAConstant) {
  atlas::LowPass filter(cut_off);
  EXPECT_EQ(filter(0.0, 7.0), 0.0);
  double const t = 1e-3, decay = std::exp(-omega * t / std::sqrt(2.0)), turn = omega * t / std::sqrt(2.0);
  EXPECT_NEAR(filter(t, 7.0), 7.0 * (1.0 - decay * (std::cos(turn) + std::sin(turn))), 1e-12);  // step response
  EXPECT_NEAR(filter(0.5, 7.0), 7.0, 1e-12);
}

TEST(LowPass, DelaysARamp) {
  atlas::LowPass filter(cut_off);
  for (double const t : {0.0, 1e-3, 1.5e-3, 0.2}) filter(t, t);
  EXPECT_NEAR(filter(0.5, 0.5), 0.5 - std::sqrt(2.0) / omega, 1e-12);
}

// The samples of a linear signal may have any spacing.
TEST(LowPass, DoesNotDependOnTheSpacingOfALinearSignal) {
  atlas::LowPass coarse(cut_off), fine(cut_off);
  coarse(0.0, 0.0);
  for (int k = 0; k < 100; ++k) fine(1e-4 * k, 1e-4 * k);
  EXPECT_NEAR(coarse(1e-2, 1e-2), fine(1e-2, 1e-2), 1e-15);
}

}  // namespace low_pass_test
