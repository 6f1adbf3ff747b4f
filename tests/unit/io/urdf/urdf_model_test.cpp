// Models of URDF files: mass, inertia, kinematics and accelerations of three robots against DART 6.12, runs with joint
// coordinates, loops, limits, mimicry, and flexible links. tests/tools/dart/urdf_numbers.cpp writes the numbers of
// DART.
#include <polybody/urdf.hpp>

#include <gtest/gtest.h>

#include <fstream>
#include <numbers>
#include <sstream>

#include <polybody/forces/loads.hpp>
#include <polybody/forces/servo.hpp>
#include <polybody/integrators/generalised_alpha.hpp>
#include <polybody/run/accelerations.hpp>
#include <polybody/run/initial_conditions.hpp>
#include <polybody/run/joint_position.hpp>
#include <polybody/run/probe.hpp>
#include <polybody/run/simulate.hpp>

#include "support/held.hpp"
#include "support/refusal.hpp"

namespace polybody::urdf_model_test {

std::string const folder = POLYBODY_ROBOTS "/";

/// Numbers of DART for a robot: three vectors of 3 for the axes, in columns.
struct Numbers {
  struct Link {
    std::string name;
    Vec3 origin, velocity, angular_velocity, acceleration, angular_acceleration;
    Mat3 axes;
  };
  double mass = 0.0;
  Vec3 centre;
  std::map<std::string, UrdfMotion> motions;
  std::vector<Link> links;

  explicit Numbers(std::string const& robot) {
    std::ifstream in(folder + robot + ".dart");
    EXPECT_TRUE(in) << robot;
    auto const vector = [&] {
      Vec3 v;
      for (double& x : v) in >> x;
      return v;
    };
    for (std::string kind, name; in >> kind;) {
      if (kind == "mass") {
        in >> mass;
        centre = vector();
      } else if (kind == "joint") {
        double unused = 0.0;
        in >> name;
        in >> motions[name].position >> motions[name].rate >> unused;
      } else {
        Link& link = links.emplace_back();
        in >> link.name;
        link.origin = vector();
        for (int i = 0; i < 3; ++i) link.axes.col(i) = vector();
        for (Vec3* const v : {&link.velocity, &link.angular_velocity, &link.acceleration, &link.angular_acceleration})
          *v = vector();
      }
    }
  }
};

double relative(Vec3 const& value, Vec3 const& exact) { return (value - exact).norm() / std::max(1.0, exact.norm()); }

/// Compares all numbers of a robot in the state x.
template <class Robot>
void compare(Robot const& robot, State& x, Numbers const& dart, std::string const& formulation) {
  compute_accelerations(robot.model, x);
  double mass = 0.0, frames = 0.0, rates = 0.0, accelerations = 0.0, turning = 0.0;
  Vec3 moment = Vec3::Zero();
  for (Numbers::Link const& link : dart.links) {
    auto const& body = robot.body(link.name);
    Placement const at = robot.placement(x, link.name);
    frames = std::max({frames, relative(at.origin, link.origin), (at.axes - link.axes).norm()});
    Frame<double> const origin = frame(robot.model, x, robot.at({link.name})),
                        centre = frame(robot.model, x, body.centre());
    rates = std::max({rates, relative(origin.v, link.velocity), relative(origin.w, link.angular_velocity)});
    accelerations = std::max(accelerations, relative(acceleration(robot.model, x, body.centre()), link.acceleration));
    turning =
        std::max(turning, relative(angular_acceleration(robot.model, x, body.centre()), link.angular_acceleration));
    mass += body.body().mass();
    moment += body.body().mass() * centre.r;
  }
  std::string const what = robot.robot().name;
  auto const claim = [&](char const* of) {
    return Claim{"X6", what + ": " + of, By::independent, "DART 6.12", formulation};
  };
  held(claim("mass [kg]"), mass, dart.mass, 1e-12 * mass);
  held_within(claim("centre of mass [m]"), (moment / mass - dart.centre).norm(), 1e-12, {.scale = 1.0});
  held_within(claim("frames of links [m, 1]"), frames, 1e-12, {.scale = 1.0});
  held_within(claim("velocities [m/s, rad/s]"), rates, 1e-12, {.scale = 1.0});
  held_within(claim("accelerations, relative"), accelerations, 1e-10, {.scale = 1.0});
  held_within(claim("angular accelerations, relative"), turning, 1e-10, {.scale = 1.0});
}

UrdfOptions const on_ground{.root = UrdfRoot::fixed, .gravity = {0, 0, -9.81}};
UrdfOptions const in_the_air{.root = UrdfRoot::free, .gravity = {0, 0, -9.81}};

TEST(UrdfModel, ArmWithSixAxesAgreesWithDart) {
  Numbers const dart("six_axes");
  auto const robot = read_urdf<Constraint>(folder + "six_axes.urdf", on_ground);
  State x = robot.state(dart.motions);
  compare(robot, x, dart, "Constraint");
  // the tool has no mass: a frame of the last link
  Placement const tool = robot.placement(x, "tool"), last = robot.placement(x, "wrist_3");
  EXPECT_LT((tool.origin - (last.origin + last.axes * Vec3(0.02, 0, 0.08))).norm(), 1e-14);
  EXPECT_LT((tool.axes - last.axes * roll_pitch_yaw(0, 1.2, 0.4)).norm(), 1e-14);
  EXPECT_EQ(robot.body("tool").name, "wrist_3");
  System system(robot.model, with<Capabilities::motion>);
  system.evaluate(x.q, x.v, x.t);
  EXPECT_NEAR(joint_angle(system, robot.joint<Revolute>("elbow")), dart.motions.at("elbow").position, 1e-14);
  EXPECT_NEAR(joint_translation_rate(system, robot.joint<Prismatic>("reach")), dart.motions.at("reach").rate, 1e-14);
}

TEST(UrdfModel, QuadrupedAgreesWithDart) {
  Numbers dart("quadruped");
  auto const robot = read_urdf<Constraint>(folder + "quadruped.urdf", in_the_air);
  Numbers::Link const& trunk = dart.links.front();
  dart.motions["trunk"] = {
      .pose = {trunk.origin, trunk.axes}, .velocity = trunk.velocity, .angular_velocity = trunk.angular_velocity};
  State x = robot.state(dart.motions);
  compare(robot, x, dart, "Constraint");
}

// The loop is closed by the equations of the plane of motion, so that no constraint is redundant.
TEST(UrdfModel, ClosedFourBarAgreesWithDart) {
  using Closing = Joint<PointOnLine>;
  Numbers const dart("four_bar");
  auto robot = read_urdf<Constraint, Joints<Closing>>(folder + "four_bar.urdf", on_ground);
  robot.connect(Closing{PointOnLine{.axis = robot.direction("crank", {0, 0, 1})}}, {"coupler", {0.6, 0, 0}},
                {"rocker", {0.45, 0, 0}}, "loop");
  State x = robot.state(dart.motions);
  compare(robot, x, dart, "Constraint, loop by PointOnLine");
}

/// State after `end` seconds, with an error of the method that falls by four if the step is halved.
template <class Robot>
State after(Robot const& robot, State x, double end, double step) {
  simulate(robot.model, x, GeneralisedAlpha{}, {.end_time = end, .step = step}).run();
  return x;
}

// Both policies give one motion: they have the same equations of motion, and the same steps.
TEST(UrdfModel, JointCoordinatesGiveTheMotionOfConstraints) {
  Numbers const dart("six_axes");
  auto const rows = read_urdf<Constraint>(folder + "six_axes.urdf", on_ground);
  auto const joints = read_urdf<JointCoordinates>(folder + "six_axes.urdf", on_ground);
  State tree = joints.state(dart.motions);
  compare(joints, tree, dart, "JointCoordinates");
  double distance[2];
  for (int k = 0; k < 2; ++k) {
    double const step = 2e-3 / (k + 1);
    State const a = after(rows, rows.state(dart.motions), 0.1, step),
                b = after(joints, joints.state(dart.motions), 0.1, step);
    distance[k] = (rows.placement(a, "tool").origin - joints.placement(b, "tool").origin).norm();
  }
  EXPECT_LT(distance[0], 1e-4);
  EXPECT_LT(distance[1], distance[0] / 3.0);
}

// The crank drives a closed loop: the coupler meets the rocker after assembly, also with joint coordinates.
TEST(UrdfModel, AssemblyClosesTheLoop) {
  using Closing = Joint<PointOnLine>;
  Numbers const dart("four_bar");
  auto robot = read_urdf<JointCoordinates, Joints<Closing>>(folder + "four_bar.urdf", on_ground);
  robot.connect(Closing{PointOnLine{.axis = robot.direction("crank", {0, 0, 1})}}, {"coupler", {0.6, 0, 0}},
                {"rocker", {0.45, 0, 0}}, "loop");
  std::map<std::string, UrdfMotion> near = dart.motions;
  near["pin"].position += 0.2;
  near["pivot"].position -= 0.1;
  State x = robot.state(near);
  assemble(robot.model, x);
  Vec3 const a = position(robot.model, x, robot.at({"coupler", {0.6, 0, 0}})),
             b = position(robot.model, x, robot.at({"rocker", {0.45, 0, 0}}));
  EXPECT_LT((a - b).norm(), 1e-10);
}

/// Robot of two links on a slide or hinge, with `more` in its second joint.
UrdfRobot two_links(std::string const& kind, std::string const& more, std::string const& mass = "2") {
  return read_urdf_text(
      "<robot name='two'>\n<link name='base'/>\n<link name='arm'><inertial><origin xyz='0.4 0 0'/><mass value='" +
          mass +
          "'/><inertia ixx='0.1' ixy='0' ixz='0' iyy='0.2' iyz='0' izz='0.2'/></inertial></link>\n<joint name='j' "
          "type='" +
          kind + "'><parent link='base'/><child link='arm'/><axis xyz='0 1 0'/>" + more + "</joint></robot>",
      "two.urdf");
}

// A stop pushes back beyond a limit: I θ¨ = m g a cos θ − k (θ − u), also if u is beyond half a turn.
TEST(UrdfModel, StopsPushAtTheLimits) {
  UrdfOptions options = on_ground;
  options.stops = UrdfStops{.angle_stiffness = 1e3, .slide_stiffness = 1e4};
  for (double const upper : {0.3, 4.0}) {
    UrdfModel<Constraint> const robot(
        two_links("revolute", "<limit lower='-0.2' upper='" + number(upper) + "' effort='1' velocity='1'/>"), options);
    for (double const beyond : {-0.05, 0.05}) {
      double const angle = upper + beyond;
      State x = robot.state({{"j", {angle}}});
      compute_accelerations(robot.model, x);
      double const expected = (2.0 * 9.81 * 0.4 * std::cos(angle) - 1e3 * std::max(beyond, 0.0)) / (0.2 + 2.0 * 0.16);
      EXPECT_NEAR(angular_acceleration(robot.model, x, robot.body("arm").centre())[1], expected, 1e-10) << angle;
    }
  }
  UrdfModel<Constraint> const slide(two_links("prismatic", "<limit lower='-0.2' upper='0.1' effort='1' velocity='1'/>"),
                                    options);
  State x = slide.state({{"j", {-0.21}}});
  compute_accelerations(slide.model, x);
  EXPECT_NEAR(acceleration(slide.model, x, slide.body("arm").centre())[1], 0.01 * 1e4 / 2.0, 1e-10);
}

// Losses of a slide along a horizontal axis: m v̇ = −d v − F v/√(v² + v₀²).
TEST(UrdfModel, ServoHasTheLimitsOfItsJoint) {
  auto const robot = read_urdf<Constraint>(folder + "six_axes.urdf", {.root = UrdfRoot::fixed});
  Servo<> law{.target = {1.0}, .proportional_gain = 10.0, .derivative_gain = 1.0};
  Servo<> const elbow = robot.servo("elbow", law);
  EXPECT_EQ(elbow.most_force, 150.0);
  EXPECT_EQ(elbow.most_speed, 3.1);
  EXPECT_EQ(elbow.proportional_gain, 10.0);
  law.most_force = 20.0;
  EXPECT_EQ(robot.servo("elbow", law).most_force, 20.0);
  EXPECT_TRUE(has(refusal([&] { (void)robot.servo("mount", law); }),
                  "joint \"mount\": the joint has no element <limit> that bounds a servo."));
}

TEST(UrdfModel, DampingAndFrictionOpposeTheRate) {
  std::string const more = "<limit lower='-1' upper='1' effort='1' velocity='1'/><dynamics damping='5' friction='3'/>";
  UrdfOptions options = on_ground;
  for (bool const dry : {false, true}) {
    if (dry) options.slip_speeds = UrdfSlipSpeeds{.angle = 0.01, .slide = 4.0};
    UrdfModel<Constraint> const robot(two_links("prismatic", more), options);
    State x = robot.state({{"j", {0.1, 3.0}}});
    compute_accelerations(robot.model, x);
    double const expected = dry ? -(15.0 + 3.0 * 3.0 / 5.0) / 2.0 : -7.5;
    EXPECT_NEAR(acceleration(robot.model, x, robot.body("arm").centre())[1], expected, 1e-12);
  }
}

// Planar and floating joints at a given pose: a free body falls with g, and a horizontal plane carries the weight.
TEST(UrdfModel, PlanarAndFloatingJoints) {
  Placement const turned{Vec3(0.3, 0.0, -0.2), roll_pitch_yaw(0, 0.7, 0)};
  for (std::string const kind : {"planar", "floating"}) {
    UrdfModel<Constraint> const robot(two_links(kind, ""), {.root = UrdfRoot::fixed, .gravity = {0, -9.81, 0}});
    State x = robot.state({{"j", {.pose = turned}}});
    EXPECT_LT((robot.placement(x, "arm").origin - turned.origin).norm() +
                  (robot.placement(x, "arm").axes - turned.axes).norm(),
              1e-14)
        << kind;
    compute_accelerations(robot.model, x);
    EXPECT_NEAR(acceleration(robot.model, x, robot.body("arm").centre())[1], kind == "planar" ? 0.0 : -9.81, 1e-12)
        << kind;
  }
  UrdfModel<Constraint> const plane(two_links("planar", ""), on_ground);
  EXPECT_TRUE(has(
      refusal([&] { (void)plane.state({{"j", {.pose = Placement::at({0, 0.1, 0})}}}); }),
      "two.urdf, line 4, joint \"j\": the motion of a planar joint must lie in its plane to 1e-9, but is off by 0.1"));
}

std::string gripper(std::string const& mimic, std::string const& kind = "revolute") {
  std::string text = "<robot name='gripper'><link name='palm'/>";
  for (std::string const finger : {"left", "right"})
    text += "<link name='" + finger +
            "'><inertial><origin xyz='0.1 0 0'/><mass value='0.2'/><inertia ixx='1e-4' ixy='0' ixz='0' iyy='2e-4' "
            "iyz='0' izz='2e-4'/></inertial></link>"
            "<joint name='" +
            finger + "' type='" + kind + "'><parent link='palm'/><child link='" + finger + "'/><origin xyz='0 " +
            (finger == "left" ? "0.05 0.01" : "-0.05 0") +
            "'/><axis xyz='0 0 1'/><limit lower='-1' upper='1' effort='1' velocity='1'/>" +
            (finger == "right" ? mimic : "") + "</joint>";
  return text + "</robot>";
}

// Two fingers whose angles have the ratio −3/2: with the moment M on the first finger, (J + n² J) θ¨ = M, n = 3/2.
TEST(UrdfModel, MimicIsAGear) {
  using Torque = PointMoment<>;
  UrdfRobot const robot = read_urdf_text(gripper("<mimic joint='left' multiplier='-1.5'/>"), "gripper.urdf");
  UrdfModel<Constraint, Joints<>, Forces<Torque>> grip(robot, {.root = UrdfRoot::fixed});
  grip.model.apply(Torque{.moment = {0, 0, 0.1}}, grip.body("left").centre(), "motor");
  State x = grip.state({{"left", {0.4}}});
  EXPECT_LT((grip.placement(x, "right").axes - roll_pitch_yaw(0, 0, -0.6)).norm(), 1e-14);
  require_assembled(*std::make_unique<System>(grip.model, with<Capabilities::motion>), x);
  compute_accelerations(grip.model, x);
  double const inertia = 2e-4 + 0.2 * 0.01, expected = 0.1 / (inertia * (1.0 + 2.25));
  EXPECT_NEAR(angular_acceleration(grip.model, x, grip.body("left").centre())[2], expected, 1e-9 * expected);
  EXPECT_NEAR(angular_acceleration(grip.model, x, grip.body("right").centre())[2], -1.5 * expected, 1e-9 * expected);
}

TEST(UrdfModel, RefusesMimicsThatNoGearRepresents) {
  auto const refused = [](std::string const& mimic, std::string const& kind = "revolute") {
    return refusal([&] {
      (void)UrdfModel<Constraint>(read_urdf_text(gripper(mimic, kind), "gripper.urdf"), {.root = UrdfRoot::fixed});
    });
  };
  EXPECT_TRUE(has(refused("<mimic joint='left' multiplier='-1'/>", "prismatic"),
                  "gripper.urdf, line 1, joint \"right\": its <mimic> of the joint \"left\" is not supported, because "
                  "a gear needs two revolute joints"));
  EXPECT_TRUE(has(refused("<mimic joint='left' multiplier='-1' offset='0.1'/>"), "the offset is 0.1 rad"));
  EXPECT_TRUE(has(refused("<mimic joint='left' multiplier='1'/>"), "both joints turn equally"));
  EXPECT_TRUE(has(refused("<mimic joint='left' multiplier='-3.14159265'/>"), "is not a ratio of integers"));
  UrdfOptions options{.root = UrdfRoot::fixed};
  options.free_mimics = true;
  UrdfModel<Constraint> const loose(
      read_urdf_text(gripper("<mimic joint='left' multiplier='2' offset='0.3'/>"), "gripper.urdf"), options);
  // the reference has all joints at zero; a state without motions follows the mimic
  EXPECT_LT((loose.placement(loose.model.reference_state(), "right").axes - identity()).norm(), 1e-15);
  EXPECT_LT((loose.placement(loose.state(), "right").axes - roll_pitch_yaw(0, 0, 0.3)).norm(), 1e-15);
  State const x = loose.state({{"left", {0.1}}});
  EXPECT_NEAR(joint_angle(loose.model, x, loose.joint<Revolute>("right")), 0.5, 1e-15);
}

TEST(UrdfModel, RefusesWithFileLineAndElement) {
  auto const model = [](UrdfRobot const& robot, UrdfRoot root = UrdfRoot::fixed) {
    return UrdfModel<Constraint>(robot, {.root = root});
  };
  EXPECT_TRUE(has(refusal([&] {
                    (void)model(
                        read_urdf_text("<robot name='r'>\n<link name='a'/>\n<link name='b'/>\n<joint name='j' "
                                       "type='continuous'><parent link='a'/><child link='b'/></joint></robot>",
                                       "x.urdf"));
                  }),
                  "x.urdf, line 3, link \"b\": the link moves, but has no mass"));
  EXPECT_TRUE(has(refusal([&] { (void)model(two_links("continuous", ""), UrdfRoot::free); }),
                  "two.urdf, line 2, link \"base\": the link moves, but has no mass"));
  auto const robot = model(two_links("continuous", ""));
  EXPECT_TRUE(
      has(refusal([&] { (void)robot.state({{"k", {}}}); }), "two.urdf: there is no joint \"k\". The joints are j."));
  EXPECT_TRUE(
      has(refusal([&] { (void)robot.body("hand"); }), "two.urdf: there is no link \"hand\". The links are base, arm."));
  EXPECT_TRUE(has(refusal([&] { (void)robot.body("base"); }),
                  "two.urdf, line 2, link \"base\": the link belongs to the ground."));
  EXPECT_TRUE(has(refusal([&] { (void)robot.joint<Prismatic>("j"); }), "joint \"j\": the joint is not a Prismatic."));
  EXPECT_TRUE(has(refusal([&] { (void)robot.state({{"j", {.rate = 1e12}}}); }),
                  "must lie in [-1e+09, 1e+09], but one is 1e+12"));
}

}  // namespace polybody::urdf_model_test
