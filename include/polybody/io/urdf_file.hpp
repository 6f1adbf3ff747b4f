#pragma once
/// \file
/// Reader of URDF files by liburdfdom (Debian: liburdfdom-dev). Programs link -lurdfdom_model and -lconsole_bridge.

#include <mutex>

#include <console_bridge/console.h>
#include <urdf_parser/urdf_parser.h>

#include <polybody/io/text_files.hpp>
#include <polybody/io/urdf_robot.hpp>
#include <polybody/io/urdf_text.hpp>

namespace polybody {

namespace detail {

/// Receives the messages of liburdfdom while it exists, and keeps the first error.
class UrdfMessages : public console_bridge::OutputHandler {
 public:
  UrdfMessages() : lock_(mutex()), previous_(console_bridge::getOutputHandler()) {
    console_bridge::useOutputHandler(this);
  }
  ~UrdfMessages() override {
    if (previous_)
      console_bridge::useOutputHandler(previous_);
    else
      console_bridge::noOutputHandler();
  }
  UrdfMessages(UrdfMessages const&) = delete;
  UrdfMessages& operator=(UrdfMessages const&) = delete;
  void log(std::string const& text, console_bridge::LogLevel level, char const*, int) override {
    if (level >= console_bridge::CONSOLE_BRIDGE_LOG_ERROR && first_.empty()) first_ = text;
  }
  std::string const& first() const { return first_; }  ///< first error; empty if there is none

 private:
  static std::mutex& mutex() {
    static std::mutex one;
    return one;
  }
  std::lock_guard<std::mutex> lock_;
  console_bridge::OutputHandler* previous_;
  std::string first_ = {};
};

/// Converts the model of liburdfdom to a `UrdfRobot`.
class UrdfConversion {
 public:
  UrdfConversion(std::string const& file, UrdfText const& text, urdf::ModelInterface const& from)
      : text_(text), from_(from) {
    robot_.file = file;
    robot_.name = from.getName();
  }

  UrdfRobot robot() {
    require_one_parent();
    std::vector<urdf::Link const*> order;
    add_link(from_.getRoot().get(), -1);
    order.push_back(from_.getRoot().get());
    for (std::size_t i = 0; i < order.size(); ++i)
      for (urdf::JointSharedPtr const& j : order[i]->child_joints) {
        urdf::Link const* const child = from_.links_.at(j->child_link_name).get();
        add_joint(*j, Index(i), Index(order.size()));
        add_link(child, Index(robot_.joints.size()) - 1);
        order.push_back(child);
      }
    if (order.size() < from_.links_.size())
      fail(robot_.file, "the joints connect only " + std::to_string(order.size()) + " of " +
                            std::to_string(from_.links_.size()) + " links to the root \"" + robot_.links[0].name +
                            "\"; the other links form a closed loop. Leave out a joint of the loop, and add it to the "
                            "model by names of links");
    for (urdf::Link const* link : order)
      if (link->parent_joint) add_mimic(*link->parent_joint);
    return std::move(robot_);
  }

 private:
  [[noreturn, gnu::cold]] static void fail(std::string const& where, std::string const& what) {
    throw IoError("file.content", {ErrorObject{where}, ": ", what, "."});
  }
  /// Requires a finite number with a magnitude up to `most`.
  static double checked(double x, std::string const& where, char const* what, double least = -1e9, double most = 1e9) {
    if (x >= least && x <= most) return x;
    throw IoError("file.content", {ErrorObject{where}, ": ", what, " must lie in [", least, ", ", most, "], but is ",
                                   ErrorValue{x}, "."});
  }
  static Vec3 vector(urdf::Vector3 const& v, std::string const& where, char const* what) {
    return {checked(v.x, where, what), checked(v.y, where, what), checked(v.z, where, what)};
  }
  static Placement placement(urdf::Pose const& pose, std::string const& where) {
    urdf::Rotation const& r = pose.rotation;
    return {vector(pose.position, where, "a coordinate of xyz in <origin> [m]"),
            rotation_matrix<double>(Vec4(Vec4(r.w, r.x, r.y, r.z).normalized()))};
  }

  /// liburdfdom keeps only one of several joints that carry the same link.
  void require_one_parent() const {
    std::map<std::string, std::string> carried;
    for (auto const& [name, joint] : from_.joints_) {
      auto const [first, is_new] = carried.try_emplace(joint->child_link_name, name);
      if (!is_new)
        fail(robot_.file, "the joints \"" + first->second + "\" and \"" + name + "\" both carry the link \"" +
                              joint->child_link_name +
                              "\". A URDF file describes a tree: leave out one joint, and add it to the model by names "
                              "of links");
    }
  }

  void add_link(urdf::Link const* from, Index joint) {
    UrdfLink link{.name = from->name, .line = text_.line_of("link", from->name), .joint = joint};
    std::string const where = robot_.where(link);
    if (urdf::InertialSharedPtr const& i = from->inertial) {
      Mat3 tensor;
      tensor << i->ixx, i->ixy, i->ixz, i->ixy, i->iyy, i->iyz, i->ixz, i->iyz, i->izz;
      for (double const entry : tensor.reshaped()) checked(entry, where, "an entry of <inertia> [kg m²]", -1e30, 1e30);
      checked(i->mass, where, "<mass> [kg]", 0.0, 1e30);
      if (i->mass > 0.0) {
        link.inertia = Inertia{.mass = i->mass, .tensor = tensor};
        link.inertia->check(where);
        link.inertia = link.inertia->placed(placement(i->origin, where));
      } else if (!tensor.isZero(0.0)) {
        fail(where, "the link has the mass 0 kg, but an inertia tensor that is not zero");
      }
    }
    if (joint >= 0) {
      UrdfJoint const& j = robot_.joints[std::size_t(joint)];
      Placement const& parent = robot_.links[std::size_t(j.parent)].frame;
      link.frame = {parent.origin + parent.axes * j.origin.origin, parent.axes * j.origin.axes};
    }
    robot_.links.push_back(std::move(link));
  }

  void add_joint(urdf::Joint const& from, Index parent, Index child) {
    UrdfJoint joint{.name = from.name,
                    .line = text_.line_of("joint", from.name),
                    .kind = kind_of(from),
                    .parent = parent,
                    .child = child};
    std::string const where = robot_.where(joint);
    joint.origin = placement(from.parent_to_joint_origin_transform, where);
    if (joint.kind != UrdfJoint::Kind::fixed && joint.kind != UrdfJoint::Kind::floating) {
      Vec3 const axis = vector(from.axis, where, "a component of <axis>");
      if (!(axis.norm() > 1e-9)) fail(where, "the <axis> is zero");
      joint.axis = axis.normalized();
    }
    if (from.dynamics) {
      joint.damping = checked(from.dynamics->damping, where, "the damping of <dynamics>", 0.0, 1e30);
      joint.friction = checked(from.dynamics->friction, where, "the friction of <dynamics>", 0.0, 1e30);
    }
    if (from.limits) joint.limit = limit_of(*from.limits, joint, where);
    robot_.joints.push_back(std::move(joint));
  }
  static UrdfJoint::Kind kind_of(urdf::Joint const& from) {
    switch (from.type) {
      case urdf::Joint::REVOLUTE:
        return UrdfJoint::Kind::revolute;
      case urdf::Joint::CONTINUOUS:
        return UrdfJoint::Kind::continuous;
      case urdf::Joint::PRISMATIC:
        return UrdfJoint::Kind::prismatic;
      case urdf::Joint::FLOATING:
        return UrdfJoint::Kind::floating;
      case urdf::Joint::PLANAR:
        return UrdfJoint::Kind::planar;
      default:
        return UrdfJoint::Kind::fixed;
    }
  }
  static UrdfLimit limit_of(urdf::JointLimits const& from, UrdfJoint const& joint, std::string const& where) {
    UrdfLimit const out{.lower = checked(from.lower, where, "the lower <limit>", -1e30, 1e30),
                        .upper = checked(from.upper, where, "the upper <limit>", -1e30, 1e30),
                        .effort = checked(from.effort, where, "the effort of <limit>", 0.0, 1e30),
                        .velocity = checked(from.velocity, where, "the velocity of <limit>", 0.0, 1e30)};
    if (out.lower > out.upper && joint.kind != UrdfJoint::Kind::continuous)
      throw IoError("file.content", {ErrorObject{where}, ": the lower <limit> must not exceed the upper one, ",
                                     out.upper, ", but is ", ErrorValue{out.lower}, "."});
    return out;
  }

  void add_mimic(urdf::Joint const& from) {
    if (!from.mimic) return;
    UrdfJoint& joint = robot_.joints[std::size_t(robot_.joint(from.name))];
    std::string const where = robot_.where(joint);
    if (from.mimic->joint_name == from.name || !from_.joints_.contains(from.mimic->joint_name))
      fail(where, "<mimic> names the joint \"" + from.mimic->joint_name + "\", but needs another joint of the robot");
    joint.mimic = UrdfMimic{robot_.joint(from.mimic->joint_name),
                            checked(from.mimic->multiplier, where, "the multiplier of <mimic>"),
                            checked(from.mimic->offset, where, "the offset of <mimic>")};
  }

  UrdfText const& text_;
  urdf::ModelInterface const& from_;
  UrdfRobot robot_ = {};
};

}  // namespace detail

/// Robot of the URDF text `text`; `file` is its name in messages.
/// \throws IoError naming file, line and element for another text, for a number outside its range, and for links that
/// do not form a tree; InvalidInput for an inertia that no distribution of mass has.
template <class = void>  // compiled only if used
UrdfRobot read_urdf_text(std::string const& text, std::string const& file) {
  detail::UrdfText const lines(file, text);
  std::string problem;
  urdf::ModelInterfaceSharedPtr model;
  {
    detail::UrdfMessages const messages;
    try {
      model = urdf::parseURDF(text);
    } catch (std::exception const& error) {
      problem = error.what();
    }
    if (problem.empty()) problem = messages.first();
  }
  if (!model || !model->getRoot())
    throw IoError("file.content", {ErrorObject{file}, ": this is not a valid URDF file. liburdfdom reports: ",
                                   problem.empty() ? "no robot" : problem});
  return detail::UrdfConversion(file, lines, *model).robot();
}

/// Robot of a URDF file. \throws IoError for a file that cannot be read; the exceptions of `read_urdf_text`.
template <class = void>  // compiled only if used
UrdfRobot read_urdf_robot(std::string const& file) {
  std::optional<std::string> const text = detail::content_of(file);
  if (!text)
    throw IoError("file.open",
                  {ErrorObject{file}, ": the file cannot be opened. Check the path and the permission to read it."});
  return read_urdf_text(*text, file);
}

}  // namespace polybody
