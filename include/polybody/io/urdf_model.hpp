#pragma once
/// \file
/// Model of a URDF file: rigid links, their joints with a policy of choice, and flexible bodies in place of links.

#include <algorithm>
#include <functional>
#include <numeric>
#include <variant>

#include <polybody/forces/friction_laws.hpp>
#include <polybody/forces/limits.hpp>
#include <polybody/io/urdf_kinematics.hpp>
#include <polybody/joints/gears.hpp>
#include <polybody/joints/standard_joints.hpp>
#include <polybody/run/marker_frames.hpp>
#include <polybody/system/model.hpp>

namespace polybody {

/// Stiffness and damping of the stops at the limits of joints.
struct UrdfStops {
  Required<double> angle_stiffness;  ///< of revolute joints [N m/rad]
  double angle_damping = 0.0;        ///< of revolute joints [N m s/rad]
  Required<double> slide_stiffness;  ///< of prismatic joints [N/m]
  double slide_damping = 0.0;        ///< of prismatic joints [N s/m]
};

/// Slip speeds of the dry friction of joints, at which the regularised friction is 0.7 of its limit.
struct UrdfSlipSpeeds {
  Required<double> angle;  ///< of revolute and continuous joints [rad/s]
  Required<double> slide;  ///< of prismatic joints [m/s]
};

/// Data of a model that a URDF file does not contain.
struct UrdfOptions {
  Required<UrdfRoot> root;   ///< attachment of the root link
  Gravity gravity = {};      ///< gravity in world axes [m/s²]; zero by default
  Placement placement = {};  ///< frame of the root link in world axes, in the reference configuration
  bool free_mimics = false;  ///< true: joints with `mimic` move freely, and are not refused if no gear represents them
  std::optional<UrdfStops> stops = {};  ///< stops at the limits of revolute and prismatic joints; none by default
  std::optional<UrdfSlipSpeeds> slip_speeds = {};  ///< dry friction of these joints; none by default
};

/// Flexible body of type F in place of a link.
template <Body F>
struct UrdfFlexibleLink {
  std::string link;  ///< name of the link
  /// Function that returns the body for the frame of the link in world axes.
  std::function<F(Placement const& frame)> body;
  /// Function that returns the marker at `point` (3), in axes of the link from its origin [m].
  std::function<Marker<F>(BodyHandle<F> const& handle, Vec3 const& point)> at;
};

/// Point of a link: name of the link, and position (3) in its axes from its origin [m].
struct UrdfPoint {
  std::string link;           ///< name of the link
  Vec3 point = Vec3::Zero();  ///< (3) position in axes of the link [m]
};

/// Model of a URDF file. Its reference configuration has all joints at zero. `model` is a `Model` like any other:
/// bodies, joints and forces can be added. Joints of the file have the policy P and the names of the file. The lists
/// contain further types of joints and forces; Fs are the types of flexible links.
/// - A link with mass is a body in the axes of the link. A link without mass is a frame of another body.
/// - Revolute and continuous joints are `Revolute` joints, prismatic ones `Prismatic`, planar ones `PlanarJoint`.
/// - A fixed joint between links with mass is a `Weld`. A floating joint adds no joint.
/// - The damping of a joint is the viscous part of a `DryFriction`. With `slip_speeds`, its friction is the dry part.
/// - With `stops`, the limits of revolute and prismatic joints are `Limit` forces.
/// - A joint that mimics another one is a `Gear` if both are revolute joints on one link with parallel axes.
/// - Limits of effort and speed are data, `robot().joints`; `servo` gives them to a servo.
template <class P, class JointList = Joints<>, class ForceList = Forces<>, class... Fs>
class UrdfModel;
/// Model with these types.
template <Policy P, class... Js, class... Xs, Body... Fs>
class UrdfModel<P, Joints<Js...>, Forces<Xs...>, Fs...> {
 public:
  using AngleFriction = OnAngle<DryFriction>;        ///< damping and friction of revolute and continuous joints
  using SlideFriction = OnTranslation<DryFriction>;  ///< damping and friction of prismatic joints
  using Mimic = Joint<Gear, Constraint>;             ///< coupling of a joint to another one
  template <class G>
  using JointOf = Joint<G, P>;  ///< joint of the file with the geometry G
  /// Type of `model`.
  using ModelType =
      Model<EachOnce<Bodies, Rigid<>, Fs...>,
            EachOnce<Joints, JointOf<Weld>, JointOf<Revolute>, JointOf<Prismatic>, JointOf<PlanarJoint>, Mimic, Js...>,
            EachOnce<Forces, AngleFriction, SlideFriction, JointLimit, TurnsLimit, SlideLimit, Xs...>>;

  ModelType model;  ///< bodies, joints and forces

  /// Builds the model of `robot` with the `flexible` links.
  /// \throws InvalidInput, naming file, line and element, for a link without mass that moves by itself, for a mimic
  /// that no gear represents, and for a flexible link that does not exist.
  template <class = void>  // compiled only if used
  UrdfModel(UrdfRobot robot, UrdfOptions const& options, UrdfFlexibleLink<Fs> const&... flexible)
      : model(options.gravity), robot_(std::move(robot)), root_(options.root), bodies_(robot_.links.size()) {
    options.placement.check("UrdfOptions");
    for (UrdfLink const& link : robot_.links)
      poses_.push_back({{Vec3(options.placement.origin + options.placement.axes * link.frame.origin),
                         Mat3(options.placement.axes * link.frame.axes)}});
    (add_flexible(flexible), ...);
    std::vector<bool> is_body;
    for (std::size_t i = 0; i < bodies_.size(); ++i)
      is_body.push_back(robot_.links[i].inertia || !std::holds_alternative<std::monostate>(bodies_[i].handle));
    hosts_ = detail::urdf_bodies(robot_, is_body, root_);
    for (std::size_t i = 0; i < bodies_.size(); ++i)
      if (robot_.links[i].inertia && std::holds_alternative<std::monostate>(bodies_[i].handle))
        bodies_[i].handle = model.add(Rigid<>(robot_.links[i].inertia->body(poses_[i].frame)), robot_.links[i].name);
    if (root_ == UrdfRoot::fixed && hosts_[0] >= 0)
      at_marker(0, Vec3::Zero(), [&](auto const& b) {
        model.connect(JointOf<Weld>{}, model.ground().at(poses_[0].frame.origin), b,
                      robot_.links[0].name + " on the ground");
      });
    for (UrdfJoint const& j : robot_.joints) joints_.push_back(add_joint(j, options));
    for (UrdfJoint const& j : robot_.joints)
      if (j.mimic && !options.free_mimics) add_mimic(j);
  }

  UrdfRobot const& robot() const { return robot_; }  ///< content of the file

  /// Handle of the body of type B that carries `link`. \throws InvalidInput for a link that no body of this type
  /// carries.
  template <Body B = Rigid<>>
  BodyHandle<B> const& body(std::string const& link) const {
    Index const host = hosts_[std::size_t(robot_.link(link))];
    if (host >= 0)
      if (auto const* const found = std::get_if<BodyHandle<B>>(&bodies_[std::size_t(host)].handle)) return *found;
    throw InvalidInput("urdf.other_body",
                       {ErrorObject{robot_.where(robot_.links[std::size_t(robot_.link(link))])},
                        host < 0 ? ": the link belongs to the ground." : ": the body of the link has another type."});
  }
  /// Handle of the joint `name` with the geometry G: `joint<Revolute>("elbow")`. \throws InvalidInput for a joint of
  /// another geometry.
  template <JointGeometry G>
  ElementHandle<JointOf<G>> const& joint(std::string const& name) const {
    Index const i = robot_.joint(name);
    if (auto const* const found = std::get_if<ElementHandle<JointOf<G>>>(&joints_[std::size_t(i)])) return *found;
    throw InvalidInput("urdf.other_joint", {ErrorObject{robot_.where(robot_.joints[std::size_t(i)])},
                                            ": the joint is not a ", G::name, "."});
  }
  /// The servo `law` with the limits of the joint `name` as further bounds: `effort` bounds its force, and `velocity`
  /// its commanded speed. A law like `Servo` or `PidServo` keeps its own bounds if they are smaller. A limit of zero in
  /// the file is a bound of zero, which the servo refuses when it is applied. \throws InvalidInput for a joint without
  /// limits.
  template <class L>
    requires requires(L servo) { servo.most_force = servo.most_speed; }
  L servo(std::string const& name, L law) const {
    UrdfJoint const& j = robot_.joints[std::size_t(robot_.joint(name))];
    if (!j.limit)
      throw InvalidInput("urdf.no_limit", {ErrorObject{robot_.where(j)},
                                           ": the joint has no element <limit> that bounds a servo. Give the servo its "
                                           "own bounds."});
    law.most_force = std::min(law.most_force, j.limit->effort);
    law.most_speed = std::min(law.most_speed, j.limit->velocity);
    return law;
  }
  /// Marker at the point p of a link that a rigid body carries. \throws InvalidInput for another link.
  template <class = void>  // compiled only if used
  Marker<Rigid<>> at(UrdfPoint const& p) const {
    BodyHandle<Rigid<>> const& handle = body(p.link);
    return handle.at(from_centre(robot_.link(p.link), p.point));
  }
  /// Direction in world axes, in the reference configuration, of `v` (3) in axes of `link`: for the axis of a joint.
  template <class = void>  // compiled only if used
  Vec3 direction(std::string const& link, Vec3 const& v) const {
    return poses_[std::size_t(robot_.link(link))].frame.axes * v;
  }

  /// Joins the points a and b of two links by a joint `name`, as `Model::connect` does: for loops, which a URDF file
  /// cannot contain. Call `assemble(model, x)` if the points do not coincide when all joints are at zero.
  template <class J>
  ElementHandle<J> connect(J const& joint, UrdfPoint const& a, UrdfPoint const& b, std::string const& name = "") {
    ElementHandle<J> out;
    at_marker(robot_.link(a.link), a.point, [&](auto const& first) {
      at_marker(robot_.link(b.link), b.point,
                [&](auto const& second) { out = model.connect(joint, first, second, name); });
    });
    return out;
  }

  /// State with the `motions` of joints, by their names; other joints are at rest at zero. Joints with `mimic` follow
  /// their joint. The motion of a free root has the name of the root link.
  /// \throws InvalidInput for a name that no joint has, for a motion that the joint does not permit, and if a flexible
  /// link leaves its reference configuration.
  template <class = void>  // compiled only if used
  State state(std::map<std::string, UrdfMotion> motions = {}) const {
    detail::UrdfPose root = poses_[0];
    if (auto const of_root = motions.find(robot_.links[0].name); root_ == UrdfRoot::free && of_root != motions.end()) {
      UrdfMotion const& m = of_root->second;
      m.pose.check(robot_.where(robot_.links[0]));
      root = {m.pose, m.velocity, m.angular_velocity};
      motions.erase(of_root);
    }
    std::vector<detail::UrdfPose> const poses = detail::urdf_poses(robot_, root, motions);
    State x = model.reference_state();
    for (std::size_t i = 0; i < bodies_.size(); ++i)
      std::visit([&](auto const& handle) { set(x, handle, i, poses[i]); }, bodies_[i].handle);
    for (auto const& [link, force] : turns_)
      model.states(x, force)[0] =
          detail::urdf_motion(robot_, robot_.joints[std::size_t(robot_.links[std::size_t(link)].joint)], motions)
              .position;
    return x;
  }

  /// Frame of `link` in state x, in world axes. \throws InvalidInput for a state of another model.
  template <class = void>  // compiled only if used
  Placement placement(State const& x, std::string const& link) const {
    Index const i = robot_.link(link);
    Placement out = poses_[std::size_t(i)].frame;
    at_marker(i, Vec3::Zero(), [&](auto const& marker) {
      Frame<double> const now = frame(model, x, marker), built = frame(model, model.reference_state(), marker);
      out = {now.r, now.A * built.A.transpose() * out.axes};
    });
    return out;
  }

 private:
  using AnyHandle = EachOnce<std::variant, std::monostate, BodyHandle<Rigid<>>, BodyHandle<Fs>...>;
  using AnyJoint = std::variant<std::monostate, ElementHandle<JointOf<Weld>>, ElementHandle<JointOf<Revolute>>,
                                ElementHandle<JointOf<Prismatic>>, ElementHandle<JointOf<PlanarJoint>>>;
  template <class F>
  using PointOf = std::function<Marker<F>(BodyHandle<F> const&, Vec3 const&)>;
  struct Part {
    AnyHandle handle = {};
    EachOnce<std::variant, std::monostate, PointOf<Fs>...> at = {};  ///< points of a flexible link
  };

  template <class F>
  void add_flexible(UrdfFlexibleLink<F> const& flexible) {
    std::size_t const i = std::size_t(robot_.link(flexible.link));
    bodies_[i] = {model.add(flexible.body(poses_[i].frame), flexible.link), flexible.at};
  }

  /// Point of a link (3) from the origin of the body that carries it, in the axes of this body.
  Vec3 in_host(Index link, Vec3 const& point) const {
    Placement const &of = poses_[std::size_t(link)].frame, &host = poses_[std::size_t(hosts_[std::size_t(link)])].frame;
    return host.axes.transpose() * (of.origin + of.axes * point - host.origin);
  }
  /// Point of a link (3) from the centre of mass of the rigid body that carries it.
  Vec3 from_centre(Index link, Vec3 const& point) const {
    return in_host(link, point) - robot_.links[std::size_t(hosts_[std::size_t(link)])].inertia->centre;
  }
  /// Calls f(marker) with the marker at a point of a link.
  template <class F>
  void at_marker(Index link, Vec3 const& point, F&& f) const {
    Index const host = hosts_[std::size_t(link)];
    Placement const& of = poses_[std::size_t(link)].frame;
    if (host < 0) return f(model.ground().at(Vec3(of.origin + of.axes * point)));
    Part const& part = bodies_[std::size_t(host)];
    std::visit(
        [&]<class H>(H const& handle) {
          if constexpr (std::is_same_v<H, BodyHandle<Rigid<>>>) {
            if (std::holds_alternative<std::monostate>(part.at)) return f(handle.at(from_centre(link, point)));
          }
          (..., (std::is_same_v<H, BodyHandle<Fs>> ? at_flexible<Fs>(part, in_host(link, point), f) : void()));
        },
        part.handle);
  }
  template <Body B, class F>
  void at_flexible(Part const& part, Vec3 const& point, F&& f) const {
    if (auto const* const handle = std::get_if<BodyHandle<B>>(&part.handle))
      f(std::get<PointOf<B>>(part.at)(*handle, point));
  }

  template <class B>
  void set(State& x, BodyHandle<B> const& handle, std::size_t i, detail::UrdfPose const& pose) const {
    Placement const& p = pose.frame;
    if (std::is_same_v<B, Rigid<>> && std::holds_alternative<std::monostate>(bodies_[i].at)) {
      Vec3 const centre = p.origin + p.axes * robot_.links[i].inertia->centre;
      Quaternion<double> const turn = quaternion_of(p.axes);
      Index const q0 = model.entry(handle).q0;
      for (Index k = 0; k < 3; ++k) x.q[q0 + k] = centre[k];
      for (Index k = 0; k < 4; ++k) x.q[q0 + 3 + k] = turn[k];
    } else if ((p.origin - poses_[i].frame.origin).norm() > 1e-12 || (p.axes - poses_[i].frame.axes).norm() > 1e-12) {
      throw InvalidInput("urdf.flexible", {ErrorObject{robot_.where(robot_.links[i])},
                                           ": a flexible link has positions in the reference configuration only. Leave "
                                           "the joints that carry it at zero, or set `placement` of UrdfOptions."});
    }
    model.set_velocity(x, handle, pose.velocity - pose.rotation.cross(p.origin), pose.rotation);
  }
  void set(State&, std::monostate, std::size_t, detail::UrdfPose const&) const {}

  /// Adds a joint at the origin of its child link, with the friction and the stops of its motion.
  AnyJoint add_joint(UrdfJoint const& j, UrdfOptions const& options) {
    std::optional<UrdfStops> const& stops = options.stops;
    std::optional<UrdfSlipSpeeds> const& speeds = options.slip_speeds;
    using Kind = UrdfJoint::Kind;
    if (j.kind == Kind::floating || hosts_[std::size_t(j.parent)] == hosts_[std::size_t(j.child)]) return {};
    if (j.kind == Kind::fixed) return connect_at(JointOf<Weld>{}, j);
    Vec3 const axis = poses_[std::size_t(j.child)].frame.axes * j.axis;
    if (j.kind == Kind::planar) return connect_at(JointOf<PlanarJoint>{PlanarJoint{.normal = axis}}, j);
    if (j.kind == Kind::prismatic) {
      auto const handle = connect_at(JointOf<Prismatic>{Prismatic{.axis = axis}}, j);
      apply_friction<SlideFriction>(j, handle, speeds ? std::optional<double>(speeds->slide) : std::nullopt);
      if (stops && j.limit)
        model.apply(SlideLimit{limit(j, stops->slide_stiffness, stops->slide_damping)}, handle, j.name + " limit");
      return handle;
    }
    auto const handle = connect_at(JointOf<Revolute>{Revolute{.axis = axis}}, j);
    apply_friction<AngleFriction>(j, handle, speeds ? std::optional<double>(speeds->angle) : std::nullopt);
    if (stops && j.limit && j.kind == Kind::revolute) {
      Limit const law = limit(j, stops->angle_stiffness, stops->angle_damping);
      if (std::max(-law.lower, law.upper) < std::numbers::pi)
        model.apply(JointLimit{law}, handle, j.name + " limit");
      else  // beyond half a turn, the limit counts turns
        turns_.emplace_back(j.child, model.apply(TurnsLimit{law}, handle, j.name + " limit"));
    }
    return handle;
  }
  static Limit limit(UrdfJoint const& j, double stiffness, double damping) {
    return {.lower = j.limit->lower, .upper = j.limit->upper, .stiffness = stiffness, .damping = damping};
  }
  /// Applies the damping of a joint, and its friction if there is a slip speed.
  template <class F, class J>
  void apply_friction(UrdfJoint const& j, ElementHandle<J> const& handle, std::optional<double> slip_speed) {
    double const dry = slip_speed ? j.friction : 0.0;
    if (dry > 0.0 || j.damping > 0.0)
      model.apply(F{{.curve = {.sliding = dry, .viscous = j.damping}, .slip_speed = slip_speed.value_or(1.0)}}, handle,
                  j.name + " friction");
  }
  template <class J>
  ElementHandle<J> connect_at(J const& joint, UrdfJoint const& j) {
    return connect(joint, {robot_.links[std::size_t(j.parent)].name, j.origin.origin},
                   {robot_.links[std::size_t(j.child)].name}, j.name);
  }

  /// Adds the gear of a joint that mimics another one. \throws InvalidInput if no gear represents the coupling.
  void add_mimic(UrdfJoint const& b) {
    UrdfJoint const& a = robot_.joints[std::size_t(b.mimic->joint)];
    auto const refuse = [&](std::string const& why) {
      throw InvalidInput("urdf.mimic", {ErrorObject{robot_.where(b)}, ": its <mimic> of the joint \"", a.name,
                                        "\" is not supported, because ", why,
                                        ". Set free_mimics of UrdfOptions, and add a coupling to the model."});
    };
    auto const turns = [](UrdfJoint const& j) {
      return j.kind == UrdfJoint::Kind::revolute || j.kind == UrdfJoint::Kind::continuous;
    };
    if (!turns(a) || !turns(b)) refuse("a gear needs two revolute joints");
    if (hosts_[std::size_t(a.parent)] != hosts_[std::size_t(b.parent)])
      refuse("the joints have different parent links");
    if (b.mimic->offset != 0.0) refuse("the offset is " + number(b.mimic->offset) + " rad, but a gear needs 0 rad");
    Placement const &of_a = poses_[std::size_t(a.child)].frame, &of_b = poses_[std::size_t(b.child)].frame;
    Vec3 const axis = of_a.axes * a.axis, other = of_b.axes * b.axis;
    if (axis.cross(other).norm() > 1e-9) refuse("the axes are not parallel");
    Vec3 const line = of_b.origin - of_a.origin, across = line - axis * axis.dot(line);
    if (across.norm() < 1e-9) refuse("the axes coincide");
    double const ratio = b.mimic->multiplier * (axis.dot(other) > 0.0 ? 1.0 : -1.0);  // both about the axis of a
    for (int n = 1; n <= 1000; ++n) {
      double const of = std::abs(ratio) * n;
      int const m = int(std::min(std::round(of), 1e6));
      if (m == 0 || std::abs(of - m) > 1e-9 * of) continue;
      if (ratio > 0.0 && m == n) refuse("both joints turn equally, which no gear does");
      bool const ring_is_a = ratio > 0.0 && m > n, ring_is_b = ratio > 0.0 && !ring_is_a;
      connect(Mimic{Gear{.teeth_a = ring_is_a ? -m : m,
                         .teeth_b = ring_is_b ? -n : n,
                         .axis = axis,
                         .centres = across.normalized()}},
              {robot_.links[std::size_t(a.child)].name},
              {robot_.links[std::size_t(b.child)].name, of_b.axes.transpose() * (across - line)}, b.name + " mimic");
      return;
    }
    refuse("the multiplier " + number(b.mimic->multiplier) +
           " is not a ratio of integers with a denominator up to 1000");
  }

  UrdfRobot robot_;
  UrdfRoot root_;
  std::vector<detail::UrdfPose> poses_ = {};  ///< in the reference configuration
  std::vector<Part> bodies_;                  ///< by links; empty for links that other bodies carry
  std::vector<Index> hosts_ = {};             ///< by links: index of the link whose body carries it; −1 for the ground
  std::vector<AnyJoint> joints_ = {};         ///< by joints
  std::vector<std::pair<Index, ElementHandle<TurnsLimit>>> turns_ = {};  ///< child links, and limits that count turns
};

}  // namespace polybody
