// Questions about states: one evaluation for all of them, the same bits as a new system, and never an old answer.
#include <polybody/run/probe.hpp>

#include <gtest/gtest.h>

#include <cstring>
#include <iterator>
#include <memory>
#include <optional>
#include <polybody/bodies/ancf/planar_ancf_cable.hpp>
#include <polybody/integrators/generalised_alpha.hpp>
#include <polybody/integrators/runge_kutta.hpp>
#include <polybody/joints/driving_constraints.hpp>
#include <polybody/joints/policies/elimination.hpp>
#include <polybody/math/time_functions.hpp>
#include <polybody/run/any_model.hpp>
#include <polybody/run/initial_conditions.hpp>
#include <polybody/run/simulate.hpp>
#include <sstream>

#include "support/mixed_models.hpp"
#include "support/refusal.hpp"

using namespace polybody;

namespace probe_test {

/// A record of numbers without padding has the same bits.
template <class T>
bool same_bits(T const& a, T const& b) {
  return std::memcmp(&a, &b, sizeof(T)) == 0;
}
bool same_bits(VecX const& a, VecX const& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), std::size_t(a.size()) * sizeof(double)) == 0;
}
bool same_bits(State const& a, State const& b) {
  return a.t == b.t && same_bits(a.q, b.q) && same_bits(a.v, b.v) && same_bits(a.a, b.a) &&
         same_bits(a.lambda, b.lambda) && same_bits(a.history, b.history);
}

/// New system of `model`, evaluated at x with the wrenches of its force elements.
template <class M>
System new_system(M const& model, State const& x) {
  System system(model, with<Capabilities::rigid_velocities>);
  system.evaluate(x.q, x.v, x.t);
  system.push_forces(x.lambda);
  return system;
}

/// Answers of the whole model have the bits of a new system.
template <class M>
void expect_answers_of_a_new_system(M const& model, ObservedState const& now) {
  State const x = now;
  System system = new_system(model, x);
  EXPECT_TRUE(same_bits(now.energy(), energy(system, x)));
  EXPECT_TRUE(same_bits(now.momentum(), momentum(system, x)));
  EXPECT_TRUE(same_bits(now.centre_of_mass(), centre_of_mass(system, x)));
  EXPECT_TRUE(same_bits(now.largest_violation(), largest_violation(system, x)));
  EXPECT_EQ(now.peak_joint_force(), peak_joint_force(system, x));
  EXPECT_TRUE(same_bits(energy(model, x), now.energy()));
  EXPECT_TRUE(same_bits(energy(model, now), now.energy()));
  EXPECT_TRUE(same_bits(momentum(model, x), now.momentum()));
  EXPECT_TRUE(same_bits(largest_violation(model, now), now.largest_violation()));
}

TEST(Probe, HasTheBitsOfANewSystemForAllKindsOfParts) {
  auto const ask = [](auto const& model) {
    Probe probe(model);
    for (unsigned seed = 1; seed < 4; ++seed) {
      State const x = scrambled(model, seed);
      expect_answers_of_a_new_system(model, probe.at(x));
    }
  };
  ask(MixedSpace::model(0.3));
  ask(MixedBushings::model(0.3));
  ask(MixedStates::model(0.3));
}

/// Pull on a point to the origin. It counts its evaluations.
struct Pull {
  static constexpr int markers = 1;
  static constexpr bool is_load = false;
  static constexpr MarkerKind needs = MarkerKind::point;
  std::shared_ptr<long> calls = std::make_shared<long>(0);

  void check(std::string const&) const {}
  template <class T>
  std::array<Wrench<T>, 1> wrenches(std::array<Frame<T>, 1> const& at, double) const {
    ++*calls;
    Wrench<T> w;
    for (int i = 0; i < 3; ++i) w.f[i] = at[0].r[i] * -3.0;
    return {w};
  }
};

/// Two beams or rigid bars on two pins of a policy, in the plane, with a pull on the end.
template <class B, class Policy>
struct Arm {
  using Pin = Joint<planar::Revolute, Policy>;
  using M = Model<Bodies<B>, Joints<Pin>, Forces<Pull>>;
  M model{Gravity{0, -9.81, 0}};
  Pull pull{};
  std::vector<BodyHandle<B>> bars;
  std::vector<ElementHandle<Pin>> pins;
  std::optional<ElementHandle<Pull>> force;
  State x;

  explicit Arm(Pin const& pin = {}) {
    for (int i = 0; i < 2; ++i) {
      Bar const bar{.length = 0.5,
                    .section = Rectangle{.height = 0.02, .width = 0.02},
                    .material = Material{.density = 1000.0, .young = 1e7},
                    .placement = Placement::planar(0.5 * i, 0)};
      bars.push_back(model.add(B::from(bar, {.elements = 2})));
    }
    pins.push_back(model.connect(pin, model.ground().at({0, 0, 0}), bars[0].at(0.0), "shoulder"));
    pins.push_back(model.connect(pin, bars[0].at(0.5), bars[1].at(0.0), "elbow"));
    force = model.apply(pull, bars[1].at(0.5), "pull");
    x = model.reference_state();
  }
  auto run(double end_time = 0.1) {
    return simulate(model, x, GeneralisedAlpha{.rho_inf = 0.8}, {.end_time = end_time, .step = 1e-3});
  }
};

/// All answers about joints, bodies and forces of an arm have the bits of a new system.
template <class A>
void expect_answers_of_an_arm(A const& arm, ObservedState const& now) {
  State const x = now;
  expect_answers_of_a_new_system(arm.model, now);
  System const system = new_system(arm.model, x);
  for (auto const& pin : arm.pins) {
    EXPECT_EQ(now.constraint_violation(pin), constraint_violation(system, pin));
    EXPECT_EQ(constraint_violation(arm.model, now, pin), constraint_violation(system, pin));
    for (ReactionAxes const axes : {ReactionAxes::world, ReactionAxes::joint})
      EXPECT_TRUE(same_bits(now.reaction(pin, axes), reaction(system, x, pin, axes)));
    EXPECT_TRUE(same_bits(reaction(arm.model, now, pin), now.reaction(pin)));
    EXPECT_EQ(now.power(pin), power(system, x, pin));
  }
  EXPECT_TRUE(same_bits(now.applied_wrenches(*arm.force), applied_wrenches(system, *arm.force)));
  EXPECT_EQ(now.power(*arm.force), power(system, x, *arm.force));
  auto const& bar = arm.bars[1];
  EXPECT_EQ(now.position(bar.at(0.3)), position(arm.model, x, bar.at(0.3)));
  EXPECT_EQ(now.frame(bar.at(0.3)).w, frame(arm.model, x, bar.at(0.3)).w);
  EXPECT_EQ(now.position(arm.model.ground().at({1, 2, 0})), Vec3(1, 2, 0));
  EXPECT_EQ(now.acceleration(bar.at(0.3)), acceleration(arm.model, x, bar.at(0.3)));
  EXPECT_EQ(now.angular_acceleration(bar.at(0.3)), angular_acceleration(arm.model, x, bar.at(0.3)));
  EXPECT_TRUE(same_bits(now.centre_of_mass(bar), centre_of_mass(arm.model, x, bar)));
  auto const first = [&](std::span<double const> part, VecX const& all) { return part.data() - all.data(); };
  EXPECT_EQ(first(now.coordinates_of(bar), now.q), first(coordinates_of(arm.model, x, bar), x.q));
  EXPECT_EQ(first(now.velocities_of(bar), now.v), first(velocities_of(arm.model, x, bar), x.v));
  EXPECT_EQ(first(now.accelerations_of(bar), now.a), first(accelerations_of(arm.model, x, bar), x.a));
}

// A run with questions in each of its states has the bits of a run without them, for every policy.
template <class A>
void expect_answers_in_a_run(A asked, A quiet) {
  State const kept = asked.x;
  int states = 0;
  auto run = asked.run();
  for (auto const& now : run)
    if (states++ % 20 == 0) expect_answers_of_an_arm(asked, now);
  EXPECT_EQ(states, 101);
  RunReport const report = quiet.run().run();
  EXPECT_FALSE(same_bits(asked.x, kept));
  EXPECT_TRUE(same_bits(asked.x, quiet.x));
  EXPECT_EQ(run.report().evaluations, report.evaluations);
  EXPECT_EQ(run.report().factorisations, report.factorisations);
}

TEST(StatesOfARun, AnswerForMultipliers) {
  using A = Arm<planar::Rigid, Constraint>;
  expect_answers_in_a_run(A(), A());
}
TEST(StatesOfARun, AnswerForPenalties) {
  using A = Arm<planar::Rigid, Penalty>;
  A::Pin const pin{{}, Penalty{.stiffness = 1e4, .damping = 1.0}};
  expect_answers_in_a_run(A(pin), A(pin));
}
TEST(StatesOfARun, AnswerForJointCoordinates) {
  using A = Arm<planar::Rigid, JointCoordinates>;
  expect_answers_in_a_run(A(), A());
}
TEST(StatesOfARun, AnswerForLinearJointsOfCables) {
  using A = Arm<planar::AncfCable<>, AncfLinear>;
  expect_answers_in_a_run(A(), A());
}
TEST(StatesOfARun, AnswerForSectionsOfBeams) {
  Arm<planar::AncfCable<>, Constraint> arm;
  for (auto const& now : arm.run(0.01)) {
    EXPECT_EQ(now.section_forces(arm.bars[1].at(0.2)), section_forces(arm.model, now, arm.bars[1].at(0.2)));
    EXPECT_EQ(now.section_strains(arm.bars[1].at(0.2)), section_strains(arm.model, now, arm.bars[1].at(0.2)));
  }
}

// Nothing is evaluated before a question; positions need no evaluation; all other questions share one.
TEST(Probe, EvaluatesAStateOnce) {
  Arm<planar::Rigid, Constraint> const arm;
  Probe probe(arm.model);
  long const before = *arm.pull.calls;
  auto const now = probe.at(arm.x);
  (void)now.position(arm.bars[1].at(0.5));
  EXPECT_EQ(probe.evaluations(), 0);
  (void)now.energy();
  (void)now.reaction(arm.pins[0]);
  EXPECT_EQ(*arm.pull.calls, before);
  (void)now.power(*arm.force);
  (void)now.applied_wrenches(*arm.force);
  (void)now.momentum();
  (void)now.largest_violation();
  EXPECT_EQ(probe.evaluations(), 1);
  EXPECT_EQ(*arm.pull.calls, before + 1);
  State same = arm.x;
  (void)probe.at(same).energy();
  EXPECT_EQ(probe.evaluations(), 1);
  same.t = 0.5;
  (void)probe.at(same).energy();
  EXPECT_EQ(probe.evaluations(), 2);
}

// The functions of model and state use the evaluation of the run, and not that of another model.
TEST(StatesOfARun, AreEvaluatedOnceForAllFunctions) {
  Arm<planar::Rigid, Constraint> arm;
  auto const other = arm.model;
  for (auto const& now : arm.run(0.003)) {
    long const before = *arm.pull.calls;
    double const supplied = power(arm.model, now, *arm.force);
    EXPECT_EQ(power(arm.model, now, *arm.force), supplied);
    EXPECT_EQ(now.power(*arm.force), supplied);
    EXPECT_EQ(*arm.pull.calls, before + 1);
    EXPECT_TRUE(now.belongs_to(arm.model) && !now.belongs_to(other));
    EXPECT_EQ(power(other, now, *arm.force), supplied);
    EXPECT_EQ(*arm.pull.calls, before + 2);
  }
}

// An answer belongs to the present content of its state, after a change by hand, another state and a step.
TEST(Probe, NeverGivesAnOldAnswer) {
  Arm<planar::Rigid, Constraint> arm;
  Probe probe(arm.model);
  State x = arm.x, y = arm.x;
  y.v[2] = 3.0;
  auto const first = probe.at(x), second = probe.at(y);
  double const still = first.energy().kinetic, moving = second.energy().kinetic;
  EXPECT_EQ(still, 0.0);
  EXPECT_GT(moving, 0.0);
  EXPECT_EQ(first.energy().kinetic, 0.0);
  x.v[2] = 3.0;
  EXPECT_EQ(first.energy().kinetic, moving);
  x.lambda[0] = 7.0;
  EXPECT_EQ(first.reaction(arm.pins[0]).f, reaction(arm.model, x, arm.pins[0]).f);

  auto run = arm.run();
  ObservedState const& now = *run.begin();
  double const start = now.energy().kinetic;
  for (int i = 0; i < 3; ++i) run.advance();
  EXPECT_EQ(now.t, arm.x.t);
  EXPECT_GT(now.energy().kinetic, start);
  EXPECT_TRUE(same_bits(now.energy(), energy(arm.model, arm.x)));
}

TEST(StatesOfARun, AreStatesInEveryLoop) {
  Arm<planar::Rigid, Constraint> arm;
  double end = 0.0;
  for (State const& now : arm.run(0.01)) end = now.t;
  EXPECT_NEAR(end, 0.01, 1e-15);
  Arm<planar::Rigid, Constraint> again;
  std::vector<State> kept;
  for (auto const& now : again.run(0.01)) kept.push_back(now);
  EXPECT_EQ(kept.size(), 11U);
  EXPECT_TRUE(same_bits(kept.back(), arm.x));
  using Run = decltype(arm.run());
  static_assert(std::input_iterator<Run::Iterator> && std::same_as<std::iter_value_t<Run::Iterator>, State>);
  static_assert(!std::copy_constructible<ObservedState>, "a copy would change with the run");
}

template <class P, class X>
concept CanProbe = requires(P& probe, X&& x) { probe.at(std::forward<X>(x)); };
template <class M>
concept CanBeProbed = std::constructible_from<Probe, M>;

TEST(Probe, RefusesStatesAndHandlesOfOtherModels) {
  Arm<planar::Rigid, Constraint> arm;
  Arm<planar::AncfCable<>, Constraint> const cables;
  Arm<planar::Rigid, Constraint> const twin;
  Probe probe(arm.model);
  auto const foreign = probe.at(cables.x);
  EXPECT_TRUE(has(refusal([&] { (void)foreign.energy(); }), "The state does not fit the model"));
  auto const now = probe.at(arm.x);
  EXPECT_TRUE(has(refusal([&] { (void)now.reaction(twin.pins[0]); }), "another model"));
  EXPECT_TRUE(has(refusal([&] { (void)now.position(twin.bars[0].at(0.1)); }), "another model"));
  EXPECT_TRUE(has(refusal([&] { (void)now.position(twin.model.ground().at({0, 0, 0})); }), "another model"));
  EXPECT_TRUE(has(refusal([&] { (void)now.joint_angle(ElementHandle<decltype(arm)::Pin>{}); }), "default-constructed"));
  State broken = arm.x;
  auto const view = probe.at(broken);
  (void)view.energy();
  broken.lambda.resize(1);
  EXPECT_TRUE(has(refusal([&] { (void)view.reaction(arm.pins[0]); }), "The state does not fit the model"));
  broken = arm.x;
  broken.q[0] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(has(refusal([&] { (void)view.energy(); }), "coordinates of the state"));
  EXPECT_TRUE(same_bits(now.energy(), energy(arm.model, arm.x)));
  arm.model.add(planar::Rigid(1.0, 1.0), "late");
  EXPECT_TRUE(has(refusal([&] { (void)now.energy(); }), "was added to the model"));
  using M = decltype(arm)::M;
  static_assert(CanProbe<Probe, State&> && CanProbe<Probe, State const&> && !CanProbe<Probe, State>);
  static_assert(CanBeProbed<M&> && CanBeProbed<M const&> && !CanBeProbed<M> && !CanBeProbed<Probe&>);
}

TEST(StatesOfARun, AreRefusedAfterAChangeOfTheModel) {
  Arm<planar::Rigid, Constraint> arm;
  auto run = arm.run();
  ObservedState const& now = run.now();
  arm.model.add(planar::Rigid(1.0, 1.0), "late");
  EXPECT_TRUE(has(refusal([&] { (void)now.energy(); }), "was added to the model"));
}

TEST(StatesOfARun, OfSystemsWithoutAModelRefuseQuestions) {
  Arm<planar::Rigid, Constraint> arm;
  RunSystems systems{std::make_unique<System>(system_for<GeneralisedAlpha>(arm.model)), nullptr};
  Simulation<GeneralisedAlpha> run(std::move(systems), arm.x, GeneralisedAlpha{}, {.end_time = 0.1, .step = 1e-3});
  EXPECT_TRUE(has(refusal([&] { (void)run.now().energy(); }), "made from systems without a probe"));
  EXPECT_EQ(run.now().t, 0.0);
}

TEST(Probe, AnswersForAModelWithoutItsType) {
  using A = Arm<planar::Rigid, Constraint>;
  A arm;
  AnyModel const any(std::make_shared<A::M const>(arm.model), stepped_by<GeneralisedAlpha>);
  Probe probe(any);
  EXPECT_TRUE(same_bits(probe.at(arm.x).energy(), energy(arm.model, arm.x)));
  for (auto const& now : simulate(any, arm.x, GeneralisedAlpha{}, {.end_time = 0.003, .step = 1e-3})) {
    EXPECT_TRUE(now.belongs_to(any));
    EXPECT_TRUE(same_bits(energy(any, now), energy(arm.model, State(now))));
  }
}

// As the start of a run: projected velocities, accelerations and multipliers. Coordinates do not change.
TEST(MakeConsistent, IsTheStartOfARun) {
  Arm<planar::Rigid, Constraint> arm;
  arm.x.v << 0.1, 1.0, 2.0, 0.3, 2.0, -1.0;
  State x = arm.x;
  make_consistent(arm.model, x);
  EXPECT_TRUE(same_bits(x.q, arm.x.q));
  EXPECT_LT(largest_violation(arm.model, x).velocity, 1e-13);
  EXPECT_LT(largest_violation(arm.model, x).acceleration, 1e-12);
  simulate(arm.model, arm.x, RungeKutta4<Projection>{}, {.end_time = 0.0, .step = 1e-3}).run();
  EXPECT_LT((x.v - arm.x.v).norm(), 1e-14);
  EXPECT_LT((x.a - arm.x.a).norm(), 1e-11);
  EXPECT_LT((x.lambda - arm.x.lambda).norm(), 1e-10);
  State open = arm.x;
  open.q[0] += 1e-3;
  State const before = open;
  EXPECT_TRUE(has(message_of<InconsistentInitialConditions>([&] { make_consistent(arm.model, open); }), "shoulder"));
  EXPECT_TRUE(same_bits(open, before));
}

TEST(RunReport, PrintsOneParagraph) {
  auto const text = [](RunReport const& report) { return (std::ostringstream() << report).str(); };
  RunReport report;
  report.steps = 1;
  report.iterations = 3;
  report.factorisations = 2;
  report.evaluations = 4;
  EXPECT_EQ(text(report), "1 step with 3 Newton iterations, 2 factorisations and 4 evaluations of the forces.");
  report.rejected = 2;
  report.halved = 1;
  report.events.push_back({"touch", 0.25});
  report.stopped = true;
  report.redundant = {"hinge"};
  report.warnings = {"It is late."};
  EXPECT_EQ(text(report),
            "1 step with 3 Newton iterations, 2 factorisations and 4 evaluations of the forces. 2 trial steps were "
            "rejected, 1 of them halved. Event \"touch\" at t = 0.25 s. The last event ended the run. Joint \"hinge\" "
            "has redundant constraint equations. Warning: It is late.");
  EXPECT_EQ(text(report).find('\n'), std::string::npos);
}

}  // namespace probe_test
