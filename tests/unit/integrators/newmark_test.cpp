#include <polybody/integrators/generalised_alpha.hpp>

#include <gtest/gtest.h>

#include <polybody/testing/integrator_laws.hpp>

#include "support/held.hpp"
#include "support/integrator_cases.hpp"
#include "support/oscillator.hpp"
#include "support/refusal.hpp"

using namespace polybody;
using namespace polybody::laws;

namespace newmark_test {

struct NewmarkOnBar {
  using Model = SwingingBar;
  static auto integrators() {
    return std::vector<Newmark>{{.gamma = 0.6, .beta = 0.25 * 1.1 * 1.1, .tolerance = 1e-11}};
  }
  static constexpr double end_time = 0.5;
  static constexpr int steps = 32;
};
struct TrapezoidalOnBar {
  using Model = SwingingBar;
  static auto integrators() { return std::vector<Trapezoidal>{{.tolerance = 1e-11}}; }
  static constexpr double end_time = 0.5;
  static constexpr int steps = 32;
};
struct TrapezoidalOnSprungBody {
  using Model = SprungBody;
  static auto integrators() { return std::vector<Trapezoidal>{{.tolerance = 1e-11}}; }
  static constexpr double end_time = 1.0;
  static constexpr int steps = 32;
};

}  // namespace newmark_test

namespace polybody {
bool const newmark_obey[] = {obeys<newmark_test::NewmarkOnBar, IntegratorLaws>("NewmarkOnBar"),
                             obeys<newmark_test::TrapezoidalOnBar, IntegratorLaws>("TrapezoidalOnBar"),
                             obeys<newmark_test::TrapezoidalOnSprungBody, IntegratorLaws>("TrapezoidalOnSprungBody")};
}  // namespace polybody

namespace newmark_test {

// Linear oscillator (I1) in closed form.
template <class I>
void expect_published_periods(I const& integrator) {
  for (auto const& p : trapezoidal_periods) {
    Oscillator o;
    o.run(integrator, p.h, 100);
    held_trapezoidal(o, p, std::string(I::name));
  }
}

TEST(Trapezoidal, HasThePublishedPeriod) { expect_published_periods(Trapezoidal{.start_correction = false}); }

TEST(Newmark, UnlessToldOtherwiseIsTheTrapezoidalRule) { expect_published_periods(Newmark{}); }

/// The invariant of Newmark's method with γ = ½ for the oscillator with ω = 1: v² + q² + (β − γ/2) h² a².
double kept(Newmark const& integrator, double h, State const& x) {
  double const q = x.q[0], v = x.v[0], a = x.a[0];
  return v * v + q * q + (integrator.beta - 0.5 * integrator.gamma) * h * h * a * a;
}

// For γ = ½ and ω = 1, elimination of v from two steps gives q₂ − 2 q₁ + q₀ = −h² (β q₂ + (1 − 2β) q₁ + β q₀). The
// phase advances by φ per step, cos φ = 1 − ½h²/(1 + βh²). By the invariant of `kept`, v/√(1 + (β − ¼)h²) has the
// same phase.
TEST(Newmark, OscillatesInClosedFormWithoutDamping) {
  double const h = 0.7;
  for (double const beta : {1.0 / 12.0, 1.0 / 6.0, 0.25, 0.5}) {
    Oscillator o;
    o.run(Newmark{.beta = beta}, h, 40);
    double const phase = 40 * std::acos(1.0 - 0.5 * h * h / (1.0 + beta * h * h));
    auto const claim = [](char const* what, char const* source) {
      return Claim{"I1", what, By::closed_form, source, "Newmark, γ = ½, ωh = 0.7"};
    };
    held(claim("place of the oscillator after 40 steps", "cos φ = 1 − ½h²/(1 + βh²) a step"), o.x.q[0], std::cos(phase),
         1e-11, {equals("β", beta), 1.0});
    held(claim("speed of the oscillator after 40 steps", "−sin φ √(1 + (β − ¼)h²)"), o.x.v[0],
         -std::sin(phase) * std::sqrt(1.0 + (beta - 0.25) * h * h), 1e-11, {equals("β", beta), 1.0});
  }
}

// With κ = β − γ/2, v₁ − v₀ = h(ā + (γ − ½)Δa) and q₁ − q₀ = h v̄ + κh²Δa (bars: means of the ends). Then
//   v̄ Δv + q̄ Δq + κh² ā Δa = −(γ − ½)(Δq² + κh² Δa²)      for a = −q:
// the invariant of the undamped case falls by twice this amount in every step [Hughes 2000, §9.3].
TEST(Newmark, LosesEnergyInEveryStepAsDerived) {
  double const h = 0.3;
  for (double const gamma : {0.55, 0.8}) {
    Newmark const integrator{.gamma = gamma, .beta = 0.25 * (gamma + 0.5) * (gamma + 0.5)};
    double const kappa = integrator.beta - 0.5 * gamma;
    Oscillator o;
    State before = o.x, x = o.x;
    bool first = true;
    for (State const& now : simulate(o.model, x, integrator, {.end_time = 30 * h, .step = h})) {
      if (!first) {
        double const dq = now.q[0] - before.q[0], da = now.a[0] - before.a[0];
        double const loss = (2.0 * gamma - 1.0) * (dq * dq + kappa * h * h * da * da);
        held_within({"I3", "loss of energy in every step of an oscillator", By::closed_form, "(2γ − 1)(Δq² + κh² Δa²)",
                     "Newmark, ωh = 0.3"},
                    std::abs(kept(integrator, h, now) - kept(integrator, h, before) + loss), 1e-12,
                    {equals("γ", gamma), 1.0});
      }
      first = false;
      before = now;
    }
  }
}

// The loss of the previous test is (γ − ½)h of twice the kinetic energy in unit time: it has first order.
TEST(Newmark, DampedIsOfFirstOrderOnly) {
  std::vector<double> errors;
  for (int const n : {100, 200, 400}) {
    Oscillator o;
    o.run(Newmark{.gamma = 0.6, .beta = 0.3025}, 1.0 / n, n);
    errors.push_back(std::abs(o.x.q[0] - std::cos(1.0)));
  }
  EXPECT_NEAR(slopes(errors).back(), 1.0, 0.05) << testing::PrintToString(errors);
}

TEST(Newmark, RefusesWhatItCannotMean) {
  auto const try_with = [](Newmark const& integrator) {
    Oscillator o;
    return refusal([&] { o.run(integrator, 0.1, 1); });
  };
  EXPECT_TRUE(has(try_with({.gamma = 0.49}), "Newmark: gamma must be at least 1/2"));
  EXPECT_TRUE(
      has(try_with({.gamma = std::numeric_limits<double>::quiet_NaN()}), "Newmark: gamma must be at least 1/2"));
  EXPECT_TRUE(has(try_with({.beta = 0.0}), "take CentralDifference"));
  EXPECT_TRUE(has(try_with({.tolerance = -1.0}), "Newmark: the tolerance must be positive"));
}

}  // namespace newmark_test
