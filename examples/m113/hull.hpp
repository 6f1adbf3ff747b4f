#pragma once
/// \file
/// Hull of the vehicle: bodies that carry the tracks, with their joints and springs, as data and as a part of any model
/// that has their types.

#include <string>
#include <vector>

#include <polybody/forces/springs.hpp>
#include <polybody/joints/driving_constraints.hpp>
#include <polybody/joints/policies/policy.hpp>
#include <polybody/joints/standard_joints.hpp>
#include <polybody/math/so3.hpp>
#include <polybody/run/marker_frames.hpp>
#include <polybody/system/subassembly.hpp>

#include "links.hpp"
#include "options.hpp"
#include "track_frames.hpp"

namespace polybody::m113 {

/// Rigid body of one side of the vehicle. Its axes may be rotated about y.
struct HullBody {
  std::string name;            ///< unique in the vehicle, such as "left wheel 1"
  Solid solid;                 ///< mass and moments of inertia
  Vec3 centre = Vec3::Zero();  ///< (3) centre of mass, world axes [m]
  double about_y = 0.0;        ///< rotation about y [rad]
};

/// Joint or spring between two bodies.
struct HullJoint {
  /// `axle`: revolute joint about y; `mount`: weld; `guide`: prismatic joint along x; `drive`: prescribed speed about
  /// y; the other kinds: springs.
  enum class Kind { axle, mount, guide, drive, tensioner, shock };
  Kind kind;                                      ///< kind of joint or spring
  std::size_t a, b;                               ///< numbers of the two bodies, from 1; 0 is the chassis
  Vec3 at_a = Vec3::Zero(), at_b = Vec3::Zero();  ///< (3) points, each in the axes and from the centre of its body [m]
  std::string name;                               ///< unique in the vehicle, such as "left drive"
};

/// One side of the vehicle. Its bodies are sprocket, tensioner and idler, then a wheel and its arm for each road wheel.
struct HullSide {
  static constexpr std::size_t sprocket = 1, tensioner = 2, idler = 3;  ///< numbers of these bodies
  /// Number of road wheel i; i = 0 is in front, i = 4 at the rear.
  static constexpr std::size_t wheel(int i) { return 4 + 2 * std::size_t(i); }
  static constexpr std::size_t arm(int i) { return wheel(i) + 1; }  ///< number of the arm that carries wheel i

  std::string name;               ///< prefix of all names of this side
  std::vector<HullBody> bodies;   ///< bodies of this side; bodies[k − 1] has the number k
  std::vector<HullJoint> joints;  ///< joints and springs of this side
};

namespace detail {
/// Vector from the centre of body number `body` to the point `place` (world axes), in the axes of the body.
template <class = void>  // compiled only if it is used
Vec3 in_axes(std::vector<HullBody> const& bodies, std::size_t body, Vec3 const& place) {
  if (body == 0) return place - Vec3(chassis);
  HullBody const& b = bodies[body - 1];
  Vec3 const arm = place - b.centre;
  if (b.about_y == 0.0) return arm;
  return exp_so3<double>(Vec3(0, -b.about_y, 0)) * arm;
}
}  // namespace detail

/// Bodies, joints and springs of one side of the vehicle.
/// \param idler_x initial position of the idler along x [m]
/// \param sprung true: shock absorbers support the arms; false: the arms are welded to the chassis
template <class = void>  // compiled only if it is used
HullSide hull_side(Side s, Solids const& masses, double idler_x, bool sprung) {
  using enum HullJoint::Kind;
  HullSide hull{s == Side::left ? "left " : "right ", {}, {}};
  Vec3 const axle_of_sprocket = sprocket(s), axle_of_idler = idler(s, idler_x);
  hull.bodies = {{hull.name + "sprocket", masses.sprocket, axle_of_sprocket},
                 {hull.name + "tensioner", masses.tensioner, axle_of_idler},
                 {hull.name + "idler", masses.idler, axle_of_idler}};
  auto const span = [&](HullJoint::Kind kind, std::size_t a, Vec3 const& at_a, std::size_t b, Vec3 const& at_b,
                        std::string const& name) {
    hull.joints.push_back(
        {kind, a, b, detail::in_axes(hull.bodies, a, at_a), detail::in_axes(hull.bodies, b, at_b), name});
  };
  auto const join = [&](HullJoint::Kind kind, std::size_t a, std::size_t b, Vec3 const& place,
                        std::string const& name) { span(kind, a, place, b, place, name); };
  join(axle, 0, hull.sprocket, axle_of_sprocket, hull.name + "sprocket axle");
  join(drive, 0, hull.sprocket, axle_of_sprocket, hull.name + "drive");
  join(guide, 0, hull.tensioner, axle_of_idler, hull.name + "tensioner guide");
  join(axle, hull.tensioner, hull.idler, axle_of_idler, hull.name + "idler axle");
  span(tensioner, 0, idler(s, idler_reference_x), hull.tensioner, axle_of_idler, hull.name + "tensioner spring");
  for (int i = 0; i < wheels; ++i) {
    std::string const n = hull.name + "wheel " + std::to_string(i + 1);
    Vec3 const hub = wheel(i, s), pivot = arm_pivot(i, s), lower = arm_point(i, s, shock_on_arm);
    hull.bodies.push_back({n, masses.wheel, hub});
    hull.bodies.push_back({n + " arm", masses.arm, arm(i, s), arm_angle});
    join(axle, hull.arm(i), hull.wheel(i), hub, n + " axle");
    join(sprung ? axle : mount, 0, hull.arm(i), pivot, n + (sprung ? " pivot" : " mount"));
    if (sprung) span(shock, 0, lower + Vec3(0, 0, m113::shock.length), hull.arm(i), lower, n + " shock");
  }
  return hull;
}

/// Bodies that carry one track.
template <class Base>
struct Carriers {
  /// Five road wheels and five arms, from the front; one sprocket, one idler and one tensioner.
  std::vector<BodyHandle<Base>> wheels = {}, arms = {}, sprocket = {}, idler = {}, tensioner = {};

  /// Stores the bodies of one side. Stores the frames of sprocket and tensioner in `track`. \param bodies the chassis
  /// and the bodies of `hull`
  void set(HullSide const& hull, std::vector<BodyHandle<Base>> const& bodies, Track& track) {
    sprocket = {bodies[hull.sprocket]};
    tensioner = {bodies[hull.tensioner]};
    idler = {bodies[hull.idler]};
    for (int i = 0; i < m113::wheels; ++i) {
      wheels.push_back(bodies[hull.wheel(i)]);
      arms.push_back(bodies[hull.arm(i)]);
    }
    track.sprocket = frame_in(sprocket[0], sprocket[0].at(Vec3(0, 0, 0)));
    track.tensioner = frame_in(tensioner[0], tensioner[0].at(Vec3(0, 0, 0)));
  }
};

/// Types of the hull: bodies of type Base, joints as constraints, springs, and driving constraints with the function of
/// time `Drive`.
template <class Base, TimeFunction Drive>
struct HullTypes {
  using Hinge = Joint<Revolute, Constraint>;                ///< axles, and pivots of sprung arms
  using Slide = Joint<Prismatic, Constraint>;               ///< guide of a tensioner on the chassis
  using Fixed = Joint<Weld, Constraint>;                    ///< arms without springs, and a fixed chassis
  using Driven = Joint<PrescribedRate<Drive>, Constraint>;  ///< speed of a sprocket relative to the chassis
  /// Types of bodies, joints and forces that a model requires for the hull.
  using Part = Subassembly<Bodies<Base>, Joints<Hinge, Slide, Fixed, Driven>, Forces<SpringDamper, AxialSpring>>;
};

namespace detail {

template <class Base>
Base solid_body(Solid const& s, Vec3 const& centre, double about_y = 0.0) {
  return Base(s.mass, principal(s.inertia), Placement::at(centre, Vec3(0, about_y, 0)));
}

/// Adds the chassis, welded to the ground or free. If the ground is a body [Wallin 2016, Table 3.4], it is added first.
template <class Base, class Drive>
[[gnu::cold]] BodyHandle<Base> add_chassis(typename HullTypes<Base, Drive>::Part& part, VehicleOptions const& options) {
  using Fixed = typename HullTypes<Base, Drive>::Fixed;
  if (options.ground_body) {
    auto const body = part.add(solid_body<Base>({1.0, {1, 1, 1}}, Vec3(0, 0, 0)), "ground body");
    part.connect(Fixed{}, part.ground().at({0, 0, 0}), body.at(Vec3(0, 0, 0)), "ground weld");
  }
  auto const chassis = part.add(solid_body<Base>(options.masses.chassis, m113::chassis), "chassis");
  if (options.held) part.connect(Fixed{}, part.ground().at(Vec3(m113::chassis)), chassis.at(Vec3(0, 0, 0)), "hold");
  return chassis;
}

/// Adds one joint or spring of the hull. Returns the handle of a drive; for other kinds, an empty handle.
template <class Base, class Drive>
[[gnu::cold]] ElementHandle<typename HullTypes<Base, Drive>::Driven> add_hull_joint(
    typename HullTypes<Base, Drive>::Part& part, HullJoint const& j, std::vector<BodyHandle<Base>> const& bodies,
    Drive const& drive, double preload) {
  using Types = HullTypes<Base, Drive>;
  auto const a = bodies[j.a].at(j.at_a), b = bodies[j.b].at(j.at_b);
  Vec3 const y = Vec3::UnitY();
  ElementHandle<typename Types::Driven> driven;
  switch (j.kind) {
    case HullJoint::Kind::axle:
      part.connect(typename Types::Hinge{Revolute{.axis = y}, {}}, a, b, j.name);
      break;
    case HullJoint::Kind::mount:
      part.connect(typename Types::Fixed{}, a, b, j.name);
      break;
    case HullJoint::Kind::guide:
      part.connect(typename Types::Slide{Prismatic{.axis = Vec3::UnitX()}, {}}, a, b, j.name);
      break;
    case HullJoint::Kind::drive:
      driven = part.connect(typename Types::Driven{{.law = {drive}, .axis = y}, {}}, a, b, j.name);
      break;
    case HullJoint::Kind::tensioner:
      part.apply(
          AxialSpring{.stiffness = m113::tensioner.stiffness, .damping = m113::tensioner.damping, .preload = preload},
          a, b, j.name);
      break;
    case HullJoint::Kind::shock:
      part.apply(SpringDamper{.stiffness = shock.stiffness, .damping = shock.damping, .free_length = shock.length}, a,
                 b, j.name);
      break;
  }
  return driven;
}

/// Adds the bodies and joints that carry the track of one side. Returns the handle of its drive.
template <class Base, class Drive>
[[gnu::cold]] ElementHandle<typename HullTypes<Base, Drive>::Driven> add_carriers(
    typename HullTypes<Base, Drive>::Part& part, HullSide const& side, BodyHandle<Base> const& chassis,
    Drive const& drive, double preload, std::vector<BodyHandle<Base>>& bodies) {
  bodies = {chassis};
  for (HullBody const& b : side.bodies)
    bodies.push_back(part.add(solid_body<Base>(b.solid, b.centre, b.about_y), b.name));
  ElementHandle<typename HullTypes<Base, Drive>::Driven> driven;
  for (HullJoint const& j : side.joints) {
    auto const joint = add_hull_joint<Base, Drive>(part, j, bodies, drive, preload);
    if (j.kind == HullJoint::Kind::drive) driven = joint;
  }
  return driven;
}

}  // namespace detail

}  // namespace polybody::m113
