#pragma once
// The models of Chapter 2 of M. Wallin's thesis (2016), for any planar body: a flexible robot arm whose angle is
// prescribed, and a clamped beam under a tip moment. Shared by the examples and their tests.
//
// Table 2.1 gives stiffnesses in the ratio EA : GA : EI = 1 : 1/2 : 1/12, those of a section of 1 m x 1 m without
// lateral contraction. The thesis does not give the mass. It follows from the section and from the density, which is an
// option.
#include <polybody/polybody.hpp>

namespace chapter2 {

using namespace polybody;
using planar::EngineeringStrain;
using planar::GreenStrain;

// Stiffnesses of Table 2.1 [N], [N], [N m^2] with the names of their figures. The heads in the printed table name the
// preceding figures.
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
                                    .rotary_inertia = density * area / 12.0}};
}

// Arm on a pin at the origin. The angle of its first section is prescribed. An axial follower force of constant
// magnitude may act at the tip.
template <class B, class P = Constraint>
struct RobotArm {
  using Pin = Joint<planar::Revolute, P>;
  using Drive = Joint<PrescribedAngle<Ramp>, Constraint>;
  using Model = polybody::Model<Bodies<B>, Joints<Pin, Drive>, Forces<PointForce<>>>;

  Model model;
  BodyHandle<B> arm;
  ElementHandle<Pin> pin;

  RobotArm(Bar const& spec, Index elements, double ramp, double axial_force = 0.0, P policy = {})
      : arm(model.add(B::from(spec, {.elements = elements}), "arm")),
        pin(model.connect(Joint{planar::Revolute{}, policy}, model.ground().at({0, 0, 0}), arm.at(0.0), "pin")) {
    model.connect(Drive{{Ramp{.target = angle, .duration = ramp}}, {}}, model.ground().at({0, 0, 0}), arm.at(0.0),
                  "drive");
    if (axial_force != 0.0)
      model.apply(PointForce<>{.force = {axial_force, 0, 0}, .axes = LoadAxes::marker}, arm.at(length), "tip force");
  }
};

// Beam that is clamped at the origin, with a moment about z [N m] at its tip.
template <class B>
struct Cantilever {
  using Clamp = Joint<planar::Weld, Constraint>;
  using Model = polybody::Model<Bodies<B>, Joints<Clamp>, Forces<PointMoment<>>>;

  Model model;
  BodyHandle<B> beam;

  Cantilever(Bar const& spec, Index elements, double moment)
      : beam(model.add(B::from(spec, {.elements = elements}), "beam")) {
    model.connect(Clamp{}, model.ground().at({0, 0, 0}), beam.at(0.0), "clamp");
    model.apply(PointMoment<>{.moment = {0, 0, moment}}, beam.at(double(spec.length)), "tip moment");
  }
};

}  // namespace chapter2
