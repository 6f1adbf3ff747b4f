#pragma once
/// \file
/// Hull of the vehicle of m113_vehicle.hpp as a part of any model with its types. For vehicles; not included by
/// polybody.hpp.

#include <vector>

#include <polybody/forces/axial_spring.hpp>
#include <polybody/forces/spring_damper.hpp>
#include <polybody/joints/policies/constraint.hpp>
#include <polybody/joints/prescribed_rate.hpp>
#include <polybody/joints/prismatic.hpp>
#include <polybody/joints/revolute.hpp>
#include <polybody/joints/weld.hpp>
#include <polybody/system/subassembly.hpp>
#include <polybody/vehicle/hull.hpp>
#include <polybody/vehicle/track_links.hpp>
#include <polybody/vehicle/vehicle_options.hpp>

namespace polybody::m113 {

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

/// Adds one joint or spring of the hull. Returns the handle of a drive; for other kinds, a handle of no model.
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
