#include <polybody/gradients/gradient.hpp>

#include <gtest/gtest.h>

#include <polybody/bodies/rigid/planar_rigid.hpp>
#include <polybody/bodies/rigid/rigid.hpp>
#include <polybody/forces/contact.hpp>
#include <polybody/forces/springs.hpp>
#include <polybody/gradients/sensitivities.hpp>
#include <polybody/integrators/generalised_alpha.hpp>
#include <polybody/joints/nonholonomic.hpp>
#include <polybody/joints/planar/joints.hpp>
#include <polybody/joints/policies/penalty.hpp>
#include <polybody/joints/policies/policy.hpp>
#include <polybody/run/probe.hpp>

#include "support/differences_of_runs.hpp"
#include "support/refusal.hpp"
#include "support/touched_chain.hpp"

using namespace polybody;

namespace gradient_test {

using namespace touched_chain;

/// A mass of 2 kg on a spring k and a damper c along x, with the spring stretched by 1 m. J = x(T) + ∫ x dt.
auto oscillator(double end_time, double step) {
  return [end_time, step](P p) {
    using M = Model<Bodies<planar::Rigid>, Joints<>, Forces<SpringDamper>>;
    M model;
    auto const mass = model.add(planar::Rigid(2.0, 1.0, Placement::at({3.0, 0, 0})), "mass");
    model.apply(SpringDamper{.stiffness = p[0], .damping = p[1], .free_length = 2.0}, model.ground().at({0, 0, 0}),
                mass.at(Vec2(0, 0)), "spring");
    auto const place = [](auto const&, auto const& x) { return x.q[0]; };
    State const start = model.reference_state();
    return with_objective(Scenario<M>{std::move(model), start, {.end_time = end_time, .step = step}}, place, place);
  };
}
std::vector<Parameter> const of_oscillator{{"k [N/m]", 50.0}, {"c [N s/m]", 3.0}};

/// The value of x(t) + ∫₀ᵗ x dt for x = 2 + e^(−δt) (cos ωt + δ/ω sin ωt), with ∫ e^(−δt)(cos + δ/ω sin) dt =
/// [e^(−δt) (−2δ cos ωt + (ω² − δ²)/ω sin ωt) + 2δ]/(δ² + ω²).
double closed_form(double k, double c, double t) {
  double const m = 2.0, delta = 0.5 * c / m, w2 = k / m - delta * delta, w = std::sqrt(w2);
  double const e = std::exp(-delta * t), cosine = std::cos(w * t), sine = std::sin(w * t);
  return 2.0 + e * (cosine + delta / w * sine) + 2.0 * t +
         (e * (-2.0 * delta * cosine + (w2 - delta * delta) / w * sine) + 2.0 * delta) / (delta * delta + w2);
}

TEST(GradientResult, OfAnOscillatorApproachesTheClosedFormAtSecondOrder) {
  double const k = 50.0, c = 3.0, e = 1e-3;
  auto const slope = [&](double ek, double ec) {
    auto const at = [&](double s) { return closed_form(k + s * ek, c + s * ec, 1.0); };
    return (8.0 * (at(1) - at(-1)) - at(2) + at(-2)) / (12.0 * e);
  };
  std::array const expected{closed_form(k, c, 1.0), slope(e, 0.0), slope(0.0, e)};
  auto const error = [&](double h) {
    GradientResult const g = gradient(oscillator(1.0, h), of_oscillator, GeneralisedAlpha{});
    return std::array{std::abs(g.value - expected[0]), std::abs(g.derivatives[0] - expected[1]),
                      std::abs(g.derivatives[1] - expected[2])};
  };
  auto const coarse = error(1e-2), fine = error(5e-3);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_LT(fine[i], 0.01 * std::abs(expected[i])) << i;
    EXPECT_NEAR(coarse[i] / fine[i], 4.0, 0.4) << i;
  }
}

TEST(GradientResult, HasTheSameBitsWithFewSnapshots) {
  auto const make = oscillator(1.0, 1e-2);
  GradientResult const all = gradient(make, of_oscillator, GeneralisedAlpha{});
  EXPECT_EQ(all.reversal.steps, 100u);
  EXPECT_EQ(all.reversal.taken, 100u);
  EXPECT_EQ(all.run.steps, 100);
  for (std::size_t const snapshots : {1u, 2u, 7u, 50u}) {
    GradientResult const few = gradient(make, of_oscillator, GeneralisedAlpha{}, {.snapshots = snapshots});
    EXPECT_EQ(few.value, all.value) << snapshots;
    EXPECT_EQ(few.derivatives, all.derivatives) << snapshots;
    EXPECT_EQ(few.reversal.snapshots, snapshots);
    EXPECT_GT(few.reversal.taken, 100u);
    EXPECT_EQ(few.run.steps, 100);
  }
  GradientResult const within = gradient(make, of_oscillator, GeneralisedAlpha{}, {.memory = 7.9 * all.snapshot_size});
  EXPECT_EQ(within.reversal.snapshots, 7u);
  EXPECT_EQ(within.derivatives, all.derivatives);
}

TEST(GradientResult, TakesAFunctionOfStatesInDoublesByDifferences) {
  auto const recorded = oscillator(0.3, 1e-2);
  auto const by_differences = [&](P p) {
    auto scenario = recorded(p);
    using M = std::remove_cvref_t<decltype(scenario.model)>;
    auto const place = [](M const&, State const& x) { return x.q[0]; };
    return with_objective(Scenario<M>(std::move(scenario)), place, place);
  };
  GradientResult const a = gradient(recorded, of_oscillator, GeneralisedAlpha{}),
                       b = gradient(by_differences, of_oscillator, GeneralisedAlpha{});
  EXPECT_EQ(a.value, b.value);
  EXPECT_LT((a.derivatives - b.derivatives).norm(), 1e-11 * a.derivatives.norm());
}

/// A ball that falls on a plane, slides and begins to roll. Parameters: radius, modulus, friction, height, initial
/// speed.
auto const ball = [](P p) {
  using Law = Contact<SphereOnPlane, HertzContact>;
  using M = Model<Bodies<Rigid<>>, Joints<>, Forces<Law>>;
  M model{Gravity{0, 0, -9.81}};
  double const radius = p[0], mass = 1000.0 * 4.0 / 3.0 * std::numbers::pi * radius * radius * radius;
  Mat3 const inertia = 0.4 * mass * radius * radius * Mat3::Identity();
  auto const body = model.add(Rigid<>(mass, inertia, Placement::at({0, 0, radius + p[3]})), "ball");
  model.apply(Law{.geometry = {.radius = radius},
                  .normal = {.modulus = p[1], .radius = radius},
                  .friction = {.coefficient = p[2], .slip_speed = 0.05}},
              body.at(Vec3::Zero()), model.ground().at({0, 0, 0}), "floor");
  State start = model.reference_state();
  model.set_velocity(start, body, {p[4], 0, 0}, Vec3::Zero());
  auto const rated_by = [](auto const&, auto const& x) { return x.q[0] + 2.0 * x.q[2] + 0.1 * x.v[4]; };
  std::vector<Output<M>> outputs{{"where and how fast [1]", rated_by}};
  return with_objective(Scenario<M>{std::move(model), start, {.end_time = 0.12, .step = 5e-4}, std::move(outputs)},
                        rated_by);
};
std::vector<Parameter> const of_ball{
    {"radius [m]", 0.1}, {"modulus [Pa]", 1e6}, {"friction [1]", 0.3}, {"height [m]", 0.02}, {"speed [m/s]", 1.0}};

TEST(GradientResult, GoesThroughAContactWithFriction) {
  GeneralisedAlpha const integrator{.start_correction = false};
  GradientResult const g = gradient(ball, of_ball, integrator);
  VecX const direct = sensitivities(ball, of_ball, integrator).derivatives.back().row(0).transpose();
  VecX const expected = by_differences(ball, of_ball, integrator).row(0).transpose();
  for (Index j = 0; j < direct.size(); ++j) {
    double const size = of_ball[std::size_t(j)].size();
    EXPECT_NEAR(size * g.derivatives[j], size * direct[j], 1e-11 * (1.0 + std::abs(size * direct[j]))) << j;
    // the force is d^(3/2) at first contact, which has no second derivative there
    EXPECT_NEAR(size * g.derivatives[j], size * expected[j], 1e-5 * (1.0 + std::abs(size * expected[j]))) << j;
    EXPECT_GT(std::abs(size * g.derivatives[j]), 1e-5) << j;
  }
}

/// A disc that rolls and wobbles. Parameters: mass, an inertia, initial spin. It has holonomic and nonholonomic
/// constraint equations.
auto const disc = [](P p) {
  using Wheel = Joint<RollingDisc, Constraint>;
  using M = Model<Bodies<Rigid<>>, Joints<Wheel>>;
  Vec3 const axis{std::cos(0.35), 0, std::sin(0.35)};
  M model{Gravity{0, 0, -9.81}};
  auto const wheel = model.add(Rigid<>(p[0], Vec3(p[1], 0.08, 0.08).asDiagonal().toDenseMatrix(),
                                       Placement::at({0, 0, 0.4 * std::cos(0.35)}, {0, -0.35, 0})),
                               "wheel");
  model.connect(Wheel{{.radius = 0.4, .axis = axis, .normal = Vec3::UnitZ()}, {}}, model.ground().at({0, 0, 0}),
                wheel.at(Vec3::Zero()), "contact");
  State start = model.reference_state();
  Vec3 const w = -p[2] * axis + Vec3(0.3, 0.4, 1.0), contact(0.4 * std::sin(0.35), 0, 0);
  model.set_velocity(start, wheel, -w.cross(contact), w);
  auto const rated_by = [](auto const&, auto const& x) { return x.q[0] + 2.0 * x.q[1] + x.q[2]; };
  std::vector<Output<M>> outputs{{"where [m]", rated_by}};
  return with_objective(Scenario<M>{std::move(model), start, {.end_time = 0.2, .step = 4e-3}, std::move(outputs)},
                        rated_by);
};

TEST(GradientResult, GoesThroughRowsOfSpeeds) {
  std::vector<Parameter> const parameters{{"mass [kg]", 2.0}, {"inertia [kg m²]", 0.15}, {"spin [rad/s]", 5.0}};
  GeneralisedAlpha const integrator{.rho_inf = 0.8};
  GradientResult const g = gradient(disc, parameters, integrator);
  VecX const direct = sensitivities(disc, parameters, integrator).derivatives.back().row(0).transpose();
  VecX const expected = by_differences(disc, parameters, integrator).row(0).transpose();
  EXPECT_LT((g.derivatives - direct).norm(), 1e-11 * (1.0 + direct.norm()));
  EXPECT_LT((g.derivatives - expected).norm(), 1e-8 * (1.0 + expected.norm()));
}

TEST(GradientResult, IsTheSameWhereParametersSayWhatTheyTouch) {
  GradientResult const a = gradient(chain, of_chain(true), GeneralisedAlpha{}),
                       b = gradient(chain, of_chain(false), GeneralisedAlpha{});
  for (Index j = 0; j < 15; ++j) {
    double const size = of_chain(true)[std::size_t(j)].size();
    EXPECT_NEAR(size * a.derivatives[j], size * b.derivatives[j], 1e-12) << j;
    EXPECT_GT(std::abs(size * a.derivatives[j]), 1e-8) << j;
  }
}

TEST(GradientResult, DirectDifferentiationIsTheSameWhereParametersSayWhatTheyTouch) {
  expect_same_derivatives_with_affects(GeneralisedAlpha{});
}

TEST(GradientResult, DirectDifferentiationRefusesParametersThatTouchMoreThanTheySay) {
  auto const said = [](std::size_t j, std::vector<std::string> affects) {
    auto parameters = of_chain(true);
    parameters[j].affects = std::move(affects);
    return refusal([&] { sensitivities(chain_with_angle, parameters, GeneralisedAlpha{}); });
  };
  EXPECT_TRUE(has(said(3, {"rod 7"}), "affects \"rod 7\", but the model has no body, joint or force of that name"));
  EXPECT_TRUE(has(said(3, {"pin 1"}), "\"length 1 [m]\" changes the equations of body \"rod 2\""));
  // no pin is strained at the start, so the dependence appears at the end only
  EXPECT_TRUE(has(said(5, {"rod 0"}), "\"stiffness 1 [N/m]\" changes the equations of body \"rod 1\""));
}

TEST(GradientResult, ParametersThatTouchNothingInCommonShareTheirModels) {
  using V = detail::PerturbedModel<decltype(chain({})), GeneralisedAlpha>;
  auto const groups = [](std::vector<Parameter> const& parameters) {
    return detail::PerturbedModels<V>(chain, parameters, GeneralisedAlpha{}.method(), "gradient").groups();
  };
  EXPECT_EQ(groups(of_chain(false)), 15u);
  // a length touches both neighbours and needs three groups; densities and stiffnesses of other bodies fill two more
  // groups
  EXPECT_LE(groups(of_chain(true)), 6u);
  EXPECT_GE(groups(of_chain(true)), 5u);
}

// The factory is called once for the run and at four points of each parameter.
TEST(GradientResult, BuildsThirteenModelsForThreeParameters) {
  int calls = 0;
  auto const counted = [&](P p) {
    ++calls;
    return oscillator(p[2], 1e-2)(p);
  };
  auto const of = [](double end_time) {
    return std::vector<Parameter>{{"k [N/m]", 50.0}, {"c [N s/m]", 3.0}, {"end [s]", end_time}};
  };
  auto const fixed = [&](P p) { return counted(std::array{p[0], p[1], 0.1 + 0.0 * p[2]}); };
  gradient(fixed, of(0.1), GeneralisedAlpha{});
  EXPECT_EQ(calls, 13);
  calls = 0;
  gradient(counted, of(0.105), GeneralisedAlpha{});  // the end time moves
  EXPECT_EQ(calls, 13);
  calls = 0;
  sensitivities(fixed, of(0.1), GeneralisedAlpha{});
  EXPECT_EQ(calls, 13);
}

TEST(GradientResult, RefusesParametersThatTouchMoreThanTheySay) {
  auto const said = [](std::vector<std::string> affects) {
    auto parameters = of_chain(true);
    parameters[3].affects = std::move(affects);  // the parameter is a length
    return refusal([&] { gradient(chain, parameters, GeneralisedAlpha{}); });
  };
  EXPECT_TRUE(has(said({"rod 7"}), "affects \"rod 7\", but the model has no body, joint or force of that name"));
  EXPECT_TRUE(has(said({"pin 1"}), "\"length 1 [m]\" changes the equations of body \"rod 2\""));
}

TEST(GradientResult, SaysWhatNothingDependsOn) {
  auto const make = [](P p) { return oscillator(0.1, 1e-2)(std::array{p[0], 3.0}); };
  GradientResult const g = gradient(make, {{"k [N/m]", 50.0}, {"colour [1]", 3.0}}, GeneralisedAlpha{});
  ASSERT_EQ(g.run.warnings.size(), 1u);
  EXPECT_TRUE(has(g.run.warnings[0], "The objective does not depend on the parameter \"colour [1]\". Remove it"));
  EXPECT_EQ(g.derivatives[1], 0.0);
}

TEST(GradientResult, RefusesWhatItDoesNotDifferentiate) {
  auto const make = oscillator(0.1, 1e-2);
  auto const said = [](auto const& of, GradientOptions const& options = {}, GeneralisedAlpha const& i = {}) {
    return refusal([&] { gradient(of, of_oscillator, i, options); });
  };
  for (double const memory : {0.0, 10.0, std::nan("")})
    EXPECT_TRUE(has(said(make, {.memory = memory}), "a snapshot of a state takes"));
  EXPECT_TRUE(has(said(make, {}, {.stabilised = true}), "gradient: a stabilised step"));
  EXPECT_TRUE(has(said(oscillator(0.105, 1e-2)), "the length of the step to t = 0.105 s differs"));
  EXPECT_TRUE(has(said(oscillator(0.0, 1e-2)), "has no step"));
  auto const halved = [&](P p) {
    auto scenario = make(p);
    scenario.options.max_step_halvings = 2;
    return scenario;
  };
  EXPECT_TRUE(has(said(halved), "gradient: a run with halved steps"));
  auto const wild = [&](P p) {
    auto scenario = make(p);
    using M = std::remove_cvref_t<decltype(scenario.model)>;
    return with_objective(Scenario<M>(std::move(scenario)), [](M const&, State const& x) { return std::log(-x.q[0]); });
  };
  EXPECT_TRUE(
      has(message_of<NonFiniteValue>([&] { gradient(wild, of_oscillator, GeneralisedAlpha{}); }), "the objective"));
}

}  // namespace gradient_test
