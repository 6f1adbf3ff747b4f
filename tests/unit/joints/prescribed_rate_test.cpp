#include <polybody/joints/driving_constraints.hpp>
#include <polybody/math/smooth_table.hpp>

#include <gtest/gtest.h>

#include "support/refusal.hpp"

using namespace polybody;

namespace prescribed_rate_test {

Frame<double> turned(double angle) { return {.A = exp_so3<double>(Vec3(0, 0, angle))}; }

static_assert(HasIntegral<Ramp> && HasIntegral<SmoothRamp> && HasIntegral<Constant> && HasIntegral<SmoothTable>);
template <class Law>
concept CanDriveARate = requires { typename PrescribedRate<Law>; };
static_assert(CanDriveARate<SmoothRamp> && !CanDriveARate<SpinUp> && !CanDriveARate<int>);

// Run-up of the sprocket [Wallin 2016] (C8): at rest for one second, 25 rad/s after eight. A ramp that is
// symmetric about its middle covers half of 25 · 7, so ψ(8) = 87.5, ψ(10) = 137.5.
TEST(PrescribedRate, HoldsTheAngleOfTheSprocket) {
  PrescribedRate<SmoothRamp> const drive{.law = {{.target = 25.0, .duration = 7.0, .start = 1.0}}};
  for (auto const& [t, psi, omega] :
       {std::array{0.5, 0.0, 0.0}, {1.0, 0.0, 0.0}, {8.0, 87.5, 25.0}, {10.0, 137.5, 25.0}}) {
    EXPECT_NEAR(constraint_function<double>(drive, turned(0.2), turned(0.2 + psi), t).g[0], 0.0, 1e-12) << t;
    EXPECT_NEAR(constraint_function<double>(drive, turned(0.2), turned(0.3 + psi), t).g[0], 0.1, 1e-12) << t;
    EXPECT_NEAR(constraint_function<double>(drive, turned(0.0), turned(0.0), t).rate[0], -omega, 1e-13) << t;
  }
}

// A jump of the angular velocity is a breakpoint of the angle, and permitted.
TEST(PrescribedRate, BeginsAtZeroAndTellsTheCornersOfItsLaw) {
  PrescribedRate<Ramp> const drive{.law = {{.target = 6.0, .duration = 2.0, .start = -1.0}}};
  EXPECT_EQ(drive.breakpoints(), (std::vector{-1.0, 1.0}));
  EXPECT_NO_THROW(drive.check("\"drive\""));
  EXPECT_EQ(constraint_function<double>(drive, turned(0.0), turned(0.0), 0.0).g[0], 0.0);
  // ω = 3 (1 + t) up to t = 1, then 6: ψ(1) = 4.5, ψ(2) = 10.5
  EXPECT_NEAR(constraint_function<double>(drive, turned(0.0), turned(4.5), 1.0).g[0], 0.0, 1e-14);
  EXPECT_NEAR(constraint_function<double>(drive, turned(0.0), turned(10.5), 2.0).g[0], 0.0, 1e-14);
}

TEST(PrescribedRate, RefusesALawThatCannotBeMeant) {
  PrescribedRate<SmoothRamp> const drive{.law = {{.target = 1.0, .duration = 0.0}}};
  EXPECT_TRUE(has(refusal([&] { drive.check("\"drive\""); }), "\"drive\": the time function: the duration"));
}

}  // namespace prescribed_rate_test
