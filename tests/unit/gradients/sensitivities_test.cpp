#include <polybody/gradients/sensitivities.hpp>

#include <gtest/gtest.h>

#include <polybody/bodies/ancf/planar_ancf_cable.hpp>
#include <polybody/bodies/rigid/planar_rigid.hpp>
#include <polybody/forces/springs.hpp>
#include <polybody/integrators/generalised_alpha.hpp>
#include <polybody/joints/planar/joints.hpp>
#include <polybody/joints/policies/policy.hpp>
#include <polybody/run/probe.hpp>

#include "support/differences_of_runs.hpp"
#include "support/refusal.hpp"

using namespace polybody;

namespace sensitivities_test {

using Pin = Joint<planar::Revolute, Constraint>;
using P = std::span<double const>;

/// A rod on a pin, released horizontally. Parameters: length, density, gravity.
auto const pendulum = [](P p) {
  using M = Model<Bodies<planar::Rigid>, Joints<Pin>>;
  M model{Gravity{0, -p[2], 0}};
  auto const rod = model.add(
      planar::Rigid::from(
          {.length = p[0], .section = Circle{.radius = 0.01}, .material = Material{.density = p[1], .young = 2e11}}),
      "rod");
  auto const pin = model.connect(Pin{}, model.ground().at({0, 0, 0}), rod.at(0.0), "pin");
  State const start = model.reference_state();
  double const l = p[0];
  std::vector<Output<M>> outputs{
      {"angle [rad]", [](M const&, State const& x) { return x.q[2]; }},
      {"tip y [m]", [rod, l](M const& m, State const& x) { return position(m, x, rod.at(l))[1]; }},
      {"force [N]", [pin](M const& m, State const& x) { return reaction(m, x, pin).f.norm(); }}};
  return Scenario<M>{std::move(model), start, {.end_time = 0.5, .step = 1e-2}, std::move(outputs)};
};

std::vector<Parameter> const of_pendulum{{"length [m]", 1.2}, {"density [kg/m³]", 7800.0}, {"gravity [m/s²]", 9.81}};

TEST(SensitivityResult, OfAPendulumAreThoseOfItsRuns) {
  GeneralisedAlpha const integrator{.rho_inf = 0.7};
  SensitivityResult const s = sensitivities(pendulum, of_pendulum, integrator);
  MatX const expected = by_differences(pendulum, of_pendulum, integrator);
  ASSERT_EQ(s.times.size(), 51u);
  EXPECT_LT(s.left, 1e-10);
  // the force contains the round-off of the constraint equations over βh²; differences of runs divide it by the
  // change of the parameter
  for (Index i = 0; i < 3; ++i)
    for (Index j = 0; j < 3; ++j)
      EXPECT_NEAR(s.derivatives.back()(i, j), expected(i, j), (i == 2 ? 1e-8 : 1e-9) * (1.0 + std::abs(expected(i, j))))
          << i << ' ' << j;
  // the motion does not depend on the mass
  EXPECT_NEAR(s.derivatives.back()(0, 1), 0.0, 1e-12);
  EXPECT_GT(s.derivatives.back()(2, 1), 1e-4);
}

/// A mass on a spring and a damper along x, with the spring stretched by 1 m, [r(t), ṙ(t)].
template <int spare = 0>
auto oscillator(double end_time, double step) {
  return [end_time, step](P p) {
    using M = Model<Bodies<planar::Rigid>, Joints<>, Forces<SpringDamper>>;
    M model;
    auto const mass = model.add(planar::Rigid(2.0, 1.0, Placement::at({3.0, 0, 0})), "mass");
    model.apply(SpringDamper{.stiffness = p[0], .damping = p[1], .free_length = 2.0}, model.ground().at({0, 0, 0}),
                mass.at(Vec2(0, 0)), "spring");
    State const start = model.reference_state();
    std::vector<Output<M>> outputs{{"x [m]", [](M const&, State const& x) { return x.q[0]; }},
                                   {"v [m/s]", [](M const&, State const& x) { return x.v[0]; }}};
    return Scenario<M>{std::move(model), start, {.end_time = end_time, .step = step}, std::move(outputs)};
  };
}
/// x(t) = 2 + e^(−δt) (cos ωt + δ/ω sin ωt).
double place(double k, double c, double t) {
  double const m = 2.0, delta = 0.5 * c / m, w = std::sqrt(k / m - delta * delta);
  return 2.0 + std::exp(-delta * t) * (std::cos(w * t) + delta / w * std::sin(w * t));
}

TEST(SensitivityResult, OfAnOscillatorApproachTheClosedFormAtSecondOrder) {
  double const k = 50.0, c = 3.0, e = 1e-3;
  double const by_k = (8.0 * (place(k + e, c, 1.0) - place(k - e, c, 1.0)) - place(k + 2 * e, c, 1.0) +
                       place(k - 2 * e, c, 1.0)) /
                      (12.0 * e),
               by_c = (8.0 * (place(k, c + e, 1.0) - place(k, c - e, 1.0)) - place(k, c + 2 * e, 1.0) +
                       place(k, c - 2 * e, 1.0)) /
                      (12.0 * e);
  auto const error = [&](double h) {
    MatX const s =
        sensitivities(oscillator(1.0, h), {{"k [N/m]", k}, {"c [N s/m]", c}}, GeneralisedAlpha{}).derivatives.back();
    return std::array{std::abs(s(0, 0) - by_k), std::abs(s(0, 1) - by_c)};
  };
  auto const coarse = error(2e-2), fine = error(1e-2);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_LT(fine[i], 5e-3 * std::abs(i == 0 ? by_k : by_c)) << i;
    EXPECT_NEAR(coarse[i] / fine[i], 4.0, 0.4) << i;
  }
}

TEST(SensitivityResult, AShorterLastStepIsDifferentiatedToo) {
  GeneralisedAlpha const integrator;
  std::vector<Parameter> const parameters{{"k [N/m]", 50.0}, {"c [N s/m]", 3.0}};
  auto const make = oscillator(0.505, 1e-2);
  SensitivityResult const s = sensitivities(make, parameters, integrator);
  MatX const expected = by_differences(make, parameters, integrator);
  EXPECT_EQ(s.times.back(), 0.505);
  EXPECT_LT((s.derivatives.back() - expected).norm(), 1e-10 * expected.norm());
}

TEST(SensitivityResult, BeginAtTheStart) {
  // the initial position x₀ of a mass on a spring is a parameter itself
  auto const make = [](P p) {
    auto scenario = oscillator(0.2, 1e-2)(std::array{50.0, 3.0});
    scenario.start.q[0] += p[0];
    scenario.start.v[0] += p[1];
    return scenario;
  };
  std::vector<Parameter> const parameters{{"x0 [m]", 0.1}, {"v0 [m/s]", 0.0, 1.0}};
  SensitivityResult const s = sensitivities(make, parameters, GeneralisedAlpha{});
  EXPECT_NEAR((s.derivatives[0] - MatX::Identity(2, 2)).norm(), 0.0, 1e-10);
  MatX const expected = by_differences(make, parameters, GeneralisedAlpha{});
  EXPECT_LT((s.derivatives.back() - expected).norm(), 1e-9);
}

TEST(SensitivityResult, SayWhatNothingDependsOn) {
  auto const make = [](P p) { return pendulum(std::array{1.2, 7800.0, p[0]}); };
  auto const with_spare = [&](P p) { return make(p.first(1)); };
  SensitivityResult const s =
      sensitivities(with_spare, {{"gravity [m/s²]", 9.81}, {"colour [1]", 3.0}}, GeneralisedAlpha{});
  ASSERT_EQ(s.run.warnings.size(), 1u);
  EXPECT_TRUE(has(s.run.warnings[0], "Nothing in the run depends on the parameter \"colour [1]\". Remove it"));
}

TEST(SensitivityResult, RefuseSlopesThatDoNotConverge) {
  EXPECT_EQ(detail::require_converged(1e-9, 0.25, "sensitivities"), 1e-9);
  for (double const left : {1e-3, std::nan("")}) {
    std::string const said =
        message_of<NewtonConvergenceFailure>([&] { (void)detail::require_converged(left, 0.25, "sensitivities"); });
    EXPECT_TRUE(has(said, "sensitivities: the derivatives of the step to t = 0.25 s do not converge")) << said;
    EXPECT_TRUE(has(said, "Take a smaller step")) << said;
  }
}

TEST(SensitivityResult, RefuseWhatTheyDoNotDifferentiate) {
  auto const said = [](auto const& make, std::vector<Parameter> const& parameters, GeneralisedAlpha const& i = {}) {
    return refusal([&] { sensitivities(make, parameters, i); });
  };
  EXPECT_TRUE(has(said(pendulum, {{"", 1.0}}), "Parameter 0, counted from 0, has no name"));
  EXPECT_TRUE(has(said(pendulum, {{"a", 1.0}, {"a", 1.0}}), "Duplicate parameter name \"a\""));
  EXPECT_TRUE(has(said(pendulum, {{"length [m]", 0.0}}), "is zero and has no scale"));
  EXPECT_TRUE(has(said(pendulum, {{"length [m]", std::nan("")}}), "finite"));
  EXPECT_TRUE(has(said(pendulum, of_pendulum, {.stabilised = true}), "stabilised"));
  auto const least = [](P p) {
    auto scenario = pendulum(p);
    scenario.options.minimum_norm = true;
    return scenario;
  };
  EXPECT_TRUE(has(said(least, of_pendulum), "minimum-norm multipliers"));
  auto const grows = [](P p) {
    using M = Model<Bodies<planar::AncfCable<>>, Joints<>>;
    M model{Gravity{0, -9.81, 0}};
    model.add(planar::AncfCable<>::from(
                  {.length = 1.0, .constants = BarConstants{.EA = 1e3, .EI = 1.0, .mass_per_length = 1.0}},
                  p[0] > 3.0 ? 4 : 3),
              "cable");
    State const start = model.reference_state();
    return Scenario<M>{std::move(model), start, {.end_time = 0.1, .step = 1e-2}};
  };
  EXPECT_TRUE(has(said(grows, {{"elements [1]", 3.0}}),
                  "another value of \"elements [1]\" the function that makes the model returns a different size"));
}

}  // namespace sensitivities_test
