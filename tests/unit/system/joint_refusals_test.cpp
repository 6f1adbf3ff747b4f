// Messages of `connect` for invalid joints: a message names the joint, and the model stays unchanged. A cycle in a
// tree of joint coordinates is detected at the start of a run: recursive_loop_test.cpp.
#include <gtest/gtest.h>

#include <polybody/bodies/rigid/rigid.hpp>
#include <polybody/joints/driving_constraints.hpp>
#include <polybody/joints/policies/bushing.hpp>
#include <polybody/joints/policies/penalty.hpp>
#include <polybody/joints/policies/policy.hpp>
#include <polybody/joints/standard_joints.hpp>
#include <polybody/math/smooth_table.hpp>
#include <polybody/system/model.hpp>

#include "support/refusal.hpp"

namespace polybody {
namespace joint_refusals_test {

template <class L>
using Six = NonlinearBushing<L, L, L, L, L, L>;
using Mount = Joint<Revolute, Bushing>;
using Rubber = Joint<Revolute, Six<LinearLaw>>;
using Stiff = Joint<Revolute, Penalty>;
using Turn = Joint<PrescribedAngle<Window>, Constraint>;
using Push = Joint<PrescribedTranslation<Window>, Constraint>;
using Ram = Joint<PrescribedDistance<Window>, Constraint>;

struct Refused {
  Model<Bodies<Rigid<>>, Joints<Mount, Rubber, Stiff, Turn, Push, Ram>> model;
  BodyHandle<Rigid<>> body = model.add(Rigid<>(1.0, Mat3::Identity(), Placement::at({1, 0, 0})));

  template <class J>
  std::string operator()(J const& joint) {
    std::string const said =
        refusal([&] { model.connect(joint, model.ground().at({0, 0, 0}), body.at({0, 0, 0}), "elbow"); });
    EXPECT_EQ(model.rows() + model.markers(), 0);
    return said;
  }
};

TEST(RefusedJoint, HasANegativeStiffness) {
  Bushing::Matrix const good = Bushing::diagonal({1, 1, 1}, {1, 1, 0}), bad = Bushing::diagonal({1, -2, 1}, {1, 1, 0});
  Refused refused;
  EXPECT_TRUE(
      has(refused(Mount{{}, {.stiffness = bad, .damping = good}}),
          "\"elbow\": the bushing's stiffness must be finite, symmetric and positive semidefinite (6×6), but its entry "
          "(2, 2) is -2."));
  EXPECT_TRUE(has(refused(Mount{{}, {.stiffness = good, .damping = bad}}), "\"elbow\": the bushing's damping"));
  LinearLaw const law{.stiffness = 1.0, .damping = 0.0}, negative{.stiffness = -1.0, .damping = 0.0};
  EXPECT_TRUE(has(refused(Rubber{{}, {law, law, negative, law, law, law}}),
                  "\"elbow\": component 3 of the bushing: the stiffness"));
  EXPECT_TRUE(has(refused(Stiff{{}, {.stiffness = -1.0, .damping = 0.0}}),
                  "\"elbow\": the penalty stiffness must be positive"));
}

TEST(RefusedJoint, IsDrivenThroughAJump) {
  Window const window{.from = 1.0, .to = 2.0, .value = 0.5};
  std::string const why = "\"elbow\": the time function: the value jumps from 0 to 0.5 at t = 1 s";
  Refused refused;
  EXPECT_TRUE(has(refused(Turn{{.law = window}, {}}), why));
  EXPECT_TRUE(has(refused(Push{{.law = window}, {}}), why));
  EXPECT_TRUE(has(refused(Ram{{.law = window, .length = 1.0}, {}}), why));
}

// A table is constructed before the joint; its last argument names the joint.
TEST(RefusedJoint, HasATableThatGoesBack) {
  EXPECT_TRUE(
      has(refusal([] { (void)TabulatedLaw{MonotoneTable({{0.0, 0.0}, {0.2, 1.0}, {0.1, 2.0}}, "\"elbow\""), 0.0}; }),
          "\"elbow\": the abscissae of the table must increase, but point 3 has x = 0.1 after x = 0.2"));
  EXPECT_TRUE(has(refusal([] { (void)SmoothTable({{0.0, 0.0}, {0.2, 1.0}, {0.2, 2.0}}, {}, "\"elbow\""); }),
                  "\"elbow\": the times must increase, but point 3 at t = 0.2 s follows a point at 0.2 s."));
}

template <class G>
using Ideal = Joint<G, Constraint>;
using Motor = PrescribedAngle<Ramp>;
using Ramming = PrescribedTranslation<Ramp>;
Ramp const ramp{.target = 1.0, .duration = 1.0};

/// A rigid body, the ground, and joints between them.
template <class B, class... Gs>
struct Joined {
  using Place = std::conditional_t<B::world == World::plane, Vec2, Vec3>;
  Model<Bodies<B>, Joints<Ideal<Gs>...>> model;
  BodyHandle<B> body;
  explicit Joined(B const& b) : body(model.add(b, "body")) {}
  /// The message of `connect`; empty if it accepts the joint.
  template <class G>
  std::string operator()(G const& geometry, std::string const& name) {
    Index const before = model.rows() + model.markers();
    std::string said;
    try {
      model.connect(Ideal<G>{geometry, {}}, model.ground().at({0, 0, 0}), body.at(Place(Place::Zero())), name);
    } catch (InvalidInput const& error) {
      said = error.what();
    }
    if (!said.empty()) {
      EXPECT_EQ(model.rows() + model.markers(), before);
    }
    return said;
  }
};

TEST(RefusedJoint, LeavesItsAxisOut) {
  Joined<Rigid<>, Revolute, Cylindrical, Prismatic, Screw, PointOnLine, PointInPlane, PlanarJoint, ParallelAxes,
         Universal, RelativeCoordinates, Gear, RackAndPinion, RollingDisc, KnifeEdge, Motor, Ramming>
      space(Rigid<>(1.0, Mat3::Identity()));
  std::string const hint =
      "is missing. Give a unit vector in world axes at the reference "
      "configuration, such as {0, 0, 1}.";
  EXPECT_EQ(space(Revolute{}, "pin"), "\"pin\": Revolute: the axis " + hint);
  EXPECT_EQ(space(Motor{.law = ramp}, "drive"), "\"drive\": PrescribedAngle: the axis " + hint);
  EXPECT_EQ(space(Ramming{.law = ramp}, "ram"), "\"ram\": PrescribedTranslation: the axis " + hint);
  EXPECT_EQ(space(PointInPlane{}, "foot"), "\"foot\": PointInPlane: the normal " + hint);
  EXPECT_EQ(space(Universal{.first = {1, 0, 0}}, "cross"), "\"cross\": Universal: the second axis " + hint);
  Gear const gear{.teeth_a = 1, .teeth_b = 1, .axis = {0, 0, 1}};
  EXPECT_EQ(space(gear, "pair"), "\"pair\": Gear: the line of centres " + hint);
  EXPECT_EQ(space(RackAndPinion{.radius = 1.0, .axis = {0, 0, 1}}, "rack"),
            "\"rack\": RackAndPinion: the direction " + hint);
  EXPECT_EQ(space(RollingDisc{.radius = 1.0, .normal = {0, 0, 1}}, "wheel"),
            "\"wheel\": RollingDisc: the axis " + hint);
  EXPECT_EQ(space(RollingDisc{.radius = 1.0, .axis = {0, 1, 0}}, "wheel"),
            "\"wheel\": RollingDisc: the normal " + hint);
  EXPECT_EQ(space(KnifeEdge{}, "blade"), "\"blade\": KnifeEdge: the direction across " + hint);
  for (std::string const& said :
       {space(Cylindrical{}, "it"), space(Prismatic{}, "it"), space(Screw{.pitch = 0.1}, "it"),
        space(PointOnLine{}, "it"), space(PlanarJoint{}, "it"), space(ParallelAxes{}, "it"),
        space(RelativeCoordinates{}, "it"), space(Gear{.teeth_a = 1, .teeth_b = 1}, "it")})
    EXPECT_TRUE(has(said, hint)) << said;
}

// In the plane a rotation is about the normal. A direction within the plane is required.
TEST(RefusedJoint, NeedsNoAxisOfATurnInThePlane) {
  Joined<planar::Rigid, Motor, RelativeCoordinates, Ramming, PointInPlane> plane(planar::Rigid(1.0, 1.0));
  EXPECT_EQ(plane(Motor{.law = ramp}, "drive"), "");
  EXPECT_EQ(plane(RelativeCoordinates{}, "mount"), "");
  EXPECT_TRUE(has(plane(Ramming{.law = ramp}, "ram"), "PrescribedTranslation: the axis is missing"));
  EXPECT_TRUE(has(plane(PointInPlane{}, "foot"), "PointInPlane: the normal is missing"));
}

TEST(RefusedJoint, DrivesATurnThatItsPinDoesNotLeave) {
  using Space = Joined<Rigid<>, Revolute, Spherical, Motor>;
  std::string const why =
      "\"drive\" drives a rotation about (0, 0, 1), but \"pin\" allows only a rotation about (0, 1, 0) between these "
      "bodies (world axes in the reference configuration). Use the same axis for both.";
  Revolute const pin{.axis = {0, 1, 0}};
  Motor const across{.law = ramp, .axis = {0, 0, 1}}, along{.law = ramp, .axis = {0, -1, 0}};
  Space pin_first(Rigid<>(1.0, Mat3::Identity())), drive_first = pin_first, ball = pin_first;
  EXPECT_EQ(pin_first(pin, "pin"), "");
  EXPECT_EQ(pin_first(across, "drive"), why);
  EXPECT_EQ(pin_first(along, "drive"), "");
  EXPECT_EQ(drive_first(across, "drive"), "");
  EXPECT_EQ(drive_first(pin, "pin"), why);
  EXPECT_EQ(ball(Spherical{}, "ball"), "");
  EXPECT_EQ(ball(across, "drive"), "");
}

}  // namespace joint_refusals_test
}  // namespace polybody
