#include <polybody/integrators/generalised_alpha.hpp>

#include <gtest/gtest.h>

#include <polybody/testing/integrator_laws.hpp>

#include "support/held.hpp"
#include "support/integrator_cases.hpp"
#include "support/oscillator.hpp"
#include "support/refusal.hpp"

using namespace polybody;
using namespace polybody::laws;

namespace generalized_alpha_test {

std::vector<GeneralisedAlpha> every_damping() {
  return {
      {.rho_inf = 1.0, .tolerance = 1e-11}, {.rho_inf = 0.8, .tolerance = 1e-11}, {.rho_inf = 0.5, .tolerance = 1e-11}};
}
struct GeneralizedAlphaOnBar {
  using Model = SwingingBar;
  static auto integrators() { return every_damping(); }
  static constexpr double end_time = 0.5;
  static constexpr int steps = 32;
};
struct GeneralizedAlphaOnTop {
  using Model = SlowTop;
  static auto integrators() { return every_damping(); }
  static constexpr double end_time = 0.5;
  static constexpr int steps = 64;
};
struct GeneralizedAlphaOnSprungBody {
  using Model = SprungBody;
  static auto integrators() { return every_damping(); }
  static constexpr double end_time = 1.0;
  static constexpr int steps = 32;
};

}  // namespace generalized_alpha_test

namespace polybody {
bool const generalized_alpha_obey[] = {
    obeys<generalized_alpha_test::GeneralizedAlphaOnBar, IntegratorLaws>("GeneralizedAlphaOnBar"),
    obeys<generalized_alpha_test::GeneralizedAlphaOnTop, IntegratorLaws>("GeneralizedAlphaOnTop"),
    obeys<generalized_alpha_test::GeneralizedAlphaOnSprungBody, IntegratorLaws>("GeneralizedAlphaOnSprungBody")};
}  // namespace polybody

namespace generalized_alpha_test {

// Linear oscillator (I1): 50 steps of ωh = 0.2 with a₀ = q̈₀, computed independently with the parameters of Chung &
// Hulbert 1993.
TEST(GeneralisedAlpha, GivesThePublishedDigitsOfTheOscillator) {
  struct {
    double rho, q, hv;
  } const published[] = {{1.0, -0.856633663659, 0.103185031140},
                         {0.9, -0.856840551864, 0.103112687841},
                         {0.8, -0.857527990868, 0.102860652913},
                         {0.5, -0.863643772912, 0.100216543917},
                         {0.0, -0.887774657662, 0.077081882918}};
  for (auto const& p : published) {
    Oscillator o;
    RunReport const report = o.run(GeneralisedAlpha{.rho_inf = p.rho, .start_correction = false}, 0.2, 50);
    auto const claim = [](char const* what) {
      return Claim{"I1", what, By::independent, "formulas of Arnold & Brüls, programmed apart",
                   "generalised-α, ωh = 0.2"};
    };
    held(claim("place of the oscillator after 50 steps"), o.x.q[0], p.q, 1e-12, {equals("ρ", p.rho)});
    held(claim("h times the speed of the oscillator after 50 steps"), 0.2 * o.x.v[0], p.hv, 1e-12,
         {equals("ρ", p.rho)});
    EXPECT_EQ(report.factorisations, 1);  // a linear model needs one matrix
  }
}

// Trapezoidal rule (I1): for ρ∞ = 1 the phase advances by 2 atan(ωh/2) per step, for any h.
TEST(GeneralisedAlpha, WithoutDampingIsTheTrapezoidalRule) {
  for (auto const& p : trapezoidal_periods) {
    int const n = 100;
    Oscillator o;
    o.run(GeneralisedAlpha{.rho_inf = 1.0, .start_correction = false}, p.h, n);
    held_trapezoidal(o, p, "generalised-α, ρ = 1");
  }
}

// ρ∞ is the spectral radius for ωh → ∞. The root −ρ∞ is double, so |q| falls like n ρ∞ⁿ [Chung & Hulbert 1993].
TEST(GeneralisedAlpha, DampsTheUnresolvedByItsSpectralRadius) {
  for (double const rho : {0.9, 0.5, 0.2}) {
    double const per_step =
        Oscillator().scale_of_a_long_step(GeneralisedAlpha{.rho_inf = rho, .start_correction = false});
    held({"I1", "factor of a step of ωh = 1e5, of a double root", By::closed_form, "ρ (30/20)^0.1", "generalised-α"},
         per_step, rho * std::pow(30.0 / 20.0, 0.1), 0.03 * rho, {equals("ρ", rho)});
  }
}

TEST(GeneralisedAlpha, RefusesWhatItCannotMean) {
  for (double const rho : {-0.1, 1.0001, std::numeric_limits<double>::quiet_NaN()}) {
    Oscillator o;
    EXPECT_TRUE(has(refusal([&] { o.run(GeneralisedAlpha{.rho_inf = rho}, 0.1, 1); }), "rho_inf must lie in [0, 1]"))
        << rho;
  }
  for (double const tolerance : {0.0, -1e-8, std::numeric_limits<double>::infinity()}) {
    Oscillator o;
    EXPECT_TRUE(has(refusal([&] { o.run(GeneralisedAlpha{.tolerance = tolerance}, 0.1, 1); }),
                    "the tolerance must be positive"));
  }
}

TEST(GeneralisedAlpha, RefusesAStepWithoutAStart) {
  Oscillator o;
  System system(o.model);
  GeneralisedAlpha const integrator;
  auto const method = method_of(integrator);
  auto workspace = method.workspace<DenseLu>(system);
  EXPECT_TRUE(has(refusal([&] { method.step(system, o.x, 0.1, workspace); }), "The state has no integrator history"));
}

// The state contains the integrator history: a copy continues exactly like the original.
TEST(GeneralisedAlpha, CopyOfAStateGoesOnAsTheOriginal) {
  SwingingBar bar;
  System system(bar.model);
  GeneralisedAlpha const integrator{.tolerance = 1e-12, .newton = {.always_refactor = true}};
  auto const method = method_of(integrator);
  auto workspace = method.workspace<DenseLu>(system);
  State x = bar.start;
  method.start(system, x, 0.01, workspace);
  for (int i = 0; i < 10; ++i) method.step(system, x, 0.01, workspace);
  State copy = x;
  for (int i = 0; i < 10; ++i) method.step(system, x, 0.003, workspace);
  for (int i = 0; i < 10; ++i) method.step(system, copy, 0.003, workspace);
  EXPECT_EQ(copy.q, x.q);
  EXPECT_EQ(copy.v, x.v);
  EXPECT_EQ(copy.lambda, x.lambda);
}

}  // namespace generalized_alpha_test
