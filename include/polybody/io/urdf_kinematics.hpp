#pragma once
/// \file
/// Bodies of a robot, and the positions and velocities of its links for given motions of the joints.

#include <map>
#include <vector>

#include <polybody/io/urdf_robot.hpp>

namespace polybody {

/// Attachment of the root link.
enum class UrdfRoot {
  fixed,  ///< the root is welded to the ground; a root without mass is the ground
  free    ///< the root moves freely
};

namespace detail {

/// Position and velocity of a link in world axes.
struct UrdfPose {
  Placement frame = {};          ///< frame of the link
  Vec3 velocity = Vec3::Zero();  ///< (3) velocity of the origin [m/s]
  Vec3 rotation = Vec3::Zero();  ///< (3) angular velocity [rad/s]
};

/// Body of each link: the index of the link whose body carries it, or −1 for the ground. A link with mass (`is_body`)
/// has its own body. A link without mass belongs to the nearest link with mass that fixed joints connect to it: the
/// nearest ancestor, or else the first descendant.
/// \throws InvalidInput for a link without mass that moves and is not fixed to a link with mass.
template <class = void>  // compiled only if used
std::vector<Index> urdf_bodies(UrdfRobot const& robot, std::vector<bool> const& is_body, UrdfRoot root) {
  constexpr Index none = -2;
  std::size_t const n = robot.links.size();
  std::vector<Index> out(n, none);
  auto const fixed_parent = [&](std::size_t i) -> Index {
    Index const j = robot.links[i].joint;
    return j >= 0 && robot.joints[std::size_t(j)].kind == UrdfJoint::Kind::fixed ? robot.joints[std::size_t(j)].parent
                                                                                 : none;
  };
  auto const inherit = [&] {
    for (std::size_t i = 0; i < n; ++i)
      if (Index const p = fixed_parent(i); out[i] == none && p != none) out[i] = out[std::size_t(p)];
  };
  for (std::size_t i = 0; i < n; ++i)
    if (is_body[i]) out[i] = Index(i);
  if (!is_body[0] && root == UrdfRoot::fixed) out[0] = -1;
  inherit();
  std::vector<Index> const before = out;
  for (std::size_t i = n; i-- > 1;)  // the first child is the last one to write
    if (Index const p = fixed_parent(i); p != none && before[std::size_t(p)] == none && out[i] != none)
      out[std::size_t(p)] = out[i];
  inherit();
  for (std::size_t i = 0; i < n; ++i)
    if (out[i] == none)
      throw InvalidInput("urdf.no_mass",
                         {ErrorObject{robot.where(robot.links[i])},
                          ": the link moves, but has no mass, and no fixed joint connects it to a link "
                          "with mass. Give it an <inertial> element with a positive <mass>, or, for the "
                          "root, use UrdfRoot::fixed."});
  return out;
}

/// Motion of joint j, given by its name or by the joint that it mimics; nullptr for a joint at rest at zero.
template <class = void>  // compiled only if used
UrdfMotion urdf_motion(UrdfRobot const& robot, UrdfJoint const& joint, std::map<std::string, UrdfMotion> const& given) {
  UrdfJoint const* j = &joint;
  double factor = 1.0, offset = 0.0;
  for (std::size_t k = 0; k <= robot.joints.size(); ++k) {  // mimicry can be a chain, and by mistake a ring
    if (auto const at = given.find(j->name); at != given.end()) {
      UrdfMotion out = at->second;
      out.position = factor * out.position + offset;
      out.rate *= factor;
      return out;
    }
    if (!j->mimic) break;
    offset += factor * j->mimic->offset;
    factor *= j->mimic->multiplier;
    j = &robot.joints[std::size_t(j->mimic->joint)];
  }
  return {.position = offset};
}

/// Requires that a planar joint stays in its plane. \throws InvalidInput otherwise.
template <class = void>  // compiled only if used
void require_urdf_plane(UrdfRobot const& robot, UrdfJoint const& j, UrdfMotion const& m) {
  double const off = std::max({std::abs(j.axis.dot(m.pose.origin)), (m.pose.axes * j.axis - j.axis).norm(),
                               std::abs(j.axis.dot(m.velocity)), m.angular_velocity.cross(j.axis).norm()});
  if (off > 1e-9)
    throw InvalidInput("urdf.motion", {ErrorObject{robot.where(j)},
                                       ": the motion of a planar joint must lie in its plane to 1e-9, but is off by ",
                                       ErrorValue{off}, "."});
}

/// Pose of the child of joint j, from the pose of its parent link.
template <class = void>  // compiled only if used
UrdfPose urdf_child(UrdfRobot const& robot, UrdfJoint const& j, UrdfPose const& parent, UrdfMotion const& m) {
  using Kind = UrdfJoint::Kind;
  Mat3 const axes = parent.frame.axes * j.origin.axes;
  Vec3 const w = parent.rotation, arm = parent.frame.axes * j.origin.origin;
  UrdfPose out{{parent.frame.origin + arm, axes}, parent.velocity + w.cross(arm), w};
  auto const translate = [&](Vec3 const& d, Vec3 const& rate) {
    out.frame.origin += axes * d;
    out.velocity += w.cross(Vec3(axes * d)) + axes * rate;
  };
  if (j.kind == Kind::revolute || j.kind == Kind::continuous) {
    out.frame.axes = axes * exp_so3<double>(Vec3(j.axis * m.position));
    out.rotation += axes * j.axis * m.rate;
  } else if (j.kind == Kind::prismatic) {
    translate(j.axis * m.position, j.axis * m.rate);
  } else if (j.kind == Kind::floating || j.kind == Kind::planar) {
    m.pose.check(robot.where(j));
    if (j.kind == Kind::planar) require_urdf_plane(robot, j, m);
    translate(m.pose.origin, m.velocity);
    out.frame.axes = axes * m.pose.axes;
    out.rotation += axes * m.angular_velocity;
  }
  return out;
}

/// Poses of all links for the motions `given`, by names of joints; other joints are at rest at zero. `root` is the pose
/// of the root.
/// \throws InvalidInput for a name that no joint has, and for a number that is not finite.
template <class = void>  // compiled only if used
std::vector<UrdfPose> urdf_poses(UrdfRobot const& robot, UrdfPose const& root,
                                 std::map<std::string, UrdfMotion> const& given) {
  for (auto const& [name, m] : given) {
    UrdfJoint const& j = robot.joints[std::size_t(robot.joint(name))];
    for (double const x : {m.position, m.rate})
      if (!(std::abs(x) <= 1e9))
        throw InvalidInput("urdf.motion",
                           {ErrorObject{robot.where(j)},
                            ": its position and rate must lie in [-1e+09, 1e+09], but one is ", ErrorValue{x}, "."});
    if (j.kind == UrdfJoint::Kind::fixed)
      throw InvalidInput("urdf.motion", {ErrorObject{robot.where(j)}, ": a fixed joint has no motion."});
  }
  std::vector<UrdfPose> out(robot.links.size());
  out[0] = root;
  for (std::size_t i = 1; i < out.size(); ++i) {
    UrdfJoint const& j = robot.joints[std::size_t(robot.links[i].joint)];
    out[i] = urdf_child(robot, j, out[std::size_t(j.parent)], urdf_motion(robot, j, given));
  }
  return out;
}

}  // namespace detail
}  // namespace polybody
