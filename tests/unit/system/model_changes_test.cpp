#include <gtest/gtest.h>

#include <memory>
#include <polybody/bodies/rigid/planar_rigid.hpp>
#include <polybody/integrators/generalised_alpha.hpp>
#include <polybody/integrators/radau.hpp>
#include <polybody/integrators/runge_kutta.hpp>
#include <polybody/io/visual.hpp>
#include <polybody/joints/planar/joints.hpp>
#include <polybody/run/any_model.hpp>
#include <polybody/run/body_record.hpp>
#include <polybody/run/energy_audit.hpp>
#include <polybody/run/probe.hpp>
#include <polybody/run/simulate.hpp>

#include "support/refusal.hpp"

using namespace polybody;

// A run, a system or a recorder keeps a reference to its model. Each use of it after a change of the model throws
// InvalidInput. Under the address sanitizer these tests also show that no use reads freed memory.
namespace model_changes_test {

template <class Policy>
using Pin = Joint<planar::Revolute, Policy>;
template <class Policy>
using Bars = Model<Bodies<planar::Rigid>, Joints<Pin<Policy>>>;

RunOptions const options{.end_time = 0.1, .step = 0.01};
char const* const grown = "was added to the model while a run, system or recorder referred to it";
char const* const moved = "The model was moved to another object while a run, system or recorder referred to it";
char const* const ended = "The model was destroyed or assigned to while a run, system or recorder still referred to it";

template <class Policy = Constraint>
Bars<Policy> bar() {
  Bars<Policy> model{Gravity{0, -9.81, 0}};
  auto const a = model.add(planar::Rigid(1, 0.1, Placement::planar(0.5, 0)), "a");
  model.connect(Pin<Policy>{}, model.ground().at({0, 0, 0}), a.at(Vec2(-0.5, 0)), "pin");
  return model;
}
template <class M>
void grow(M& model) {
  for (int i = 0; i < 50; ++i) model.add(planar::Rigid(1, 0.1, Placement::planar(1.5 + i, 0)));
}

/// A run stops with `sentence` after `change`, and its state remains that of the last step.
template <class Policy, class I>
void expect_stop(I const& integrator, std::function<void(std::unique_ptr<Bars<Policy>>&)> const& change,
                 char const* sentence) {
  auto model = std::make_unique<Bars<Policy>>(bar<Policy>());
  State x = model->reference_state();
  auto run = simulate(*model, x, integrator, options);
  run.advance();
  State const before = x;
  change(model);
  for (int i = 0; i < 2; ++i) EXPECT_TRUE(has(refusal([&] { run.advance(); }), sentence));
  EXPECT_TRUE(has(refusal([&] { run.run(); }), sentence));
  EXPECT_TRUE(has(refusal([&] { (void)run.snapshot(); }), sentence));
  EXPECT_EQ(x.q, before.q);
  EXPECT_EQ(x.v, before.v);
  EXPECT_EQ(x.t, before.t);
}
template <class Policy, class I>
void expect_stops(I const& integrator) {
  using M = Bars<Policy>;
  std::unique_ptr<M> other;
  expect_stop<Policy>(integrator, [](auto& model) { grow(*model); }, grown);
  expect_stop<Policy>(
      integrator,
      [](auto& model) {
        auto const b = model->add(planar::Rigid(1, 0.1), "b");
        model->connect(Pin<Policy>{}, model->ground().at({0, 0, 0}), b.at(Vec2(0, 0)));
      },
      grown);
  expect_stop<Policy>(integrator, [&](auto& model) { other = std::make_unique<M>(std::move(*model)); }, moved);
  expect_stop<Policy>(
      integrator,
      [&](auto& model) {
        other = std::make_unique<M>(std::move(*model));
        model.reset();
      },
      moved);
  expect_stop<Policy>(integrator, [](auto& model) { model.reset(); }, ended);
  expect_stop<Policy>(integrator, [](auto& model) { *model = bar<Policy>(); }, ended);
  expect_stop<Policy>(
      integrator,
      [](auto& model) {
        M const copy = *model;
        *model = copy;
      },
      ended);
}

TEST(ModelChanges, StopARunInASentence) {
  expect_stops<Constraint>(GeneralisedAlpha{});
  expect_stops<Constraint>(Radau{});
  expect_stops<Constraint>(RungeKutta4<Projection>{});
}
TEST(ModelChanges, StopARunInJointCoordinates) {
  expect_stops<JointCoordinates>(GeneralisedAlpha{});
  expect_stops<JointCoordinates>(RungeKutta4<>{});
}
TEST(ModelChanges, StopARunOfATreeThatIsItsOwnSolver) {
  using ByBodies = JointCoordinatesBy<joint_coordinates::ArticulatedBody>;
  expect_stops<ByBodies>(GeneralisedAlpha{});
  expect_stops<ByBodies>(RungeKutta4<>{});
}

// A change or destruction of a copy does not affect the runs of its original.
TEST(ModelChanges, OfACopyLeaveARunAlone) {
  auto const last = [](bool copied) {
    auto model = bar();
    State x = model.reference_state();
    auto run = simulate(model, x, GeneralisedAlpha{}, options);
    run.advance();
    if (copied) {
      auto copy = model;
      grow(copy);
    }
    run.run();
    return x;
  };
  State const with = last(true), without = last(false);
  EXPECT_EQ(with.q, without.q);
  EXPECT_EQ(with.v, without.v);
}

TEST(ModelChanges, StopSystemsAuditsAndRecorders) {
  auto model = std::make_unique<Bars<Constraint>>(bar());
  State const x = model->reference_state();
  State next = x;
  next.t = 1.0;
  System system(*model);
  EnergyAudit audit(*model), fresh(*model);
  LoadRecorder recorder(*model);
  Visual visual(*model);
  audit.record(x);
  recorder.record(x);
  system.evaluate(x.q, x.v, x.t);
  grow(*model);
  auto const expect = [&](char const* sentence) {
    EXPECT_TRUE(has(refusal([&] { system.evaluate(x.q, x.v, x.t); }), sentence));
    EXPECT_TRUE(has(refusal([&] { (void)largest_violation(system, x); }), sentence));
    EXPECT_TRUE(has(refusal([&] { fresh.start(x); }), sentence));
    EXPECT_TRUE(has(refusal([&] { audit.record(next); }), sentence));
    EXPECT_TRUE(has(refusal([&] { recorder.record(next); }), sentence));
    EXPECT_TRUE(has(refusal([&] { (void)visual.at(x); }), sentence));
  };
  expect(grown);
  auto const other = std::make_unique<Bars<Constraint>>(std::move(*model));
  expect(moved);
  model.reset();
  expect(moved);
}

TEST(ModelChanges, BeforeARunBeginsAreNoMatter) {
  auto model = bar();
  grow(model);
  auto const there = std::move(model);
  State x = there.reference_state();
  EXPECT_EQ(simulate(there, x, GeneralisedAlpha{}, options).run().steps, 10);
}

TEST(ModelChanges, OfAnEmptiedModelAreAsOfANewOne) {
  auto model = bar();
  auto const there = std::move(model);
  State none = model.reference_state();  // NOLINT(bugprone-use-after-move): the state after a move is what is tested
  EXPECT_EQ(none.q.size(), 0);
  EXPECT_TRUE(has(refusal([&] { (void)simulate(model, none, GeneralisedAlpha{}, options); }), "no moving body"));
  auto const a = model.add(planar::Rigid(1, 0.1, Placement::planar(0.5, 0)), "a");
  model.connect(Pin<Constraint>{}, model.ground().at({0, 0, 0}), a.at(Vec2(-0.5, 0)), "pin");
  State x = model.reference_state(), y = there.reference_state();
  simulate(model, x, GeneralisedAlpha{}, options).run();
  simulate(there, y, GeneralisedAlpha{}, options).run();
  EXPECT_EQ(x.q, y.q);
}

// A temporary model is refused at compile time: tests/compile_fail contains the messages of `simulate` and `resume`.
template <class M>
concept TakesTemporaries = std::constructible_from<System, M> || std::constructible_from<EnergyAudit, M> ||
                           std::constructible_from<LoadRecorder, M> || std::constructible_from<Visual, M> ||
                           requires(M model) { observation_system(std::move(model)); } ||
                           requires(M model) { run_systems<GeneralisedAlpha>(std::move(model)); } ||
                           requires(M model) { stepped_system(std::move(model)); } ||
                           requires(M model) { system_for<GeneralisedAlpha>(std::move(model)); };
static_assert(!TakesTemporaries<Bars<Constraint>> && !TakesTemporaries<Bars<Constraint> const>);
static_assert(std::constructible_from<EnergyAudit, Bars<Constraint>&> &&
              std::constructible_from<Visual, Bars<Constraint> const&>);

}  // namespace model_changes_test
