#include <gtest/gtest.h>

#include <optional>
#include <polybody/bodies/ffr/ffr.hpp>
#include <polybody/bodies/rigid/rigid.hpp>
#include <polybody/forces/springs.hpp>
#include <polybody/joints/standard_joints.hpp>
#include <polybody/run/probe.hpp>
#include <polybody/system/model.hpp>

#include "support/refusal.hpp"

using namespace polybody;

namespace handles_test {

using Ball = Joint<Spherical, Constraint>;
using Spring = SpringDamper;
using M = Model<Bodies<Rigid<>, Ffr>, Joints<Ball>, Forces<Spring>>;

char const* const empty = "A default-constructed handle refers to no object of a model.";

Rigid<> cube(double mass, Vec3 const& at = {0, 0, 0}) {
  return Rigid<>({.mass = mass, .inertia = Mat3::Identity(), .placement = Placement::at(at)});
}
Spring spring_of(double stiffness) { return {.stiffness = stiffness, .damping = 0.0, .free_length = 1.0}; }
Ffr rod(double length) {
  return Ffr::from(
      {.length = length, .section = Circle{.radius = 0.02}, .material = {{.density = 7800, .young = 2e11}}}, 2);
}

/// A user's struct whose handles are set after its construction, although its bodies have no default constructor.
struct Rig {
  BodyHandle<Rigid<>> hub;
  std::vector<BodyHandle<Ffr>> arms = std::vector<BodyHandle<Ffr>>(3);
  BodyHandle<Ground> ground;
  ElementHandle<Ball> ball;
};
static_assert(!std::is_default_constructible_v<Rigid<>> && !std::is_default_constructible_v<Ffr>);

TEST(Handles, AreMadeByDefaultAndAssignedLater) {
  M model;
  Rig rig;
  rig.hub = model.add(cube(2.0), "hub");
  for (std::size_t i = 0; i < 3; ++i) rig.arms[i] = model.add(rod(1.0 + double(i)));
  rig.ground = model.ground();
  rig.ball = model.connect(Ball{}, rig.hub.at(Vec3::Zero()), rig.arms[2].at(3.0), "ball");
  EXPECT_EQ(rig.hub.body().mass(), 2.0);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(rig.arms[i].body().length(), 1.0 + double(i));
  EXPECT_EQ(rig.ground.at(Vec3(1, 2, 3)).point.origin, Vec3(1, 2, 3));
  EXPECT_EQ(&model.entry(rig.ball), &std::get<0>(model.joint_pools()).front());
  EXPECT_TRUE(has(refusal([&] { (void)rig.arms[2].at(3.5); }), "\"" + rig.arms[2].name + "\": "));
}

TEST(Handles, RefuseToBeUsedBeforeTheyAreAssigned) {
  M model;
  model.add(cube(1.0));
  model.add(rod(1.0));
  State x = model.reference_state();
  Rig const rig;
  EXPECT_TRUE(has(refusal([&] { (void)rig.hub.at(Vec3(0, 0, 0)); }), empty));
  EXPECT_TRUE(has(refusal([&] { (void)rig.hub.at({0, 0, 0}); }), empty));
  EXPECT_TRUE(has(refusal([&] { (void)rig.arms[0].at(0.0); }), empty));
  EXPECT_TRUE(has(refusal([&] { (void)rig.arms[0].body(); }), empty));
  EXPECT_TRUE(has(refusal([&] { (void)rig.ground.at({0, 0, 0}); }), empty));
  EXPECT_TRUE(has(refusal([&] { (void)model.entry(rig.hub); }), empty));
  EXPECT_TRUE(has(refusal([&] { (void)model.entry(rig.ball); }), empty));
  EXPECT_TRUE(has(refusal([&] { model.set_velocity(x, rig.arms[1], {0, 0, 0}, {0, 0, 1}); }), empty));
  EXPECT_TRUE(has(refusal([&] { (void)coordinates_of(model, x, rig.hub); }), empty));
  EXPECT_TRUE(has(refusal([&] { (void)reaction(model, x, rig.ball); }), empty));
}

// A copy of a handle makes markers even if the handle itself is destroyed and the model has moved.
TEST(Handles, MakeMarkersWhenTheModelHasMoved) {
  std::optional<M> first(M{});
  auto handle = std::make_unique<BodyHandle<Ffr>>(first->add(rod(1.5), "rod"));
  BodyHandle<Ffr> const copy = *handle;
  handle.reset();
  M moved = std::move(*first);
  first.reset();
  auto const later = moved.add(rod(2.5), "later");
  moved.connect(Ball{}, moved.ground().at({0, 0, 0}), copy.at(0.0));
  moved.connect(Ball{}, copy.at(1.5), later.at(0.0));
  EXPECT_EQ(position(moved, moved.reference_state(), copy.at(1.5)), Vec3(1.5, 0, 0));
  EXPECT_TRUE(has(refusal([&] { (void)copy.at(1.6); }), "\"rod\": "));
}

TEST(Handles, ShareTheBodyWithTheModelHoweverItGrows) {
  M model;
  std::vector<BodyHandle<Ffr>> rods;
  for (int i = 0; i < 40; ++i) rods.push_back(model.add(rod(1.0 + i)));
  std::vector<BodyHandle<Ffr>> const copies = rods;
  for (std::size_t i = 0; i < 40; ++i) {
    EXPECT_EQ(&rods[i].body(), &model.entry(rods[i]).body);
    EXPECT_EQ(&copies[i].body(), &rods[i].body());
    EXPECT_EQ(copies[i].body().length(), 1.0 + double(i));
  }
}

TEST(Handles, KeepTheBodyWhenTheModelIsGone) {
  BodyHandle<Rigid<>> handle;
  {
    M model;
    handle = model.add(cube(3.0));
  }
  EXPECT_EQ(handle.body().mass(), 3.0);
}

// The copy has its own bodies: additions to the copy do not affect the original, and vice versa.
TEST(Handles, OfAModelServeItsCopyToo) {
  M model;
  auto const hub = model.add(cube(1.0), "hub");
  M copy = model;
  auto const only_in_copy = copy.add(cube(5.0));
  auto const only_in_model = model.add(cube(7.0));
  EXPECT_EQ(copy.entry(hub).body.mass(), 1.0);
  EXPECT_NE(&copy.entry(hub).body, &hub.body());
  EXPECT_EQ(copy.entry(only_in_copy).body.mass(), 5.0);
  EXPECT_EQ(only_in_copy.body().mass(), 5.0);
  EXPECT_EQ(model.entry(only_in_model).body.mass(), 7.0);
  EXPECT_EQ(only_in_model.body().mass(), 7.0);
  copy = model;
  EXPECT_EQ(copy.entry(only_in_model).body.mass(), 7.0);
  EXPECT_EQ(only_in_copy.body().mass(), 5.0);
}

/// Error messages of every use of a body's handle in `model`.
void expect_foreign(M& model, BodyHandle<Rigid<>> const& handle) {
  State x = model.reference_state();
  State const before = x;
  auto const at = handle.at({0, 0, 0});
  char const* const foreign = "of another model";
  EXPECT_TRUE(has(refusal([&] { (void)position(model, x, at); }), foreign));
  EXPECT_TRUE(has(refusal([&] { (void)model.entry(handle); }), foreign));
  EXPECT_TRUE(has(refusal([&] { model.set_velocity(x, handle, {1, 0, 0}, {0, 0, 1}); }), foreign));
  EXPECT_TRUE(has(refusal([&] { (void)coordinates_of(model, x, handle); }), foreign));
  EXPECT_TRUE(has(refusal([&] { (void)velocities_of(model, x, handle); }), foreign));
  EXPECT_TRUE(has(refusal([&] { model.connect(Ball{}, model.ground().at({0, 0, 0}), at); }), foreign));
  EXPECT_TRUE(has(refusal([&] { model.apply(spring_of(1.0), model.ground().at({0, 1, 0}), at); }), foreign));
  EXPECT_TRUE(has(refusal([&] { (void)index_of(layout_of(model), handle); }), foreign));
  EXPECT_TRUE(has(refusal([&] { (void)index_of(layout_of(model), at, "here"); }), foreign));
  EXPECT_EQ(x.v, before.v);
}

// The original has fewer bodies than the copy, as many, and more.
TEST(Handles, OfWhatIsAddedToACopyAreRefusedByTheOriginal) {
  M model;
  model.add(cube(1.0), "hub");
  M copy = model;
  auto const only_in_copy = copy.add(cube(5.0, {7, 0, 0}), "of the copy");
  EXPECT_NE(copy.serial(), model.serial());
  for (int i = 0; i < 3; ++i) {
    expect_foreign(model, only_in_copy);
    auto const only_in_model = model.add(cube(7.0, {3, 0, 0}));
    expect_foreign(copy, only_in_model);
    EXPECT_EQ(position(model, model.reference_state(), only_in_model.at({0, 0, 0})), Vec3(3, 0, 0));
  }
  EXPECT_EQ(position(copy, copy.reference_state(), only_in_copy.at({0, 0, 0})), Vec3(7, 0, 0));
}

TEST(Handles, OfJointsAndForcesAddedToACopyAreRefusedByTheOriginal) {
  M model;
  auto const hub = model.add(cube(1.0), "hub");
  auto const shared = model.connect(Ball{}, model.ground().at({0, 0, 0}), hub.at({0, 0, 0}), "shared");
  M copy = model;
  auto const ball = copy.connect(Ball{}, copy.ground().at({1, 0, 0}), hub.at({1, 0, 0}), "of the copy");
  auto const spring = copy.apply(spring_of(1.0), copy.ground().at({0, 1, 0}), hub.at({0, 0, 0}));
  char const* const foreign = "of another model";
  for (int i = 0; i < 2; ++i) {
    State const x = model.reference_state();
    EXPECT_TRUE(has(refusal([&] { (void)model.entry(ball); }), foreign));
    EXPECT_TRUE(has(refusal([&] { (void)reaction(model, x, ball); }), foreign));
    EXPECT_TRUE(has(refusal([&] { (void)constraint_violation(model, x, ball); }), foreign));
    EXPECT_TRUE(has(refusal([&] { (void)model.entry(spring); }), foreign));
    EXPECT_TRUE(has(refusal([&] { (void)index_of_force(layout_of(model), spring); }), foreign));
    EXPECT_EQ(constraint_violation(model, x, shared), Vec3(0, 0, 0));
    model.connect(Ball{}, model.ground().at({0, 1, 0}), hub.at({0, 1, 0}));
    model.apply(spring_of(1.0), model.ground().at({0, 1, 0}), hub.at({0, 0, 0}));
  }
  EXPECT_EQ(constraint_violation(copy, copy.reference_state(), ball), Vec3(0, 0, 0));
}

// Copies of copies accept the handles that each ancestor had at the time of copying; all descendants share the
// ground.
TEST(Handles, PassDownALineOfCopies) {
  M first;
  auto const a = first.add(cube(1.0));
  M second = first;
  auto const b = second.add(cube(2.0));
  auto const late = first.add(cube(9.0));
  M third = second;
  auto const c = third.add(cube(3.0));
  EXPECT_EQ(third.entry(a).body.mass(), 1.0);
  EXPECT_EQ(third.entry(b).body.mass(), 2.0);
  EXPECT_EQ(third.entry(c).body.mass(), 3.0);
  expect_foreign(third, late);
  expect_foreign(second, c);
  expect_foreign(first, b);
  third.connect(Ball{}, first.ground().at({0, 0, 0}), a.at({0, 0, 0}));
  EXPECT_TRUE(
      has(refusal([&] { first.connect(Ball{}, third.ground().at({0, 0, 0}), a.at({0, 0, 0})); }), "of another model"));
}

// A move transfers the handles and leaves an empty model, which may be filled again.
TEST(Handles, OfAMovedModelAreRefusedByWhatItLeaves) {
  M model;
  auto const hub = model.add(cube(1.0, {3, 0, 0}), "hub");
  M moved = std::move(model);
  EXPECT_EQ(model.body_count(), 0);  // NOLINT(bugprone-use-after-move): the state after a move is what is tested
  EXPECT_EQ(model.coordinates(), 0);
  expect_foreign(model, hub);
  auto const other = model.add(cube(2.0, {5, 0, 0}), "hub");
  expect_foreign(model, hub);
  expect_foreign(moved, other);
  EXPECT_EQ(position(model, model.reference_state(), other.at({0, 0, 0})), Vec3(5, 0, 0));
  EXPECT_EQ(position(moved, moved.reference_state(), hub.at({0, 0, 0})), Vec3(3, 0, 0));
  std::swap(model, moved);
  EXPECT_EQ(position(model, model.reference_state(), hub.at({0, 0, 0})), Vec3(3, 0, 0));
  expect_foreign(model, other);
}

TEST(Handles, OfAModelWhoseVectorGrowsStayValid) {
  std::vector<M> models(1);
  auto const hub = models[0].add(cube(1.0, {3, 0, 0}), "hub");
  std::uint64_t const serial = models[0].serial();
  models.resize(5);  // moves the models and does not copy them
  EXPECT_EQ(models[0].serial(), serial);
  EXPECT_EQ(position(models[0], models[0].reference_state(), hub.at({0, 0, 0})), Vec3(3, 0, 0));
}

TEST(Handles, RefuseStatesThatAreTooShort) {
  M model;
  auto const hub = model.add(cube(1.0), "hub"), wheel = model.add(cube(1.0), "wheel");
  State x = M(model).reference_state();
  x.q.conservativeResize(7);
  x.v.conservativeResize(6);
  char const* const unfitting = "does not fit the model";
  EXPECT_EQ(position(model, x, hub.at({0, 0, 0})), Vec3(0, 0, 0));
  EXPECT_TRUE(has(refusal([&] { (void)position(model, x, wheel.at({0, 0, 0})); }), unfitting));
  EXPECT_TRUE(has(refusal([&] { (void)coordinates_of(model, x, wheel); }), unfitting));
  EXPECT_TRUE(has(refusal([&] { (void)body_in_state(wheel, x); }), unfitting));
  EXPECT_TRUE(has(refusal([&] { (void)body_in_state(BodyHandle<Rigid<>>{}, x); }), empty));
  EXPECT_TRUE(has(refusal([&] { model.set_velocity(x, wheel, {1, 0, 0}, {0, 0, 0}); }), unfitting));
}

// A body from the model's own array is copied before the array grows.
TEST(Handles, GiveABodyThatMayBeAddedAgain) {
  M model;
  auto const first = model.add(rod(1.0));
  for (int i = 0; i < 8; ++i) model.add(first.body());
  EXPECT_EQ(model.body_count(), 9);
  model.for_each_body([&](auto const& e) {
    if constexpr (std::is_same_v<std::decay_t<decltype(e.body)>, Ffr>) {
      EXPECT_EQ(e.body.length(), 1.0);
    }
  });
}

}  // namespace handles_test
