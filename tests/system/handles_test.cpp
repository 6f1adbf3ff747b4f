#include <gtest/gtest.h>

#include <optional>
#include <polybody/bodies/ffr/ffr.hpp>
#include <polybody/bodies/rigid/rigid.hpp>
#include <polybody/joints/spherical.hpp>
#include <polybody/run/observe.hpp>
#include <polybody/system/model.hpp>

#include "support/refusal.hpp"

using namespace polybody;

namespace handles_test {

using Ball = Joint<Spherical, Constraint>;
using M = Model<Bodies<Rigid<>, Ffr>, Joints<Ball>>;

char const* const empty = "A handle made by default names nothing in a model.";

Rigid<> cube(double mass) { return Rigid<>(mass, Mat3::Identity()); }
Ffr rod(double length) {
  return Ffr::from(
      {.length = length, .section = Circle{.radius = 0.02}, .material = {{.density = 7800, .young = 2e11}}}, 2);
}

/// A user's struct whose handles are set after it is made, though its bodies have no default constructor.
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

// A marker may be made on a copy of the handle when the handle itself is gone, and when the model stands elsewhere.
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

// The copy gets bodies of its own: what is added to it does not reach the original, and the other way round.
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

// A body taken from the model's own array is copied before the array grows.
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
