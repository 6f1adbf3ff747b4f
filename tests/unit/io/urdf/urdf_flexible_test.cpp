// Flexible bodies in place of links of a URDF file.
#include <polybody/bodies/ffr/ffr.hpp>
#include <polybody/urdf.hpp>

#include <gtest/gtest.h>

#include <polybody/statics/equilibrium.hpp>

#include "support/refusal.hpp"

namespace polybody::urdf_flexible_test {

double const length = 0.8;

UrdfRobot arm(std::string const& kind) {
  std::string const inertial =
      "<inertial><origin xyz='0.1 0 0'/><mass value='0.5'/><inertia ixx='1e-3' ixy='0' ixz='0' iyy='1e-3' iyz='0' "
      "izz='1e-3'/></inertial>";
  return read_urdf_text(
      "<robot name='arm'><link name='base'/><link name='boom'>" + inertial + "</link><link name='load'>" + inertial +
          "</link><joint name='root' type='" + kind +
          "'><parent link='base'/><child link='boom'/><origin xyz='0 0 1' rpy='0 0 0.6'/><axis xyz='0 1 0'/></joint>"
          "<joint name='end' type='fixed'><parent link='boom'/><child link='load'/><origin xyz='0.8 0 "
          "0'/></joint></robot>",
      "arm.urdf");
}

/// Bar along the x axis of the link.
UrdfFlexibleLink<Ffr> const boom{
    .link = "boom",
    .body =
        [](Placement const& frame) {
          return Ffr::from(
              {.length = length,
               .constants =
                   BarConstants{.EA = 1e6, .EI = 200.0, .mass_per_length = 1.5, .GJ = 150.0, .rotary_inertia = 1e-5},
               .placement = frame},
              4);
        },
    .at = [](BodyHandle<Ffr> const& handle, Vec3 const& point) { return handle.at(point.x()); }};

// Cantilever under its weight q per length and the load F with its moment arm e at the tip, small deflections:
//   w = q l⁴/(8 EI) + F l³/(3 EI) + F e l²/(2 EI)  [Timoshenko & Goodier 1970].
TEST(UrdfFlexible, BoomBendsUnderItsWeightAndItsLoad) {
  double const g = 9.81e-3, q = 1.5 * g, force = 0.5 * g, stiffness = 200.0;  // a small gravity: small deflections
  UrdfModel<Constraint, Joints<>, Forces<>, Ffr> const robot(arm("fixed"),
                                                             {.root = UrdfRoot::fixed, .gravity = {0, 0, -g}}, boom);
  State x = robot.state();
  equilibrium(robot.model, x);
  double const l2 = length * length,
               expected = (q * l2 * l2 / 8 + force * l2 * length / 3 + force * 0.1 * l2 / 2) / stiffness;
  EXPECT_NEAR(1.0 - robot.placement(x, "load").origin.z(), expected, 1e-3 * expected);
  EXPECT_LT(
      (robot.placement(robot.state(), "load").origin - Vec3(0.8 * std::cos(0.6), 0.8 * std::sin(0.6), 1.0)).norm(),
      1e-12);
}

TEST(UrdfFlexible, StaysInItsReferenceConfiguration) {
  UrdfModel<JointCoordinates, Joints<>, Forces<>, Ffr> const robot(arm("continuous"), {.root = UrdfRoot::fixed}, boom);
  EXPECT_NO_THROW((void)robot.state({{"root", {.rate = 2.0}}}));
  EXPECT_TRUE(
      has(refusal([&] { (void)robot.state({{"root", {0.1}}}); }),
          "arm.urdf, line 1, link \"boom\": a flexible link has positions in the reference configuration only"));
  EXPECT_TRUE(has(refusal([&] { (void)robot.body("boom"); }), "the body of the link has another type"));
  EXPECT_EQ(robot.body<Ffr>("boom").name, "boom");
  UrdfFlexibleLink<Ffr> other = boom;
  other.link = "mast";
  EXPECT_TRUE(has(refusal([&] {
                    (void)UrdfModel<Constraint, Joints<>, Forces<>, Ffr>(arm("fixed"), {.root = UrdfRoot::fixed},
                                                                         other);
                  }),
                  "there is no link \"mast\""));
}

}  // namespace polybody::urdf_flexible_test
