// Derivatives of runs with breakpoints of driving constraints and loads, with events and with event actions.
#include <polybody/gradients/sensitivities.hpp>

#include <gtest/gtest.h>

#include <polybody/bodies/rigid/rigid.hpp>
#include <polybody/forces/contact.hpp>
#include <polybody/integrators/generalised_alpha.hpp>

#include "support/moving_times.hpp"

using namespace polybody;

namespace sensitivities_events_test {

using namespace moving_times;

TEST(SensitivitiesThroughEvents, TheTimeOfAFallIsThatOfTheClosedForm) { expect_fall(GeneralisedAlpha{.rho_inf = 0.6}); }
TEST(SensitivitiesThroughEvents, BouncesFollowTheClosedForm) { expect_bounces(GeneralisedAlpha{}); }

// --- breakpoints -------------------------------------------------------------------------------------------------

TEST(SensitivitiesThroughCorners, APushThatEndsAtAParameterIsExact) { expect_push(GeneralisedAlpha{.rho_inf = 0.7}); }
TEST(SensitivitiesThroughCorners, ARampOfADriveIsThatOfItsRuns) {
  expect_derivatives_of_moving_runs(driven<Constraint>, of_drive, GeneralisedAlpha{.rho_inf = 0.7}, 3e-8,
                                    {0.025, 0.25, 0.25, 2.5});
  expect_derivatives_of_moving_runs(driven<Penalty>, of_drive, Trapezoidal{}, 3e-8, {0.025, 0.25, 0.25, 2.5});
}
TEST(SensitivitiesThroughCorners, HowFarACornerMovesInStepsDoesNotMatter) {
  auto const of_duration = [](P p) {
    auto scenario = driven<Constraint>(std::array{p[0], 0.5, 0.4, 9.81});
    scenario.options.step = 5e-4;
    return scenario;
  };
  auto const derivatives = [&](double scale) {
    return MatX(sensitivities(of_duration, {{"duration [s]", 0.1531, scale}}, GeneralisedAlpha{}).derivatives.back());
  };
  MatX const within = derivatives(0.075), beyond = derivatives(1.125);  // 0.1 and 1.8 steps
  EXPECT_LT((beyond - within).norm(), 3e-8 * within.norm());
}

// --- events of mechanisms ----------------------------------------------------------------------------------------

TEST(SensitivitiesThroughEvents, ImpactsOfAMechanismAreThoseOfItsRuns) {
  SensitivityResult const s = sensitivities(stopped<Constraint>, of_stop, GeneralisedAlpha{.rho_inf = 0.7});
  ASSERT_GE(s.run.events.size(), 3u);
  expect_derivatives_of_moving_runs(stopped<Constraint>, of_stop, GeneralisedAlpha{.rho_inf = 0.7}, 1e-8,
                                    {0.25, 2.5, 0.25, 0.25});
  expect_derivatives_of_moving_runs(stopped<Penalty>, of_stop, Newmark{}, 1e-7, {0.25, 2.5, 0.25, 0.25});
}

TEST(SensitivitiesThroughEvents, AnEventUnderADriveIsThatOfItsRuns) {
  expect_derivatives_of_moving_runs(braked, of_brake, GeneralisedAlpha{.rho_inf = 0.7}, 3e-8, {0.025, 0.25, 2.5, 0.4});
}

TEST(SensitivitiesThroughEvents, JumpsInSpaceAreThoseOfTheirRuns) {
  std::vector<Parameter> const parameters{{"spin [rad/s]", 3.0}, {"height [m]", 0.6}, {"gravity [m/s²]", 9.81}};
  ASSERT_EQ(sensitivities(spun, parameters, GeneralisedAlpha{}).run.events.size(), 1u);
  expect_derivatives_of_moving_runs(spun, parameters, GeneralisedAlpha{}, 1e-8, {0.75, 0.125, 2.5});
}

TEST(SensitivitiesThroughEvents, LengthsOfStepsAndOfTheRunAreParameters) {
  expect_lengths_as_parameters(GeneralisedAlpha{}, 0.01);
}

// --- smooth laws of contact --------------------------------------------------------------------------------------

/// A ball on the floor under Hertz's law, without events. Parameters: modulus, height, mass.
auto const on_floor = [](P p) {
  using Law = Contact<SphereOnPlane, HertzContact>;
  using M = Model<Bodies<Rigid<>>, Joints<>, Forces<Law>>;
  M model{Gravity{0, 0, -9.81}};
  auto const body = model.add(Rigid<>(p[2], Mat3(0.01 * Mat3::Identity()), Placement::at({0, 0, p[1]})), "ball");
  model.apply(Law{{.radius = 0.1}, HertzContact{.modulus = p[0], .radius = 0.1}}, body.at(Vec3(0, 0, 0)),
              model.ground().at({0, 0, 0}));
  State const start = model.reference_state();
  std::vector<Output<M>> outputs{{"z [m]", [](M const&, State const& x) { return x.q[2]; }},
                                 {"v [m/s]", [](M const&, State const& x) { return x.v[2]; }}};
  return Scenario<M>{std::move(model), start, {.end_time = 0.35, .step = 5e-4}, std::move(outputs)};
};

TEST(SensitivitiesThroughContact, ASmoothLawNeedsNoEvents) {
  expect_derivatives_of_moving_runs(on_floor, {{"modulus [Pa]", 1e6}, {"height [m]", 0.3}, {"mass [kg]", 1.0}},
                                    GeneralisedAlpha{.rho_inf = 0.8}, 1e-7, {2.5e4, 2.5e-3, 2.5e-2});
}

// --- refusals ----------------------------------------------------------------------------------------------------

TEST(SensitivitiesThroughEvents, RefuseWhatHasNoDerivative) { expect_refusals(GeneralisedAlpha{}); }

}  // namespace sensitivities_events_test
