// Invalid input throws an `Error` that names it. It causes neither a crash nor an exception of the standard library.
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
  std::string const said = "no moving body";
  EXPECT_TRUE(
      has(refusal([&] { simulate(model, x, GeneralisedAlpha{}, {.end_time = 0.1, .step = 1e-3}).run(); }), said));
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
  EXPECT_EQ(model.rows(), 0);  // a refusal leaves the model unchanged
  EXPECT_EQ(model.markers(), 0);
  model.connect(pin, one.at(0.0), other.at(1.0));
  model.connect(Ball{Spherical{}, Constraint{}}, cable.at(0.0), cable.at(1.0));  // a ring
  EXPECT_EQ(model.rows(), 8);
}

TEST(HostileInput, MoreElementsThanMemoryHoldsAreRefused) {
  Index const many = 1'000'000'000'000;
  EXPECT_TRUE(has(refusal([&] { AncfCable<>::from(bar, many); }), "1000000000000 elements do not fit into the memory"));
  EXPECT_TRUE(has(refusal([&] { AncfBeam<>::from(bar, many); }), "elements do not fit into the memory"));
  EXPECT_TRUE(has(refusal([&] { Lrvf<>::from(bar, many); }), "elements do not fit into the memory"));
  EXPECT_TRUE(has(refusal([&] { planar::AncfCable<>::from(bar, many); }), "elements do not fit into the memory"));
  EXPECT_TRUE(has(refusal([&] { planar::Lrvf::from(bar, many); }), "elements do not fit into the memory"));
  EXPECT_TRUE(has(refusal([&] { AncfCable<>::from(bar, 0); }), "AncfCable: at least one element is needed"));
}

// A quaternion with another norm would change the size of the body.
TEST(HostileInput, QuaternionsOfAnotherNormAreRefused) {
  Model<Bodies<Rigid<>>, Joints<Pin>> model;
  model.add(Rigid<>::from(bar), "first");
  model.add(Rigid<>::from(bar), "second");
  for (double const norm : {0.0, 0.5, 2.0, 1e200}) {
    State x = model.reference_state();
    x.q.tail<4>() = Vec<double, 4>(norm, 0, 0, 0);
    auto const run = [&] { simulate(model, x, GeneralisedAlpha{}, {.end_time = 0.1, .step = 1e-3}); };
    EXPECT_TRUE(has(refusal(run), "body \"second\" are invalid")) << norm;
  }
}

// A spring between coincident points has no direction: 0/0.
TEST(HostileInput, ASpringBetweenCoincidentPointsIsNamed) {
  Model<Bodies<Rigid<>>, Joints<>, Forces<SpringDamper>> model;
  auto const rod = model.add(Rigid<>::from(bar), "rod");
  model.apply(SpringDamper{.stiffness = 10.0, .free_length = 0.5}, model.ground().at({0, 0, 0}), rod.at(0.0), "strut");
  State x = model.reference_state();
  std::string const said = "is not finite at t = 0 s (force element \"strut\")";
  EXPECT_TRUE(
      has(message_of<NonFiniteValue>([&] { simulate(model, x, GeneralisedAlpha{}, {.end_time = 0.1, .step = 1e-3}); }),
          said));
  EXPECT_TRUE(has(
      message_of<NonFiniteValue>([&] { simulate(model, x, RungeKutta4<>{}, {.end_time = 0.1, .step = 1e-3}); }), said));
}

template <class I>
void expect_finite(I const& integrator) {
  Model<Bodies<Rigid<>>, Joints<>> model{Gravity{0, 0, -9.81}};
  Mat3 const inertia = Vec3(1.0, 2.0, 3.0).asDiagonal();
  model.add(Rigid<>(1.0, inertia), "still");
  model.add(Rigid<>(1.0, inertia), "wild");
  for (Index const i : {6, 9, 10})
    for (double const speed : {1e100, 1e200, 1e308}) {
      State x = model.reference_state();
      x.v[i] = speed;
      try {
        for (State const& now : simulate(model, x, integrator, {.end_time = 1.0, .step = 0.1})) {
          ASSERT_TRUE(now.q.allFinite() && now.v.allFinite()) << I::name << ' ' << i << ' ' << speed;
          ASSERT_TRUE(std::isfinite(energy(model, now).total())) << I::name << ' ' << i << ' ' << speed;
          ASSERT_NEAR((now.q.tail<4>().norm()), 1.0, 1e-9) << I::name << ' ' << i << ' ' << speed;
        }
      } catch (Error const& error) {
        EXPECT_TRUE(x.q.allFinite() && x.v.allFinite()) << error.what();
        EXPECT_FALSE(has(error.what(), "\"still\"")) << error.what();
      }
    }
}
TEST(HostileInput, WildSpeedsEndInAnErrorAndNotInNaN) {
  expect_finite(GeneralisedAlpha{});
  expect_finite(Radau{});
  expect_finite(RungeKutta4<>{});
  expect_finite(CentralDifference<>{});
  expect_finite(Rattle{});
  expect_finite(SymplecticEuler{});
  expect_finite(DormandPrince<>{});
  expect_finite(AdamsBashforthMoulton<>{});
}

/// A rod, free or on a pin, that is pushed or falls.
struct Pushed {
  using Hinge = Joint<planar::Revolute, Constraint>;
  Model<Bodies<planar::Rigid>, Joints<Hinge>, Forces<PointForce<>>> model;
  State x;

  Pushed(bool pinned, double force, double gravity) : model(Gravity{0, -gravity, 0}) {
    auto const rod = model.add(planar::Rigid(1.0, 1.0), "rod");
    if (pinned) model.connect(Hinge{}, model.ground().at({-1, 0, 0}), rod.at(Vec2(-1, 0)), "pin");
    model.apply(PointForce<>{.force = {0, force, 0}}, rod.at(Vec2(0.5, 0)), "push");
    x = model.reference_state();
  }
  /// Error message of a run with invalid input.
  template <class I>
  std::string message(I const& integrator) {
    std::string said;
    try {
      simulate(model, x, integrator, {.end_time = 0.02, .step = 0.01}).run();
      ADD_FAILURE() << I::name << " goes through";
    } catch (NonFiniteValue const& error) {
      said = error.what();
    } catch (MinimumStepReached const& error) {
      said = error.what();
    } catch (std::exception const& error) {
      ADD_FAILURE() << I::name << ": " << error.what();
    }
    EXPECT_TRUE(x.q.allFinite() && x.v.allFinite() && x.a.allFinite() && x.lambda.allFinite()) << said;
    EXPECT_TRUE(std::isfinite(energy(model, x).total())) << said;
    return said;
  }
};

template <class I>
void expect_refused(I const& integrator) {
  for (bool const pinned : {false, true})
    for (double const size : {1e160, 1e300, 1e308}) {
      std::string const said = Pushed(pinned, size, 0.0).message(integrator);
      EXPECT_TRUE(has(said, "\"push\"") || has(said, "the tolerance requires a step below")) << size << ' ' << pinned;
      Pushed(pinned, 1.0, size).message(integrator);
    }
}
// A sum that overflows is not a redundant joint.
TEST(HostileInput, ForcesThatOverflowAreNamedAndNotCalledSingular) {
  expect_refused(GeneralisedAlpha{});
  expect_refused(Radau{});
  expect_refused(EnergyMomentum{});
  expect_refused(RungeKutta4<Projection>{});
  expect_refused(DormandPrince<Projection>{});
}

TEST(HostileInput, NumbersWhoseSquaresOverflowAreRefusedAtTheStart) {
  for (double const size : {1e151, 1e200, 1e308}) {
    Pushed fast(false, 1.0, 0.0), far(false, 1.0, 0.0);
    fast.x.v[0] = far.x.q[0] = size;
    RunOptions const options{.end_time = 0.1, .step = 0.01};
    EXPECT_TRUE(has(refusal([&] { simulate(fast.model, fast.x, GeneralisedAlpha{}, options); }),
                    "A velocity of body \"rod\" is " + number(size)));
    EXPECT_TRUE(has(refusal([&] { simulate(far.model, far.x, GeneralisedAlpha{}, options); }),
                    "A coordinate of body \"rod\" is " + number(size)));
  }
}

}  // namespace
}  // namespace polybody::hostile_input_test
