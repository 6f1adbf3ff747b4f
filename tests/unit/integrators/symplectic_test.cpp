#include <polybody/integrators/symplectic.hpp>

#include <gtest/gtest.h>

#include <polybody/testing/integrator_laws.hpp>

#include "support/held.hpp"
#include "support/integrator_cases.hpp"
#include "support/refusal.hpp"

using namespace polybody;
using namespace polybody::laws;

namespace symplectic_test {

struct SymplecticEulerOnFreeBody {
  using Model = SprungBody;
  static auto integrators() { return std::vector<SymplecticEuler>(1); }
  static constexpr double end_time = 1.0;
  static constexpr int steps = 128;
};
struct RattleOnBar {
  using Model = SwingingBar;
  static auto integrators() { return std::vector<Rattle>(1); }
  static constexpr double end_time = 0.5;
  static constexpr int steps = 32;
  static constexpr bool keeps_accelerations = false;  // the accelerations belong to the predicted velocities
};
struct RattleOnTop {
  using Model = SlowTop;
  static auto integrators() { return std::vector<Rattle>(1); }
  static constexpr double end_time = 0.5;
  static constexpr int steps = 64;
  static constexpr bool keeps_accelerations = false;  // the accelerations belong to the predicted velocities
};

}  // namespace symplectic_test

namespace polybody {
bool const symplectic_obey[] = {
    obeys<symplectic_test::SymplecticEulerOnFreeBody, IntegratorLaws>("SymplecticEulerOnFreeBody"),
    obeys<symplectic_test::RattleOnBar, IntegratorLaws>("RattleOnBar"),
    obeys<symplectic_test::RattleOnTop, IntegratorLaws>("RattleOnTop")};
}  // namespace polybody

namespace symplectic_test {

// A mass on a spring, x¨ = −ω² x. With v₁ = v₀ − hω² x₀, x₁ = x₀ + h v₁ the form v² + ω² x² − hω² x v is constant:
// v₁² + ω² x₁² − hω² x₁ v₁ = v₁² + ω² x₀² + hω² x₀ v₁ = v₁ v₀ + ω² x₀² = v₀² + ω² x₀² − hω² x₀ v₀.
TEST(SymplecticEuler, KeepsTheQuadraticFormOfAnOscillator) {
  Model<Bodies<planar::Rigid>, Joints<>, Forces<SpringDamper>> model;
  auto const mass = model.add(planar::Rigid(1.0, 1.0, Placement::planar(1.0, 0.0)), "mass");
  model.apply(SpringDamper{.stiffness = 25.0, .free_length = 0.0}, model.ground().at({0, 0, 0}), mass.at(Vec2(0, 0)),
              "spring");
  State x = model.reference_state();
  double const h = 0.02, omega2 = 25.0;
  auto const form = [&] { return x.v[0] * x.v[0] + omega2 * x.q[0] * (x.q[0] - h * x.v[0]); };
  double const start = form();
  System system(model);
  SymplecticEuler const integrator;
  auto const method = method_of(integrator);
  auto workspace = method.workspace<DenseLu>(system);
  method.start(system, x, h, workspace);
  double worst = 0.0;
  for (int i = 0; i < 100000; ++i) {  // 1600 periods
    method.step(system, x, h, workspace);
    worst = std::max(worst, std::abs(form() - start));
  }
  held_within({"I3", "change of v² + ω² x² − hω² x v in 1e5 steps", By::closed_form, "invariant", "SymplecticEuler"},
              worst, 1e-9, {.scale = start});
  EXPECT_NEAR(x.t, 2000.0, 1e-6);
}

/// Largest energy error of the bar in each of `count` times 100 periods, h = period/100.
template <class I>
std::vector<double> energy_errors(I const& integrator, int count) {
  SwingingBar bar;
  System system(bar.model);
  auto const method = method_of(integrator);
  auto workspace = method.template workspace<DenseLu>(system);
  State x = bar.start;
  double const h = bar.exact.period() / 100.0, start = energy(bar.model, x).total();
  method.start(system, x, h, workspace);
  std::vector<double> errors;
  for (int n = 0; n < count; ++n) {
    double worst = 0.0;
    for (int i = 0; i < 10000; ++i) {
      method.step(system, x, h, workspace);
      system.evaluate(x.q, x.v, x.t);
      worst = std::max(worst, std::abs(energy(system, x).total() - start));
    }
    errors.push_back(worst);
  }
  return errors;
}

// The energy error in the sixth hundred periods is not larger than in the first. The bar swings through m g l (1 −
// cos 2) ≈ 7 J.
TEST(Rattle, EnergyErrorStaysBounded) {
  auto const errors = energy_errors(Rattle{}, 6);
  held_within({"I3", "change of energy of the swinging bar in 100 periods [J]", By::closed_form, "invariant",
               "Rattle, 100 steps a period"},
              errors.front(), 0.05, {.scale = 7.0});
  EXPECT_GT(errors.front(), 1e-6);
  EXPECT_NEAR(errors.back() / errors.front(), 1.0, 0.01) << testing::PrintToString(errors);
}

// A method is symmetric if a step of −h reverses a step of h: Rattle with −h returns to the start.
TEST(Rattle, IsItsOwnInverse) {
  SwingingBar bar;
  System system(bar.model);
  Rattle const integrator;
  auto const method = method_of(integrator);
  auto workspace = method.workspace<DenseLu>(system);
  State x = bar.start;
  double const h = 0.02;
  method.start(system, x, h, workspace);
  State const start = x;
  for (int i = 0; i < 20; ++i) method.step(system, x, h, workspace);
  EXPECT_GT((x.q - start.q).norm(), 0.1);
  for (int i = 0; i < 20; ++i) method.step(system, x, -h, workspace);
  Claim const back{"I3", "state after 20 steps forth and back", By::closed_form, "the start", "Rattle"};
  held_within(back, (x.q - start.q).norm(), 1e-9, {"places", 1.0});
  held_within(back, (x.v - start.v).norm(), 1e-9, {"speeds", 1.0});
}

TEST(Rattle, SaysThatThePositionsCannotBeBroughtToTheJoints) {
  SwingingBar bar;
  System system(bar.model);
  Rattle const integrator{.max_iterations = 1};
  auto const method = method_of(integrator);
  auto workspace = method.workspace<DenseLu>(system);
  State x = bar.start;
  method.start(system, x, 0.3, workspace);
  State const before = x;
  EXPECT_TRUE(has(message_of<NewtonConvergenceFailure>([&] { method.step(system, x, 0.3, workspace); }),
                  "Take a smaller step"));
  EXPECT_EQ(x.q, before.q);
  State fresh = bar.start;
  EXPECT_TRUE(
      has(refusal([&] { simulate(bar.model, fresh, Rattle{.tolerance = 0.0}, {.end_time = 1.0, .step = 0.1}); }),
          "Rattle: the tolerance must be positive"));
}

}  // namespace symplectic_test
