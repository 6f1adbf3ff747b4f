// Constraint equations of positions and velocities enforced together, under generalised-α and HHT-α.

#include <gtest/gtest.h>

#include <polybody/integrators/generalised_alpha.hpp>
#include <polybody/testing/integrator_laws.hpp>

#include "support/held.hpp"
#include "support/integrator_cases.hpp"

using namespace polybody;
using namespace polybody::laws;

namespace stabilised_alpha_test {

std::vector<GeneralisedAlpha> both_dampings() {
  return {{.rho_inf = 0.8, .tolerance = 1e-11, .stabilised = true},
          {.rho_inf = 0.5, .tolerance = 1e-11, .stabilised = true}};
}
struct StabilisedAlphaOnBar {
  using Model = SwingingBar;
  static auto integrators() { return both_dampings(); }
  static constexpr double end_time = 0.5;
  static constexpr int steps = 32;
};
struct StabilisedAlphaOnTop {
  using Model = SlowTop;
  static auto integrators() { return both_dampings(); }
  static constexpr double end_time = 0.5;
  static constexpr int steps = 64;
};

}  // namespace stabilised_alpha_test

namespace polybody {
bool const stabilised_alpha_obey[] = {
    obeys<stabilised_alpha_test::StabilisedAlphaOnBar, IntegratorLaws>("StabilisedAlphaOnBar"),
    obeys<stabilised_alpha_test::StabilisedAlphaOnTop, IntegratorLaws>("StabilisedAlphaOnTop")};
}  // namespace polybody

namespace stabilised_alpha_test {

/// The largest constraint violations over a run of 1 s with steps of 0.01 s.
template <class Setup, class I>
Violation worst(Setup const& setup, I const& integrator) {
  State x = setup.start;
  System system(setup.model);
  Violation out;
  for (State const& now : simulate(setup.model, x, integrator, {.end_time = 1.0, .step = 0.01})) {
    Violation const open = largest_violation(system, now);
    out.position = std::max(out.position, open.position);
    out.velocity = std::max(out.velocity, open.velocity);
  }
  return out;
}

template <class Setup, class I>
void expect_both_rows_kept(char const* setup_is, Setup const& setup, I integrator) {
  integrator.stabilised = false;
  Violation const without = worst(setup, integrator);
  integrator.stabilised = true;
  Violation const with = worst(setup, integrator);
  EXPECT_LT(without.position, 1e-12);
  EXPECT_GT(without.velocity, 1e-6);  // the comparison requires a violation without stabilisation
  auto const claim = [&](std::string const& what) {
    return Claim{"I1", what + setup_is, By::closed_form, "rows hold",
                 std::string(I::name) + ", stabilised, h = 0.01 s"};
  };
  held_within(claim("violation of positions in 1 s, "), with.position, 1e-12, {.scale = 1.0});
  held_within(claim("violation of speeds in 1 s, "), with.velocity, 1e-11, {.scale = 1.0});
}

TEST(StabilisedAlpha, KeepsPositionsAndSpeedsOfAPendulumInEveryStep) {
  expect_both_rows_kept("swinging bar", SwingingBar(), GeneralisedAlpha{.tolerance = 1e-12});
  expect_both_rows_kept("swinging bar", SwingingBar(), HhtAlpha{.tolerance = 1e-12});
}

TEST(StabilisedAlpha, KeepsPositionsAndSpeedsOfATopInEveryStep) {
  expect_both_rows_kept("slow top", SlowTop(), GeneralisedAlpha{.tolerance = 1e-12});
}

// Second order of the multipliers (I2) without a correction of the initial velocities.
TEST(StabilisedAlpha, MultipliersConvergeAtSecondOrderFromTheFirstStep) {
  std::vector<double> errors;
  for (double const h : {0.02, 0.01, 0.005, 0.0025}) {
    SwingingBar bar;
    State x = bar.start;
    double worst = 0.0;
    for (State const& now :
         simulate(bar.model, x, GeneralisedAlpha{.tolerance = 1e-12, .stabilised = true}, {.end_time = 1.0, .step = h}))
      worst = std::max(worst, (now.lambda + bar.reaction(now.t)).norm());
    errors.push_back(worst);
  }
  EXPECT_GT(slopes(errors).back(), 1.9) << testing::PrintToString(errors);
}

TEST(StabilisedAlpha, WithoutRowsChangesNothing) {
  SprungBody body;
  State with = body.start, without = body.start;
  simulate(body.model, with, GeneralisedAlpha{.stabilised = true}, {.end_time = 0.5, .step = 0.01}).run();
  simulate(body.model, without, GeneralisedAlpha{}, {.end_time = 0.5, .step = 0.01}).run();
  EXPECT_EQ(with.q, without.q);
  EXPECT_EQ(with.v, without.v);
}

}  // namespace stabilised_alpha_test
