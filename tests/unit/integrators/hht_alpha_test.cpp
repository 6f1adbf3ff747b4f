#include <polybody/integrators/generalised_alpha.hpp>

#include <gtest/gtest.h>

#include <polybody/testing/integrator_laws.hpp>

#include "support/held.hpp"
#include "support/integrator_cases.hpp"
#include "support/oscillator.hpp"
#include "support/refusal.hpp"

using namespace polybody;
using namespace polybody::laws;

namespace hht_alpha_test {

std::vector<HhtAlpha> every_damping() {
  return {{.alpha = -0.1, .tolerance = 1e-11}, {.alpha = -1.0 / 3.0, .tolerance = 1e-11}};
}
struct HhtAlphaOnBar {
  using Model = SwingingBar;
  static auto integrators() { return every_damping(); }
  static constexpr double end_time = 0.5;
  static constexpr int steps = 32;
};
struct HhtAlphaOnTop {
  using Model = SlowTop;
  static auto integrators() { return every_damping(); }
  static constexpr double end_time = 0.5;
  static constexpr int steps = 64;
};

}  // namespace hht_alpha_test

namespace polybody {
bool const hht_alpha_obey[] = {obeys<hht_alpha_test::HhtAlphaOnBar, IntegratorLaws>("HhtAlphaOnBar"),
                               obeys<hht_alpha_test::HhtAlphaOnTop, IntegratorLaws>("HhtAlphaOnTop")};
}  // namespace polybody

namespace hht_alpha_test {

// The equation as first published: a₁ + (1 + α) q₁ − α q₀ = 0 for ω = 1, with Newmark's q₁ and v₁. a₁ follows by hand
// [Hilber, Hughes & Taylor 1977, Eq. 1–4]. Damping and period of every step follow from it.
TEST(HhtAlpha, SolvesThePublishedEquationsOfAnOscillator) {
  for (double const alpha : {-1.0 / 3.0, -0.1, -0.05}) {
    double const beta = 0.25 * (1.0 - alpha) * (1.0 - alpha), gamma = 0.5 - alpha;  // linear oscillator (I1)
    double const h = 0.2;
    double q = 1.0, v = 0.0, a = -1.0;
    for (int i = 0; i < 50; ++i) {
      double const known = q + h * v + h * h * (0.5 - beta) * a;
      double const next = (alpha * q - (1.0 + alpha) * known) / (1.0 + (1.0 + alpha) * beta * h * h);
      q = known + h * h * beta * next;
      v += h * ((1.0 - gamma) * a + gamma * next);
      a = next;
    }
    Oscillator o;
    o.run(HhtAlpha{.alpha = alpha, .start_correction = false}, h, 50);
    auto const claim = [](char const* what) {
      return Claim{"I1", what, By::closed_form, "Hilber, Hughes & Taylor 1977, solved by hand", "HHT-α, ωh = 0.2"};
    };
    held(claim("place of the oscillator after 50 steps"), o.x.q[0], q, 1e-12, {equals("α", alpha), 1.0});
    held(claim("speed of the oscillator after 50 steps"), o.x.v[0], v, 1e-12, {equals("α", alpha), 1.0});
  }
}

// Trapezoidal rule of the linear oscillator (I1), in closed form.
TEST(HhtAlpha, AtZeroIsTheTrapezoidalRule) {
  for (auto const& p : trapezoidal_periods) {
    Oscillator o;
    o.run(HhtAlpha{.alpha = 0.0, .start_correction = false}, p.h, 100);
    held_trapezoidal(o, p, "HHT-α, α = 0");
  }
}

// The spectral radius is (1 + α)/(1 − α) for ωh → ∞ (I1) with a double root, so |q| falls like n ρⁿ. At α = −1/3 the
// third root α/(1 + α) also equals −1/2, and |q| falls like n² ρⁿ.
TEST(HhtAlpha, DampsTheUnresolvedByItsSpectralRadius) {
  for (double const alpha : {-0.05, -0.1, -0.2}) {
    double const rho = (1.0 + alpha) / (1.0 - alpha);
    double const per_step = Oscillator().scale_of_a_long_step(HhtAlpha{.alpha = alpha, .start_correction = false});
    held({"I1", "factor of a step of ωh = 1e5, of a double root", By::closed_form, "(1 + α)/(1 − α) (30/20)^0.1",
          "HHT-α"},
         per_step, rho * std::pow(30.0 / 20.0, 0.1), 0.03 * rho, {equals("α", alpha)});
  }
}

// The energy decays (I3). Within a swing the energy of q and v differs by O((ωh)²) from the energy that the method
// dissipates. This difference alternates with the kinetic and potential energy, so each state is compared with the
// state half a period earlier.
template <class Setup>
void expect_decay(Setup const& setup, State x, double period) {
  int const half = 64;
  auto run = simulate(setup.model, x, HhtAlpha{.alpha = -0.1, .tolerance = 1e-12},
                      {.end_time = 6.0 * period, .step = 0.5 * period / half});
  std::vector<double> energies;
  for (State const& now : run) energies.push_back(energy(setup.model, now).total());
  ASSERT_GE(energies.size(), 12u * half);
  for (std::size_t i = half; i < energies.size(); ++i) EXPECT_LT(energies[i], energies[i - half]) << i;
}

TEST(HhtAlpha, TakesEnergyFromASpring) {
  Oscillator const o;
  expect_decay(o, o.x, 2.0 * std::numbers::pi);
}

TEST(HhtAlpha, TakesEnergyFromAPendulum) {
  SwingingBar const bar;
  expect_decay(bar, bar.start, bar.exact.period());
}

TEST(HhtAlpha, RefusesWhatItCannotMean) {
  for (double const alpha : {-0.34, 0.01, std::numeric_limits<double>::quiet_NaN()}) {
    Oscillator o;
    EXPECT_TRUE(has(refusal([&] { o.run(HhtAlpha{.alpha = alpha}, 0.1, 1); }), "HhtAlpha: alpha must lie in [-1/3, 0]"))
        << alpha;
  }
  Oscillator o;
  EXPECT_TRUE(
      has(refusal([&] { o.run(HhtAlpha{.tolerance = 0.0}, 0.1, 1); }), "HhtAlpha: the tolerance must be positive"));
}

}  // namespace hht_alpha_test
