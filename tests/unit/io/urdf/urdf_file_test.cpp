// Reader of URDF files: content, and refusals with file, line and element.
#include <polybody/io/urdf_file.hpp>

#include <gtest/gtest.h>

#include "support/refusal.hpp"

namespace polybody::urdf_file_test {

std::string const folder = POLYBODY_ROBOTS "/";

/// Robot with one moving link; `inertial` and `joint` are parts of its elements.
std::string text_of(std::string const& inertial, std::string const& joint, std::string const& kind = "revolute") {
  return "<robot name='r'>\n<link name='a'/>\n<link name='b'>" + inertial + "</link>\n<joint name='j' type='" + kind +
         "'><parent link='a'/><child link='b'/>" + joint + "</joint>\n</robot>\n";
}
std::string const body =
    "<inertial><mass value='2'/><inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' izz='1'/></inertial>";
std::string const limit = "<limit lower='-1' upper='2' effort='3' velocity='4'/>";

// Parents come before children; masses, limits, damping and lines are those of the file.
TEST(UrdfFile, ContentOfAFile) {
  UrdfRobot const robot = read_urdf_robot(folder + "six_axes.urdf");
  EXPECT_EQ(robot.name, "six_axes");
  ASSERT_EQ(robot.links.size(), 9u);
  ASSERT_EQ(robot.joints.size(), 8u);
  EXPECT_EQ(robot.links[0].name, "world");
  for (UrdfJoint const& j : robot.joints) EXPECT_LT(j.parent, j.child);
  UrdfLink const& forearm = robot.links[std::size_t(robot.link("forearm"))];
  EXPECT_EQ(forearm.line, 26);
  EXPECT_EQ(forearm.inertia->mass, 4.2);
  EXPECT_EQ(Vec3(forearm.inertia->centre), Vec3(0.21, -0.015, 0.02));
  EXPECT_FALSE(robot.links[std::size_t(robot.link("tool"))].inertia);
  UrdfJoint const& elbow = robot.joints[std::size_t(robot.joint("elbow"))];
  EXPECT_EQ(elbow.kind, UrdfJoint::Kind::revolute);
  EXPECT_EQ(elbow.limit->lower, -2.8);
  EXPECT_EQ(elbow.limit->effort, 150.0);
  EXPECT_EQ(elbow.damping, 0.4);
  EXPECT_EQ(elbow.friction, 0.8);
  EXPECT_LT((elbow.axis - Vec3(0.1, 2, 0.05).normalized()).norm(), 1e-15);
}

// R I Rᵀ with roll, pitch, yaw about fixed axes  [case 6 (b)].
TEST(UrdfFile, InertiaIsTurnedToTheAxesOfTheLink) {
  UrdfRobot const robot = read_urdf_text(
      text_of("<inertial><origin xyz='0.05 -0.12 0.20' rpy='0.3 -0.4 0.5'/><mass value='2.5'/><inertia ixx='0.10' "
              "ixy='0.01' ixz='-0.02' iyy='0.16' iyz='0.015' izz='0.21'/></inertial>",
              limit),
      "x.urdf");
  Mat3 expected;
  expected << 0.12254332, -0.00330207, -0.04791194, -0.00330207, 0.16224339, -0.02113456, -0.04791194, -0.02113456,
      0.18521329;
  EXPECT_LT((robot.links[1].inertia->tensor - expected).cwiseAbs().maxCoeff(), 1e-8);
  EXPECT_NEAR(robot.links[1].inertia->about({0, 0, 0})(0, 0), 0.25854332, 1e-8);
}

TEST(UrdfFile, RefusesInertiasThatNoMassHas) {
  std::string const flat =
      "<inertial><mass value='2'/><inertia ixx='1' ixy='0' ixz='0' iyy='2' iyz='0' izz='4'/></inertial>";
  EXPECT_TRUE(has(
      refusal([&] { (void)read_urdf_text(text_of(flat, limit), "x.urdf"); }),
      "x.urdf, line 3, link \"b\": the principal moments of inertia 4, 2, 1 kg m² violate the triangle inequality"));
}

std::string refused(std::string const& text) {
  return message_of<IoError>([&] { (void)read_urdf_text(text, "x.urdf"); });
}

TEST(UrdfFile, RefusesNumbersOutsideTheirRange) {
  auto const inertial = [](std::string const& mass, std::string const& ixx) {
    return "<inertial><mass value='" + mass + "'/><inertia ixx='" + ixx +
           "' ixy='0' ixz='0' iyy='1' iyz='0' izz='1'/></inertial>";
  };
  EXPECT_TRUE(has(refused(text_of(inertial("-1", "1"), limit)),
                  "x.urdf, line 3, link \"b\": <mass> [kg] must lie in [0, 1e+30], but is -1."));
  EXPECT_TRUE(has(refused(text_of(inertial("0", "1"), limit)),
                  "the link has the mass 0 kg, but an inertia tensor that is not zero"));
  EXPECT_TRUE(has(refused(text_of(inertial("1", "1e40"), limit)),
                  "an entry of <inertia> [kg m²] must lie in [-1e+30, 1e+30], but is 1e+40"));
  EXPECT_TRUE(has(refused(text_of(body, "<limit lower='2' upper='1' effort='1' velocity='1'/>")),
                  "x.urdf, line 4, joint \"j\": the lower <limit> must not exceed the upper one, 1, but is 2."));
  EXPECT_TRUE(has(refused(text_of(body, limit + "<dynamics damping='-1'/>")),
                  "the damping of <dynamics> must lie in [0, 1e+30], but is -1"));
  EXPECT_TRUE(has(refused(text_of(body, limit + "<dynamics damping='0' friction='-2'/>")),
                  "the friction of <dynamics> must lie in"));
  EXPECT_TRUE(
      has(refused(text_of(body, limit + "<axis xyz='0 0 0'/>")), "x.urdf, line 4, joint \"j\": the <axis> is zero"));
  EXPECT_TRUE(has(refused(text_of(body, limit + "<origin xyz='1e10 0 0'/>")),
                  "a coordinate of xyz in <origin> [m] must lie in"));
  EXPECT_TRUE(has(refused(text_of(body, limit + "<mimic joint='j'/>")),
                  "<mimic> names the joint \"j\", but needs another joint of the robot"));
}

TEST(UrdfFile, RefusesLoopsAndSyntax) {
  std::string const second = "<joint name='k' type='fixed'><parent link='a'/><child link='b'/></joint></robot>";
  std::string tree = text_of(body, limit);
  tree.resize(tree.find("</robot>"));
  EXPECT_TRUE(has(refused(tree + second), "the joints \"j\" and \"k\" both carry the link \"b\""));
  EXPECT_TRUE(has(
      refused(tree +
              "<link name='c'/><link name='d'/><joint name='k' type='fixed'><parent link='c'/><child link='d'/></joint>"
              "<joint name='l' type='fixed'><parent link='d'/><child link='c'/></joint></robot>"),
      "the joints connect only 2 of 4 links to the root \"a\""));
  EXPECT_TRUE(has(refused(tree), "x.urdf, line 5: the file ends within an element"));
  EXPECT_TRUE(has(refused("<robot name='r'>\n<link name=b/></robot>"),
                  "line 2: the value of the attribute name has no quotes"));
  EXPECT_TRUE(has(refused("<robot>\n\xff"), "line 2: the byte 255 does not belong to a text in UTF-8"));
  EXPECT_TRUE(has(refused(""), "the file has no element <robot>"));
  EXPECT_TRUE(has(refused(text_of(body, "")), "this is not a valid URDF file. liburdfdom reports: "));  // no limit
  EXPECT_TRUE(has(refused(text_of(body, limit, "bent")), "liburdfdom reports: "));
  std::string deep = "<robot name='r'>";
  for (int i = 0; i < 70; ++i) deep += "<a>";
  EXPECT_TRUE(has(refused(deep), "elements are nested deeper than 64 levels"));
  EXPECT_TRUE(has(message_of<IoError>([] { (void)read_urdf_robot("missing.urdf"); }),
                  "missing.urdf: the file cannot be opened"));
}

}  // namespace polybody::urdf_file_test
