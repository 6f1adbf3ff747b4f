// URDF files. An accepted robot is a tree with parents before children, finite frames and possible inertias. A message
// of a refusal begins with the name of the file.
// with: -lurdfdom_model
// with: -lconsole_bridge
#include <polybody/io/urdf_file.hpp>
#include <polybody/io/urdf_kinematics.hpp>

#include "fuzz/target.hpp"

/// liburdfdom does not free the links of robots without a root, because they refer to each other.
extern "C" char const* __lsan_default_suppressions() { return "leak:liburdfdom"; }

namespace polybody::fuzz {

void check(UrdfRobot const& robot) {
  require(!robot.links.empty() && robot.joints.size() + 1 == robot.links.size(), "links and joints form a tree");
  for (std::size_t i = 0; i < robot.links.size(); ++i) {
    UrdfLink const& link = robot.links[i];
    require((link.joint < 0) == (i == 0), "only the root has no joint");
    if (link.inertia) (void)Rigid<>(link.inertia->body(link.frame));
    if (i == 0) continue;
    UrdfJoint const& joint = robot.joints[std::size_t(link.joint)];
    require(joint.child == Index(i) && joint.parent < joint.child, "parents come before children");
    require(std::abs(joint.axis.norm() - 1.0) < 1e-12, "axes are unit vectors: ", joint.axis.norm());
    require(joint.damping >= 0.0 && joint.friction >= 0.0, "losses are not negative");
    if (joint.mimic)
      require(joint.mimic->joint >= 0 && joint.mimic->joint < Index(robot.joints.size()), "mimics exist");
  }
  std::vector<bool> is_body;
  for (UrdfLink const& link : robot.links) is_body.push_back(link.inertia.has_value());
  for (UrdfRoot const root : {UrdfRoot::fixed, UrdfRoot::free})
    if (auto const hosts = accepted([&] { return detail::urdf_bodies(robot, is_body, root); },
                                    [&](std::string const& message) { return message.starts_with(robot.file); }))
      for (Index const host : *hosts) require(host == -1 || is_body[std::size_t(host)], "links belong to bodies");
  for (detail::UrdfPose const& pose : detail::urdf_poses(robot, {}, {})) pose.frame.check("pose");
}

}  // namespace polybody::fuzz

extern "C" int LLVMFuzzerTestOneInput(std::uint8_t const* data, std::size_t size) {
  using namespace polybody;
  using namespace polybody::fuzz;
  auto const robot = accepted([&] { return read_urdf_text(std::string(text_of(data, size)), "robot.urdf"); },
                              [](std::string const& message) { return message.starts_with("robot.urdf"); });
  if (robot) check(*robot);
  return 0;
}
