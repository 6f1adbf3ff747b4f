// Quaternions whose norm is not one are refused, and small mechanisms start closed relative to their extent.

#include <gtest/gtest.h>

#include <polybody/bodies/rigid/planar_rigid.hpp>
#include <polybody/bodies/rigid/rigid.hpp>
#include <polybody/integrators/generalised_alpha.hpp>
#include <polybody/integrators/runge_kutta.hpp>
#include <polybody/joints/joint.hpp>
#include <polybody/joints/planar/joints.hpp>
#include <polybody/joints/standard_joints.hpp>
#include <polybody/run/diagnose.hpp>
#include <polybody/run/initial_conditions.hpp>
#include <polybody/run/marker_frames.hpp>
#include <polybody/run/probe.hpp>
#include <polybody/run/redundancy.hpp>
#include <polybody/run/simulate.hpp>

#include "support/refusal.hpp"

namespace polybody {
namespace state_places_test {

struct FreeBody {
  Model<Bodies<Rigid<>>, Joints<>> model;
  BodyHandle<Rigid<>> body = model.add(Rigid<>(1.0, Vec3(0.1, 0.2, 0.3).asDiagonal().toDenseMatrix()), "top");
  State x = model.reference_state();
};

// The start (1, 1, 1, 0): its norm √3 gives axes of length 3.
TEST(StatePlaces, AQuaternionThatIsNotOfUnitNormIsRefused) {
  FreeBody free;
  free.x.q.tail<4>() = Vec4(1, 1, 1, 0);
  State const before = free.x;
  EXPECT_TRUE(has(refusal([&] { simulate(free.model, free.x, RungeKutta4<>{}, {.end_time = 1.0, .step = 0.1}); }),
                  "the norm of a quaternion must be one"));
  EXPECT_TRUE(has(refusal([&] { assemble(free.model, free.x); }), "the norm of a quaternion must be one"));
  EXPECT_TRUE(has(refusal([&] { (void)redundancy(free.model, free.x); }), "the norm of a quaternion must be one"));
  EXPECT_TRUE(has(refusal([&] { (void)diagnose(free.model, free.x); }), "the norm of a quaternion must be one"));
  EXPECT_EQ(free.x.q, before.q);
  std::string const said = refusal([&] { (void)frame(free.model, free.x, free.body.at(Vec3(1, 0, 0))); });
  EXPECT_TRUE(has(said, "the quaternion of body \"top\" has the norm 1.732")) << said;
  EXPECT_TRUE(has(refusal([&] { (void)position(free.model, free.x, free.body.at(Vec3(1, 0, 0))); }), "norm 1.732"));
}
TEST(StatePlaces, ANormalisedQuaternionIsAccepted) {
  FreeBody free;
  free.x.q.tail<4>() = Vec4(1, 1, 1, 0).normalized();
  assemble(free.model, free.x);
  EXPECT_NEAR(frame(free.model, free.x, free.body.at(Vec3(1, 0, 0))).A.determinant(), 1.0, 1e-14);
}
// g l m/(J + m l²) of a rod of 1 kg with J = 1 kg m² about its centre, 1 m from a horizontal pin.
TEST(StatePlaces, AHorizontalRodFallsWithTheRightAcceleration) {
  using Pin = Joint<Revolute, Constraint>;
  Model<Bodies<Rigid<>>, Joints<Pin>> model{Gravity{0, 0, -9.81}};
  auto const rod = model.add(Rigid<>(1.0, Mat3::Identity(), Placement::at({1, 0, 0})), "rod");
  model.connect(Pin{Revolute{.axis = Vec3::UnitY()}}, model.ground().at({0, 0, 0}), rod.at(Vec3(-1, 0, 0)), "pin");
  State x = model.reference_state();
  auto run = simulate(model, x, GeneralisedAlpha{}, {.end_time = 1.0, .step = 1e-3});
  EXPECT_NEAR(std::abs(x.a[4]), 4.905, 1e-12);
}

/// A rod of half length `half` [m] whose pin is open by `gap` [m], with a rod of 1 m beside it that is not connected.
struct SmallPendulum {
  using Pin = Joint<planar::Revolute, Constraint>;
  Model<Bodies<planar::Rigid>, Joints<Pin>> model;
  State x;
  SmallPendulum(double half, double gap, double from_origin = 0.0) {
    auto const rod = model.add(planar::Rigid(1e-12, 1e-24, Placement::planar(from_origin + half, 0.0)), "rod");
    auto const beside = model.add(planar::Rigid(1.0, 1.0, Placement::planar(0.5, 0.0)), "beside");
    model.connect(Pin{}, model.ground().at({from_origin, gap, 0}), rod.at(Vec2(-half, 0)), "pin");
    model.connect(Pin{}, model.ground().at({0, 0, 0}), beside.at(Vec2(-0.5, 0)), "pin beside");
    x = model.reference_state();
  }
  void start() { simulate(model, x, GeneralisedAlpha{}, {.end_time = 1e-3, .step = 1e-3}); }
};
std::string refused_start(double half, double gap) {
  return message_of<InconsistentInitialConditions>([&] { SmallPendulum(half, gap).start(); });
}

TEST(AssemblyTolerance, IsRelativeToTheExtentOfASmallMechanism) {
  std::string const said = refused_start(1e-6, 5e-9);
  EXPECT_TRUE(has(said, "joint \"pin\" by 5e-09 m, but the limit is 1e-14 m")) << said;
  EXPECT_TRUE(has(said, "times the extent 1e-06 m of its assembly")) << said;
  EXPECT_NO_THROW(SmallPendulum(1e-6, 0.5e-14).start());
}
TEST(AssemblyTolerance, IsAbsoluteFromOneMetreOn) {
  EXPECT_NO_THROW(SmallPendulum(1.0, 0.9e-8).start());
  EXPECT_TRUE(has(refused_start(1.0, 5e-8), "joint \"pin\" by 5e-08 (m or rad), but the limit is 1e-08."));
}
TEST(AssemblyTolerance, IsNoneOfAnExtentThatConsistsOfTheViolation) {
  EXPECT_NO_THROW(SmallPendulum(0.0, 5e-9).start());
}
TEST(AssemblyTolerance, IsNotBelowTheRoundOffOfPositions) {
  SmallPendulum far(1e-6, 0.0, 1000.0 / 3.0);
  EXPECT_NO_THROW(far.start());
}
TEST(AssemblyTolerance, IsReachedByAssemble) {
  SmallPendulum small(1e-6, 5e-9);
  assemble(small.model, small.x);
  EXPECT_LT(largest_violation(small.model, small.x).position, 1e-15);
  EXPECT_NO_THROW(small.start());
}

}  // namespace state_places_test
}  // namespace polybody
