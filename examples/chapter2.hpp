#pragma once
// The models of Chapter 2 of M. Wallin's thesis (2016), for any body, planar or spatial: a flexible robot arm whose
// angle is prescribed, and a clamped beam under a tip moment. Shared by the examples and their tests.
//
// Table 2.1 gives stiffnesses in the ratio EA : GA : EI = 1 : 1/2 : 1/12, those of a section of 1 m x 1 m without
// lateral contraction. The thesis does not give the mass. It follows from the section and from the density, which is an
// option.
#include <polybody/polybody.hpp>

namespace chapter2 {

using namespace polybody;
using planar::EngineeringStrain;
using planar::GreenStrain;

// Stiffnesses of Table 2.1 [N], [N], [N m^2]. The figure numbers in the heads of the printed table are shifted by one
// from those in the text, which these names follow (docs/chapter2.md).
struct Stiffness {
  std::string name;
  double EA, GA, EI;
};
inline Stiffness const high{"high", 1.00e9, 5.00e8, 8.33e7};
inline Stiffness const medium{"medium", 1.00e7, 5.00e6, 8.33e5};
inline Stiffness const low{"low", 1.00e6, 5.00e5, 8.33e4};

inline constexpr double length = 10.0;  // [m]
inline constexpr double angle = 1.5;    // prescribed angle at the end of the ramp [rad]

inline Bar bar(Stiffness const& s, double density) {
  double const area = 1.0;  // 1 m x 1 m
  return {.length = length,
          .constants = BarConstants{.EA = s.EA,
                                    .EI = s.EI,
                                    .mass_per_length = density * area,
                                    .GA = s.GA,
                                    .GJ = 0.1406 * s.GA,  // G J of a square [Timoshenko & Goodier 1970, §109]
                                    .rotary_inertia = density * area / 12.0}};
}
// Bar of section and material instead of constants, with the stiffnesses of `bar`.
inline Bar solid_bar(Stiffness const& s, double density) {
  return {.length = length,
          .section = Rectangle{.height = 1.0, .width = 1.0},
          .material = Material{.density = density, .young = s.EA, .poisson = 0.0},
          .shear_factor = s.GA / (0.5 * s.EA)};
}

// Joints of body B: a pin about the normal of the plane, and a clamp.
template <class B>
using PinOf = std::conditional_t<B::world == World::plane, planar::Revolute, Revolute>;
template <class B>
using ClampOf = std::conditional_t<B::world == World::plane, planar::Weld, Weld>;
template <class B>
PinOf<B> pin_of() {
  if constexpr (B::world == World::plane)
    return {};
  else
    return {.axis = Vec3::UnitZ()};
}

// Arm on a pin at the origin. The angle of its first section is prescribed. An axial follower force of constant
// magnitude may act at the tip.
template <class B, class P = Constraint>
struct RobotArm {
  using Pin = Joint<PinOf<B>, P>;
  using FirstJoint = Pin;
  using Drive = Joint<PrescribedAngle<Ramp>, Constraint>;
  using Model = polybody::Model<Bodies<B>, Joints<Pin, Drive>, Forces<PointForce<>>>;

  Model model;
  BodyHandle<B> arm;
  ElementHandle<Pin> pin;

  RobotArm(B const& body, double ramp, double axial_force = 0.0, P policy = {})
      : arm(model.add(body, "arm")),
        pin(model.connect(Joint{pin_of<B>(), policy}, model.ground().at({0, 0, 0}), arm.at(0.0), "pin")) {
    model.connect(Drive{{Ramp{.target = angle, .duration = ramp}, Vec3::UnitZ()}, {}}, model.ground().at({0, 0, 0}),
                  arm.at(0.0), "drive");
    if (axial_force != 0.0)
      model.apply(PointForce<>{.force = {axial_force, 0, 0}, .axes = LoadAxes::marker}, arm.at(length), "tip force");
  }
  RobotArm(Bar const& spec, Index elements, double ramp, double axial_force = 0.0, P policy = {})
      : RobotArm(B::from(spec, {.elements = elements}), ramp, axial_force, policy) {}

  BodyHandle<B> const& body() const { return arm; }
};

// Distance of the arm's tip behind the rigid arm [m], for a ramp of this duration [s].
inline double lag_of(double t, Vec3 const& tip, double ramp) {
  double const psi = Ramp{.target = angle, .duration = ramp}(t).value;
  return std::sin(psi) * tip[0] - std::cos(psi) * tip[1];
}

// The beam is clamped at the origin and a moment about z acts at its tip.
template <class B, class P = Constraint>
struct Cantilever {
  using Clamp = Joint<ClampOf<B>, P>;
  using FirstJoint = Clamp;
  using Model = polybody::Model<Bodies<B>, Joints<Clamp>, Forces<PointMoment<>>>;

  Model model;
  BodyHandle<B> beam;

  Cantilever(B const& body, double moment, P policy = {}) : beam(model.add(body, "beam")) {
    model.connect(Clamp{{}, policy}, model.ground().at({0, 0, 0}), beam.at(0.0), "clamp");
    model.apply(PointMoment<>{.moment = {0, 0, moment}}, beam.at(length), "tip moment");
  }
  Cantilever(Bar const& spec, Index elements, double moment)
      : Cantilever(B::from(spec, {.elements = elements}), moment) {}

  BodyHandle<B> const& body() const { return beam; }
};

}  // namespace chapter2
