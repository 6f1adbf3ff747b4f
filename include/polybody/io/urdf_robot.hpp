#pragma once
/// \file
/// Content of a URDF file: links with their inertia, and joints with their limits, damping, friction and mimicry.
/// Theory: Eqs. 10.11, 10.12.

#include <map>
#include <optional>
#include <string>
#include <vector>

#include <polybody/bodies/rigid/inertia.hpp>

namespace polybody {

/// Limits of a joint, as in the element `limit`.
struct UrdfLimit {
  double lower = 0.0;     ///< least position [rad], [m]; no limit for a continuous joint
  double upper = 0.0;     ///< largest position [rad], [m]; no limit for a continuous joint
  double effort = 0.0;    ///< largest force of a drive [N m], [N]
  double velocity = 0.0;  ///< largest speed [rad/s], [m/s]
};

/// Coupling of a joint to another one, as in the element `mimic`: position = multiplier · position of `joint` + offset.
struct UrdfMimic {
  Index joint = -1;         ///< index of the joint that is followed
  double multiplier = 1.0;  ///< ratio of the positions
  double offset = 0.0;      ///< position if the followed joint is at zero [rad], [m]
};

/// Link of a robot.
struct UrdfLink {
  std::string name = {};                ///< name in the file
  Index line = 0;                       ///< line of the file, from 1; 0 if it was not found
  Index joint = -1;                     ///< index of the joint that carries the link; −1 for the root
  std::optional<Inertia> inertia = {};  ///< in the axes of the link; empty for a link without mass
  Placement frame = {};                 ///< frame of the link at zero positions of all joints, in axes of the root
};

/// Joint of a robot.
struct UrdfJoint {
  /// Motions that a joint permits.
  enum class Kind : unsigned char { fixed, revolute, continuous, prismatic, floating, planar };
  std::string name = {};                ///< name in the file
  Index line = 0;                       ///< line of the file, from 1; 0 if it was not found
  Kind kind = Kind::fixed;              ///< permitted motions
  Index parent = -1;                    ///< index of the parent link
  Index child = -1;                     ///< index of the child link
  Placement origin = {};                ///< frame of the joint in the axes of the parent link
  Vec3 axis = Vec3::UnitX();            ///< (3) unit vector of the axis, or normal of a plane; axes of the joint
  std::optional<UrdfLimit> limit = {};  ///< `limit`, if given
  double damping = 0.0;                 ///< viscous damping [N m s/rad], [N s/m]
  double friction = 0.0;                ///< magnitude of the Coulomb friction [N m], [N]
  std::optional<UrdfMimic> mimic = {};  ///< `mimic`, if given
};

/// Robot of a URDF file. Parents come before their children: link 0 is the root.
struct UrdfRobot {
  std::string file = {};               ///< name of the file, for messages
  std::string name = {};               ///< name of the robot
  std::vector<UrdfLink> links = {};    ///< links in the order of the tree
  std::vector<UrdfJoint> joints = {};  ///< joints in the order of the links that they carry

  /// Index of the link `link_name`. \throws InvalidInput for a name that no link has.
  template <class = void>  // compiled only if used
  Index link(std::string const& link_name) const {
    for (std::size_t i = 0; i < links.size(); ++i)
      if (links[i].name == link_name) return Index(i);
    throw InvalidInput("urdf.no_link", {ErrorObject{file}, ": there is no link \"", link_name, "\". The links are ",
                                        names_of(links), "."});
  }
  /// Index of the joint `joint_name`. \throws InvalidInput for a name that no joint has.
  template <class = void>  // compiled only if used
  Index joint(std::string const& joint_name) const {
    for (std::size_t i = 0; i < joints.size(); ++i)
      if (joints[i].name == joint_name) return Index(i);
    throw InvalidInput("urdf.no_joint", {ErrorObject{file}, ": there is no joint \"", joint_name, "\". The joints are ",
                                         names_of(joints), "."});
  }
  /// Begin of a message about a joint: file, line and name.
  std::string where(UrdfJoint const& j) const { return where("joint", j.name, j.line); }
  /// Begin of a message about a link: file, line and name.
  std::string where(UrdfLink const& l) const { return where("link", l.name, l.line); }

 private:
  std::string where(char const* element, std::string const& name_of, Index line) const {
    return file + (line > 0 ? ", line " + std::to_string(line) : "") + ", " + element + " \"" + name_of + "\"";
  }
  template <class Parts>
  static std::string names_of(Parts const& parts) {
    std::string out;
    for (auto const& part : parts)
      if (out.size() < 200) out += (out.empty() ? "" : ", ") + part.name;
    return out.empty() ? "none" : out;
  }
};

/// Position and velocity of a joint, or of a free root, for `UrdfModel::state`.
struct UrdfMotion {
  double position = 0.0;  ///< revolute, continuous [rad]; prismatic [m]
  double rate = 0.0;      ///< rate of `position` [rad/s], [m/s]
  /// Floating and planar joints: frame of the child link in axes of the joint. Free root: frame of the root in world
  /// axes.
  Placement pose = {};
  Vec3 velocity = Vec3::Zero();          ///< rate of `pose.origin` (3), same axes [m/s]
  Vec3 angular_velocity = Vec3::Zero();  ///< (3) rate of `pose.axes`, same axes [rad/s]
};

}  // namespace polybody
