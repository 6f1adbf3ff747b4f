// What cannot be meant is refused in a sentence, and not by a crash or an exception of the standard library.
#include <gtest/gtest.h>

#include <polybody/polybody.hpp>

#include "support/refusal.hpp"

namespace polybody::hostile_input_test {
namespace {

using Pin = Joint<Revolute, Constraint>;
Bar const bar{.length = 1.0,
              .section = Circle{.radius = 0.01},
              .material = Material{.density = 7800, .young = 2e11, .poisson = 0.3}};

TEST(HostileInput, AModelWithoutBodiesIsRefusedByEveryDoor) {
  Model<Bodies<Rigid<>>, Joints<Pin>> const model{Gravity{0, 0, -9.81}};
  State x = model.reference_state();
  std::string const said = "no body that moves";
  EXPECT_TRUE(has(refusal([&] { simulate(model, x, GeneralizedAlpha{}, {.until = 0.1, .step = 1e-3}).run(); }), said));
  EXPECT_TRUE(has(refusal([&] { energy(model, x); }), said));
  EXPECT_TRUE(has(refusal([&] { equilibrium(model, x); }), said));
  EXPECT_TRUE(has(refusal([&] { assemble(model, x); }), said));
}

TEST(HostileInput, ARigidBodyAndTheGroundAreNotJoinedToThemselves) {
  using Ball = Joint<Spherical, Constraint>;
  Model<Bodies<Rigid<>, AncfCable<>>, Joints<Pin, Ball>> model;
  auto const one = model.add(Rigid<>::from(bar), "one"), other = model.add(Rigid<>::from(bar), "other");
  auto const cable = model.add(AncfCable<>::from(bar, 4), "cable");
  Pin const pin{Revolute{.axis = Vec3::UnitY()}, Constraint{}};
  EXPECT_TRUE(has(refusal([&] { model.connect(pin, one.at(0.0), one.at(1.0), "loop"); }),
                  "\"loop\" joins a rigid body to itself"));
  EXPECT_TRUE(
      has(refusal([&] { model.connect(pin, model.ground().at({0, 0, 0}), model.ground().at({0, 0, 1}), "fixed"); }),
          "\"fixed\" joins the ground to itself"));
  EXPECT_EQ(model.rows(), 0);  // a refusal leaves the model as it was
  EXPECT_EQ(model.markers(), 0);
  model.connect(pin, one.at(0.0), other.at(1.0));
  model.connect(Ball{Spherical{}, Constraint{}}, cable.at(0.0), cable.at(1.0));  // a ring
  EXPECT_EQ(model.rows(), 8);
}

TEST(HostileInput, MoreElementsThanMemoryHoldsAreRefused) {
  Index const many = 1'000'000'000'000;
  EXPECT_TRUE(has(refusal([&] { AncfCable<>::from(bar, many); }), "1000000000000 elements are more than memory holds"));
  EXPECT_TRUE(has(refusal([&] { AncfBeam<>::from(bar, many); }), "elements are more than memory holds"));
  EXPECT_TRUE(has(refusal([&] { Lrvf<>::from(bar, many); }), "elements are more than memory holds"));
  EXPECT_TRUE(has(refusal([&] { planar::AncfCable<>::from(bar, many); }), "elements are more than memory holds"));
  EXPECT_TRUE(has(refusal([&] { planar::Lrvf::from(bar, many); }), "elements are more than memory holds"));
  EXPECT_TRUE(has(refusal([&] { AncfCable<>::from(bar, 0); }), "AncfCable: at least one element is needed"));
}

}  // namespace
}  // namespace polybody::hostile_input_test
