// Consistent initial conditions of a rod on a pin and of a four-bar of uniform rods (crank 1, coupler 2, rocker 1.5,
// base 2).
#include <polybody/bodies/rigid/planar_rigid.hpp>
#include <polybody/joints/nonholonomic.hpp>
#include <polybody/joints/planar/joints.hpp>
#include <polybody/joints/policies/policy.hpp>
#include <polybody/run/initial_conditions.hpp>
#include <polybody/run/probe.hpp>
#include <polybody/solvers/block_factor.hpp>
#include <polybody/system/model.hpp>

#include <gtest/gtest.h>

#include "support/refusal.hpp"

namespace polybody {
namespace initial_conditions_test {

using Pin = Joint<planar::Revolute, Constraint>;
using TestModel = Model<Bodies<planar::Rigid>, Joints<Pin>>;

planar::Rigid rod(double length) {
  return planar::Rigid::from(
      {.length = length, .constants = BarConstants{.EA = 1.0, .EI = 1.0, .mass_per_length = 1.0}});
}

struct Pendulum {
  TestModel model;
  BodyHandle<planar::Rigid> bar = model.add(rod(1.0), "bar");
  ElementHandle<Pin> pin = model.connect(Pin{}, model.ground().at({0, 0, 0}), bar.at(0.0), "pin");
  State x = model.reference_state();
};

// All rods start at the origin along x. All joints except the first are violated until the state is set.
struct FourBar {
  TestModel model;
  BodyHandle<planar::Rigid> crank = model.add(rod(1.0), "crank"), coupler = model.add(rod(2.0), "coupler"),
                            rocker = model.add(rod(1.5), "rocker");
  ElementHandle<Pin> a = model.connect(Pin{}, model.ground().at({0, 0, 0}), crank.at(0.0), "A"),
                     b = model.connect(Pin{}, crank.at(1.0), coupler.at(0.0), "B"),
                     c = model.connect(Pin{}, coupler.at(2.0), rocker.at(1.5), "C"), d;
  State x;

  explicit FourBar(double base = 2.0)
      : d(model.connect(Pin{}, model.ground().at({base, 0, 0}), rocker.at(0.0), "D")), x(model.reference_state()) {
    place(0, 1.0, 0.0, 0.0, 1.2);
    place(1, 2.0, std::cos(1.2), std::sin(1.2), 0.3);
    place(2, 1.5, base, 0.0, 1.5);
  }
  void place(Index body, double length, double x0, double y0, double angle) {
    x.q.segment<3>(3 * body) << x0 + 0.5 * length * std::cos(angle), y0 + 0.5 * length * std::sin(angle), angle;
  }
  double largest_gap() const {
    double g = 0.0;
    for (auto const& joint : {a, b, c, d}) g = std::max(g, constraint_violation(model, x, joint).norm());
    return g;
  }
};

void expect_same(State const& a, State const& b) {
  EXPECT_EQ(a.t, b.t);
  EXPECT_EQ(a.q, b.q);
  EXPECT_EQ(a.v, b.v);
  EXPECT_EQ(a.a, b.a);
  EXPECT_EQ(a.lambda, b.lambda);
}

template <class Act>
std::string inconsistency(Act&& act) {
  try {
    act();
  } catch (InconsistentInitialConditions const& e) {
    return e.what();
  }
  ADD_FAILURE() << "an inconsistent start was accepted";
  return "";
}

// --- require_assembled ----------------------------------------------------------------------------------------

TEST(InitialConditions, TheJointThatIsOpenMostIsNamed) {
  FourBar f;
  System system(f.model);
  std::string const message = inconsistency([&] { require_assembled(system, f.x); });
  EXPECT_TRUE(has(message, "\"C\""));
  EXPECT_FALSE(has(message, "\"D\""));
  EXPECT_TRUE(has(message, "assemble"));
  // point of the coupler minus that of the rocker, by trigonometry
  double const x = std::cos(1.2) + 2.0 * std::cos(0.3) - 2.0 - 1.5 * std::cos(1.5);
  double const y = std::sin(1.2) + 2.0 * std::sin(0.3) - 1.5 * std::sin(1.5);
  EXPECT_TRUE(has(message, number(std::max(std::abs(x), std::abs(y)))));
}

TEST(InitialConditions, TheToleranceDecides) {
  Pendulum p;
  System system(p.model);
  EXPECT_NO_THROW(require_assembled(system, p.x));
  p.x.q[1] += 1e-6;
  EXPECT_THROW(require_assembled(system, p.x), InconsistentInitialConditions);
  // the extent of the bodies is 0.5 m
  EXPECT_THROW(require_assembled(system, p.x, 1.98e-6), InconsistentInitialConditions);
  EXPECT_NO_THROW(require_assembled(system, p.x, 2.02e-6));
}

// --- assemble -------------------------------------------------------------------------------------------------

TEST(InitialConditions, AssembleClosesEveryJoint) {
  FourBar f;
  f.x.v.setRandom();
  EXPECT_GT(f.largest_gap(), 0.1);
  State const before = f.x;
  assemble(f.model, f.x);
  EXPECT_LT(f.largest_gap(), 1e-12);
  EXPECT_LT((f.x.q - before.q).norm(), 0.7);  // the branch is unchanged
  System system(f.model);
  EXPECT_LT(largest_violation(system, f.x).velocity, 1e-13);
  EXPECT_GT(f.x.v.norm(), 0.1);  // the motion continues
  EXPECT_EQ(f.x.t, before.t);
}

// A pin with a violation along the rod, through its mass centre. The smallest correction is a translation along the
// rod.
TEST(InitialConditions, AssembleMovesAsLittleAsItCan) {
  Pendulum p;
  State const closed = p.x;
  p.x.q[0] += 0.05;
  assemble(p.model, p.x);
  EXPECT_LT((p.x.q - closed.q).norm(), 1e-14);
}

// A pin is added to a moving rod. The smallest change of the velocities in the mass norm conserves the angular
// momentum about the pin: ω = (m r × v + I ω₀)/(I + m r²) with r = 1/2, m = 1, I = 1/12.
TEST(InitialConditions, AssembleProjectsSpeedsAsAnImpactWould) {
  Pendulum p;
  p.x.v << 0.7, -0.4, 0.9;
  assemble(p.model, p.x);
  double const omega = (0.5 * -0.4 + 0.9 / 12.0) / (1.0 / 12.0 + 0.25);
  EXPECT_LT((p.x.v - Vec3(0.0, 0.5 * omega, omega)).norm(), 1e-15);
}

TEST(InitialConditions, AssembleLeavesAClosedModelAlone) {
  Pendulum p;
  p.model.set_velocity(p.x, p.bar, Vec3::Zero(), {0.0, 0.0, 2.0});
  State const before = p.x;
  assemble(p.model, p.x);
  EXPECT_EQ(p.x.q, before.q);
  EXPECT_LT((p.x.v - before.v).norm(), 1e-15);
}

// At a base of 6, rods of 1 + 2 + 1.5 cannot form a loop.
TEST(InitialConditions, WhatCannotCloseIsRefusedAndTheStateStays) {
  FourBar f(6.0);
  State const before = f.x;
  std::string const message = inconsistency([&] { assemble(f.model, f.x); });
  EXPECT_TRUE(has(message, "\"")) << message;
  expect_same(f.x, before);
}

// Two blades at one point with the relative angle 0.01 rad fix the point. One blade carries 1e-5 of the mass. After
// elimination of the equation that moves the light rod alone, the remainder with the heavy rod is too small for a
// pivot.
TEST(InitialConditions, ARowThatIsLeftOutAndStaysOpenIsRefused) {
  using Blade = Joint<KnifeEdge, Constraint>;
  for (double const mass : {1.0, 1e-5}) {
    Model<Bodies<planar::Rigid>, Joints<Pin, Blade>> model;
    auto const heavy = model.add(planar::Rigid(1.0, 1.0), "heavy"),
               light = model.add(planar::Rigid(mass, mass), "light");
    model.connect(Pin{}, heavy.at(Vec2(0, 0)), light.at(Vec2(0, 0)), "pin");
    model.connect(Blade{KnifeEdge{.across = Vec3::UnitY()}, {}}, model.ground().at({0, 0, 0}), heavy.at(Vec2(0, 0)),
                  "first");
    model.connect(Blade{KnifeEdge{.across = {std::sin(0.01), std::cos(0.01), 0}}, {}}, model.ground().at({0, 0, 0}),
                  light.at(Vec2(0, 0)), "second");
    State x = model.reference_state();
    model.set_velocity(x, heavy, Vec3(10, 0, 0), Vec3::Zero());
    model.set_velocity(x, light, Vec3(10, 0, 0), Vec3::Zero());
    System system(model, with<Capabilities::motion>);
    if (mass == 1.0) {
      assemble<BlockSolver>(system, x);
      EXPECT_LT(x.v.cwiseAbs().maxCoeff(), 1e-9);  // the point is fixed
    } else {
      std::string const message = inconsistency([&] { assemble<BlockSolver>(system, x); });
      EXPECT_TRUE(has(message, "The constraint equations of joint \"second\" are nearly redundant")) << message;
      EXPECT_TRUE(has(message, "velocities violate them by 0.09")) << message;
    }
  }
}

TEST(InitialConditions, AStateOfAnotherModelIsRefused) {
  Pendulum p;
  FourBar f;
  State const before = p.x;
  EXPECT_TRUE(has(refusal([&] { assemble(f.model, p.x); }), "does not fit"));
  expect_same(p.x, before);
}

TEST(InitialConditions, AStateThatIsNotFiniteIsRefused) {
  for (bool const speed : {false, true}) {
    Pendulum p;
    (speed ? p.x.v : p.x.q)[1] = std::numeric_limits<double>::quiet_NaN();
    EXPECT_TRUE(has(refusal([&] { assemble(p.model, p.x); }), speed ? "velocities" : "coordinates"));
  }
}

}  // namespace initial_conditions_test
}  // namespace polybody
