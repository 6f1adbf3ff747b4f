// Derivatives of runs whose joints eliminate coordinates.
#include <polybody/gradients/gradient.hpp>

#include <gtest/gtest.h>

#include <polybody/bodies/ancf/ancf_beam.hpp>
#include <polybody/gradients/sensitivities.hpp>
#include <polybody/integrators/generalised_alpha.hpp>
#include <polybody/joints/policies/policy.hpp>

#include "support/hung_cables.hpp"
#include "support/impacts_of_whole_states.hpp"
#include "support/rated_links.hpp"
#include "support/refusal.hpp"
#include "support/slopes_of_runs.hpp"

using namespace polybody;

namespace eliminated_test {

std::vector<Parameter> const& parameters = parameters_of_hung_cables;

TEST(Eliminated, SlopesAreThoseOfWholeRuns) {
  GeneralisedAlpha const integrator{.rho_inf = 0.7};
  expect_derivatives_of_runs(hung_cables<AncfLinear, false>(), parameters, integrator, 1e-8);
  expect_derivatives_of_runs(hung_cables<AncfLinear, true>(), parameters, integrator, 1e-8);
}

/// Joints that are linear in the coordinates give the same steps by constraint equations and by elimination.
template <bool held>
void expect_derivatives_on_rows() {
  SensitivityResult const free = sensitivities(hung_cables<AncfLinear, held>(), parameters, HhtAlpha{}),
                          on_rows = sensitivities(hung_cables<Constraint, held>(), parameters, HhtAlpha{});
  for (std::size_t const k : {std::size_t(0), free.times.size() / 2, free.times.size() - 1}) {
    // 2e-9: scatter of these derivatives when the density changes by 1e-6 of its value
    expect_same_derivatives(free.derivatives[k].topRows(4), on_rows.derivatives[k].topRows(4), parameters, 4e-9);
    // the reaction contains the round-off of the constraint equations over βh²
    expect_same_derivatives(free.derivatives[k].bottomRows(1), on_rows.derivatives[k].bottomRows(1), parameters, 1e-7);
  }
}
TEST(Eliminated, SlopesAreThoseOfTheSameJointsOnRows) {
  expect_derivatives_on_rows<false>();
  expect_derivatives_on_rows<true>();
}

TEST(Eliminated, SlopesOfOneResultComeBackwardsToo) {
  GeneralisedAlpha const integrator{.rho_inf = 0.7};
  expect_derivatives_backwards(hung_cables<AncfLinear, false>(), parameters, integrator, 1e-11);
  expect_derivatives_backwards(hung_cables<AncfLinear, true>(), parameters, integrator, 1e-11);
  expect_direct_derivatives(rated_links<AncfBeam<ElasticLine>, AncfLinear>(0.0), HhtAlpha{}, 1e-11);
}

TEST(Eliminated, BodiesThatParametersTouchAreFoundAmongWhatIsLeft) {
  auto const make = [](std::span<double const> p) {
    return hung_cables<AncfLinear, true>()(std::array{p[0], 1000.0, p[1], p[2], 2.0});
  };
  auto const of_affects = [](bool with_affects) {
    std::vector<Parameter> all{{"young [Pa]", 1e7, 0.0, {"first", "second"}},
                               {"place [m]", 0.31, 0.0, {"pin", "rod", "second"}},
                               {"gravity [m/s²]", 9.81, 0.0, {"first", "second"}}};
    if (!with_affects)
      for (Parameter& p : all) p.affects.clear();
    return all;
  };
  GradientResult const with_affects = gradient(make, of_affects(true), GeneralisedAlpha{}),
                       without = gradient(make, of_affects(false), GeneralisedAlpha{});
  for (Index j = 0; j < 3; ++j) {
    double const size = of_affects(true)[std::size_t(j)].size();
    EXPECT_NEAR(size * with_affects.derivatives[j], size * without.derivatives[j], 1e-12) << j;
    EXPECT_GT(std::abs(size * without.derivatives[j]), 1e-5) << j;
  }
  auto const said = [&](std::vector<std::string> affects) {
    auto few = of_affects(true);
    few[2].affects = std::move(affects);
    return refusal([&] { gradient(make, few, GeneralisedAlpha{}); });
  };
  EXPECT_TRUE(has(said({"first"}), "\"gravity [m/s²]\" changes the equations of body \"second\""));
  EXPECT_TRUE(has(said({"third"}), "affects \"third\", but the model has no body, joint or force of that name"));
}

TEST(Eliminated, EventsSeeAndChangeWholeStates) { expect_impact_of_cables(2e-3, GeneralisedAlpha{.rho_inf = 0.7}); }

TEST(Eliminated, OtherUnknownsUnderAParameterAreRefused) {
  // midway between two nodes both have equal coefficients in the constraint equation; slightly off the middle the
  // nearer node is eliminated
  auto const make = [](std::span<double const> p) {
    using Pin = Joint<Spherical, AncfLinear>;
    using M = Model<Bodies<AncfCable<>>, Joints<Pin>>;
    M model{Gravity{0, 0, -9.81}};
    auto const cable = model.add(AncfCable<>::from(
        {.length = 0.5, .section = Circle{.radius = 0.01}, .material = Material{.density = 1000.0, .young = 1e7}}, 1));
    model.connect(Pin{}, model.ground().at({p[0], 0, 0}), cable.at(p[0]), "pin");
    State const start = model.reference_state();
    std::vector<Output<M>> outputs{{"x [m]", [](M const&, State const& x) { return x.q[0]; }}};
    return Scenario<M>{std::move(model), start, {.end_time = 0.01, .step = 1e-3}, std::move(outputs)};
  };
  auto const said = [&](double place) {
    return refusal([&] { sensitivities(make, {{"place [m]", place}}, GeneralisedAlpha{}); });
  };
  EXPECT_TRUE(has(said(0.25), "a change of \"place [m]\" changes the coordinates that AncfLinear eliminates"));
  EXPECT_EQ(sensitivities(make, {{"place [m]", 0.2}}, GeneralisedAlpha{}).times.size(), 11u);
}

}  // namespace eliminated_test
