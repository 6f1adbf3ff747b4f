// Ranks and numbers of constraint equations: four-bar and Bricard mechanism (J5), a door on two pins, contradictory
// joints.

#include <gtest/gtest.h>

#include <polybody/bodies/rigid/planar_rigid.hpp>
#include <polybody/bodies/rigid/rigid.hpp>
#include <polybody/bodies/rigid/rigid_euler_parameters.hpp>
#include <polybody/integrators/generalised_alpha.hpp>
#include <polybody/integrators/runge_kutta.hpp>
#include <polybody/joints/driving_constraints.hpp>
#include <polybody/joints/planar/joints.hpp>
#include <polybody/joints/standard_joints.hpp>
#include <polybody/run/redundancy.hpp>
#include <polybody/run/simulate.hpp>

#include "support/held.hpp"
#include "support/linkages.hpp"
#include "support/refusal.hpp"

namespace polybody {
namespace redundancy_test {

using Pin = Joint<Revolute, Constraint>;
using FlatPin = Joint<planar::Revolute, Constraint>;

std::string names(Redundancy const& r) {
  std::string all;
  for (auto const& share : r.repeated) all += share.name + " " + std::to_string(share.rows) + " ";
  return all;
}

/// Checks the number of constraint equations, their rank and the degrees of freedom.
void expect_counts(std::string const& mechanism, Redundancy const& r, Index rows, Index rank, Index freedoms) {
  auto const same = [&](char const* what, Index found, Index counted) {
    held({"J5", what, By::closed_form, "counted", mechanism}, double(found), double(counted), 0.0);
  };
  same("rows of joints and bodies", r.rows, rows);
  same("rank of the rows", r.rank, rank);
  same("degrees of freedom", r.degrees_of_freedom, freedoms);
}

/// N windows of rods of 1 m (R2: IFToMM A02), upright or rotated by 90° into the flat configuration.
Model<Bodies<planar::Rigid>, Joints<FlatPin>> four_bars(int n, bool flat) {
  Model<Bodies<planar::Rigid>, Joints<FlatPin>> model;
  Vec2 const up = flat ? Vec2(1, 0) : Vec2(0, 1);
  auto const place = [&](double x, double y, double angle) { return Placement::planar(x, y, angle); };
  std::vector<BodyHandle<planar::Rigid>> side, top;
  for (int i = 0; i <= n; ++i)
    side.push_back(
        model.add(planar::Rigid(1.0, 1.0 / 12.0, place(i + 0.5 * up[0], 0.5 * up[1], std::atan2(up[1], up[0])))));
  for (int i = 0; i < n; ++i)
    top.push_back(model.add(planar::Rigid(1.0, 1.0 / 12.0, place(i + 0.5 + up[0], up[1], 0.0))));
  for (int i = 0; i <= n; ++i)
    model.connect(FlatPin{}, model.ground().at({double(i), 0, 0}), side[std::size_t(i)].at(Vec2(-0.5, 0)));
  for (int i = 0; i < n; ++i) {
    model.connect(FlatPin{}, side[std::size_t(i)].at(Vec2(0.5, 0)), top[std::size_t(i)].at(Vec2(-0.5, 0)));
    model.connect(FlatPin{}, top[std::size_t(i)].at(Vec2(0.5, 0)), side[std::size_t(i) + 1].at(Vec2(0.5, 0)));
  }
  return model;
}

// J5: 15 coordinates and 14 constraint equations of rank 14. The rank is 12 in the flat configuration, in which each
// window has two branches.
TEST(Redundancy, OfTheFourBarIsThatOfTheTheory) {
  auto const upright = four_bars(2, false), flat = four_bars(2, true);
  Redundancy const r = redundancy(upright, upright.reference_state()), f = redundancy(flat, flat.reference_state());
  expect_counts("four-bar of two windows, upright", r, 14, 14, 1);
  EXPECT_TRUE(r.repeated.empty());
  expect_counts("four-bar of two windows, flat", f, 14, 12, 3);
  EXPECT_TRUE(f.consistent());
}

// N + 1 instantaneous degrees of freedom in the flat configuration for any N.
TEST(Redundancy, OfFortyFlatWindowsIsForty) {
  auto const flat = four_bars(40, true);
  Redundancy const r = redundancy(flat, flat.reference_state());
  expect_counts("four-bar of 40 windows, flat", r, 2 * (41 + 2 * 40), 2 * (41 + 2 * 40) - 40, 41);
}

// J5: 30 generalised velocities and 30 constraint equations of rank 29. The last pin closes the loop.
TEST(Redundancy, OfTheBricardMechanismIsOne) {
  Bricard<> const b(0.1);
  Redundancy const r = redundancy(b.model, b.model.reference_state());
  expect_counts("Bricard mechanism", r, 30, 29, 1);
  EXPECT_EQ(names(r), "joint \"pin 5\" 1 ");
  EXPECT_TRUE(r.consistent());
}

// Euler parameters add five generalised velocities and five constraint equations of their own.
TEST(Redundancy, CountsRowsThatBodiesOwn) {
  Bricard<Constraint, Rigid<EulerParameters>> const b(0.1);
  Redundancy const r = redundancy(b.model, b.model.reference_state());
  expect_counts("Bricard mechanism, Euler parameters", r, 35, 34, 1);
}

// The rank is the same in millimetres and grams.
TEST(Redundancy, DoesNotDependOnTheUnits) {
  for (double const unit : {1e-6, 1.0, 1e6}) {
    Model<Bodies<Rigid<>>, Joints<Pin>> model;
    auto const door = model.add(Rigid<>(1.0, Mat3::Identity()), "door");
    for (double const z : {-1.0, 1.0})
      model.connect(Pin{{.axis = Vec3::UnitZ()}, {}}, model.ground().at({0, 0, z * unit}),
                    door.at(Vec3(0, 0, z * unit)));
    Redundancy const r = redundancy(model, model.reference_state());
    EXPECT_EQ(r.rank, 5) << unit;
    EXPECT_EQ(names(r), "joint \"Revolute 2\" 5 ") << unit;
  }
}

TEST(Redundancy, OfBodiesWithoutJointsIsNone) {
  Model<Bodies<Rigid<>>, Joints<Pin>> model;
  model.add(Rigid<>(1.0, Mat3::Identity()), "free");
  Redundancy const r = redundancy(model, model.reference_state());
  EXPECT_EQ(r.rows, 0);
  EXPECT_EQ(r.degrees_of_freedom, 6);
}

// --- contradictions -------------------------------------------------------------------------------------------

/// Planar point mass on two bars from the same point, of lengths 1 and `second`.
struct TwoBars {
  using Bar = Joint<Distance, Constraint>;
  Model<Bodies<planar::Rigid>, Joints<Bar>> model;
  State x;
  explicit TwoBars(double second) {
    auto const mass = model.add(planar::Rigid(1.0, 1.0, Placement::planar(1.0, 0.0)), "mass");
    auto const home = model.ground().at({0, 0, 0});
    model.connect(Bar{Distance{.length = 1.0}, {}}, home, mass.at(Vec2(0, 0)), "short");
    model.connect(Bar{Distance{.length = second}, {}}, home, mass.at(Vec2(0, 0)), "long");
    x = model.reference_state();
  }
};

TEST(Contradiction, InPositionsIsRefusedByAssemble) {
  TwoBars bars(1.1);
  State const before = bars.x;
  std::string const message = message_of<InconsistentInitialConditions>([&] { assemble(bars.model, bars.x); });
  EXPECT_TRUE(has(message, "joint \"short\", joint \"long\""));
  EXPECT_TRUE(has(message, "0.1"));
  EXPECT_TRUE(has(message, "positions"));
  EXPECT_TRUE(has(message, "Remove one"));
  EXPECT_EQ(bars.x.q, before.q);
  Redundancy const r = redundancy(bars.model, bars.x);
  EXPECT_EQ(r.rank, 1);
  EXPECT_EQ(r.in_positions, std::vector<std::string>{"joint \"short\", joint \"long\""});
  EXPECT_TRUE(r.in_velocities.empty());
}

TEST(Contradiction, IsNotSeenWhereBothAgree) {
  TwoBars bars(1.0);
  bars.x.q[0] = 0.9;
  assemble(bars.model, bars.x);
  EXPECT_NEAR(bars.x.q[0], 1.0, 1e-12);
  EXPECT_TRUE(redundancy(bars.model, bars.x).consistent());
}

/// φ = speed t + ½ acceleration t².
struct Quadratic {
  double speed = 0.0, acceleration = 0.0;
  Motion operator()(double t) const {
    return {speed * t + 0.5 * acceleration * t * t, speed + acceleration * t, acceleration};
  }
};

/// Wheel on a pin with two driving constraints.
struct DrivenTwice {
  using Drive = Joint<PrescribedAngle<Quadratic>, Constraint>;
  Model<Bodies<planar::Rigid>, Joints<FlatPin, Drive>> model;
  State x;
  DrivenTwice(Quadratic const& first, Quadratic const& second) {
    auto const wheel = model.add(planar::Rigid(1.0, 1.0), "wheel");
    auto const home = model.ground().at({0, 0, 0});
    model.connect(FlatPin{}, home, wheel.at(Vec2(0, 0)), "pin");
    model.connect(Drive{{.law = first}, {}}, home, wheel.at(Vec2(0, 0)), "motor");
    model.connect(Drive{{.law = second}, {}}, home, wheel.at(Vec2(0, 0)), "brake");
    x = model.reference_state();
  }
  template <class I = GeneralisedAlpha>
  RunReport run(I const& integrator = {}) {
    return simulate(model, x, integrator, {.end_time = 0.1, .step = 0.01}).run();
  }
};

TEST(Contradiction, InSpeedsIsRefusedByAssembleAndSimulate) {
  DrivenTwice wheel({.speed = 2.0}, {.speed = 1.5});
  State const before = wheel.x;
  for (bool const starts : {false, true}) {
    std::string const message =
        message_of<InconsistentInitialConditions>([&] { starts ? void(wheel.run()) : assemble(wheel.model, wheel.x); });
    EXPECT_TRUE(has(message, "joint \"motor\", joint \"brake\""));
    EXPECT_FALSE(has(message, "pin"));
    EXPECT_TRUE(has(message, "0.5 in their velocities"));
    EXPECT_EQ(wheel.x.q, before.q);
    EXPECT_EQ(wheel.x.v, before.v);
  }
  Redundancy const r = redundancy(wheel.model, wheel.x);
  EXPECT_EQ(r.in_velocities, std::vector<std::string>{"joint \"motor\", joint \"brake\""});
  EXPECT_TRUE(r.in_positions.empty());
  EXPECT_FALSE(r.consistent());
}

TEST(Contradiction, InAccelerationsIsRefusedWhateverStabilises) {
  auto const expect_refused = [](auto const& integrator) {
    DrivenTwice wheel({.acceleration = 3.0}, {.acceleration = 1.0});
    std::string const message = message_of<InconsistentInitialConditions>([&] { wheel.run(integrator); });
    EXPECT_TRUE(has(message, "joint \"motor\", joint \"brake\""));
    EXPECT_TRUE(has(message, "2 in their accelerations"));
    EXPECT_EQ(wheel.x.a, wheel.model.reference_state().a);
    EXPECT_EQ(redundancy(wheel.model, wheel.x).in_accelerations.size(), 1u);
  };
  expect_refused(GeneralisedAlpha{});
  expect_refused(RungeKutta4<Projection>{});
  expect_refused(RungeKutta4<Baumgarte>{{.alpha = 1e3, .beta = 1e3}});
}

TEST(Contradiction, IsNotSeenWhereDrivesAgree) {
  DrivenTwice wheel({.speed = 2.0, .acceleration = 3.0}, {.speed = 2.0, .acceleration = 3.0});
  assemble(wheel.model, wheel.x);
  RunReport const report = wheel.run();
  ASSERT_EQ(report.redundant.size(), 1u);
  EXPECT_NEAR(wheel.x.v[2], 2.0 + 3.0 * 0.1, 1e-3);
  EXPECT_TRUE(redundancy(wheel.model, wheel.x).consistent());
}

}  // namespace redundancy_test
}  // namespace polybody
