#pragma once
/// \file One model in space and one in the plane with all kinds of parts. They have bodies of several kinds, joints
/// with constraint equations, compliant joints, springs, dead and follower loads, and the ground. The state satisfies
/// no equations.

#include <polybody/bodies/ancf/planar_ancf_cable.hpp>
#include <polybody/bodies/lrvf/planar_lrvf.hpp>
#include <polybody/bodies/rigid/planar_rigid.hpp>
#include <polybody/bodies/rigid/rigid.hpp>
#include <polybody/forces/loads.hpp>
#include <polybody/forces/springs.hpp>
#include <polybody/joints/driving_constraints.hpp>
#include <polybody/joints/planar/joints.hpp>
#include <polybody/joints/policies/bushing.hpp>
#include <polybody/joints/standard_joints.hpp>
#include <polybody/system/system.hpp>
#include <polybody/testing/differences.hpp>

namespace polybody {

/// Two rigid bodies: ground –Revolute, Constraint– a –Spherical, Penalty– b, a spring, a dead load on a and a
/// follower load on b. `damping` is that of the penalty joint and of the spring.
struct MixedSpace {
  using Pin = Joint<Revolute, Constraint>;
  using Ball = Joint<Spherical, Penalty>;
  using M = Model<Bodies<Rigid<>>, Joints<Pin, Ball>, Forces<SpringDamper, PointForce<>>>;

  static M model(double damping) {
    M model{Gravity{0.5, -1.0, -9.81}};
    Bar const bar{.length = 1.2,
                  .constants = BarConstants{.EA = 1, .EI = 1, .mass_per_length = 2.0, .rotary_inertia = 0.05},
                  .placement = Placement::at({0.1, 0.2, 0.3}, {0.5, -0.4, 1.0})};
    Mat3 inertia;
    inertia << 0.3, 0.02, -0.01, 0.02, 0.4, 0.03, -0.01, 0.03, 0.5;
    auto const a = model.add(Rigid<>::from(bar), "a");
    auto const b = model.add(Rigid<>(3.0, inertia, Placement::at({0.9, 0.1, -0.2}, {-1, 0.3, 0.2})), "b");
    auto const ground = model.ground();
    model.connect(Ball{Spherical{}, Penalty{.stiffness = 70.0, .damping = damping}}, a.at(1.2, 0.1),
                  b.at(Vec3(-0.2, 0.1, 0.3)), "ball");
    model.connect(Pin{Revolute{.axis = Vec3(1, 2, -2) / 3.0}, Constraint{}},
                  ground.at(Placement::at({0, 0, 0.1}, {0.2, 0.1, 0})), a.at(0.0, 0.0, 0.05), "pin");
    model.apply(SpringDamper{.stiffness = 40.0, .damping = damping, .free_length = 0.6}, a.at(0.3),
                b.at(Vec3(0.4, 0, 0)), "strut");
    model.apply(SpringDamper{.stiffness = 25.0, .free_length = 0.0}, b.at(Vec3(0, 0.2, 0)), ground.at({1, 1, 0}),
                "rope");
    model.apply(PointForce<>{.force = {1, 2, -3}}, a.at(0.9, 0.02, 0.1), "dead");
    model.apply(PointForce<>{.force = {-2, 1, 0.5}, .axes = LoadAxes::marker}, b.at(Vec3(0.1, 0.2, 0.3)), "follower");
    return model;
  }
};

/// Two rigid bodies: ground –Revolute, Bushing– a –Spherical, Constraint– b –Prismatic, NonlinearBushing– ground, with
/// markers apart. `damping` is that of both bushings.
struct MixedBushings {
  using Ball = Joint<Spherical, Constraint>;
  using Pin = Joint<Revolute, Bushing>;
  using Slide =
      Joint<Prismatic, NonlinearBushing<TabulatedLaw, LinearLaw, LinearLaw, LinearLaw, LinearLaw, TabulatedLaw>>;
  using M = Model<Bodies<Rigid<>>, Joints<Pin, Ball, Slide>>;

  static M model(double damping) {
    M model{Gravity{0.5, -1.0, -9.81}};
    Mat3 inertia;
    inertia << 0.3, 0.02, -0.01, 0.02, 0.4, 0.03, -0.01, 0.03, 0.5;
    auto const a = model.add(Rigid<>(2.0, inertia, Placement::at({0.1, 0.2, 0.3}, {0.5, -0.4, 1.0})), "a");
    auto const b = model.add(Rigid<>(3.0, inertia, Placement::at({0.9, 0.1, -0.2}, {-1, 0.3, 0.2})), "b");
    Bushing::Matrix k = Bushing::diagonal({50, 60, 70}, {20, 30, 40});
    for (int i = 0; i < 5; ++i) k(i, i + 1) = k(i + 1, i) = 3.0 * (i - 2.5);
    model.connect(Pin{Revolute{.axis = Vec3(1, 2, -2) / 3.0}, Bushing{.stiffness = k, .damping = damping * k / 60.0}},
                  model.ground().at(Placement::at({0, 0, 0.1}, {0.2, 0.1, 0})), a.at(Vec3(-0.2, 0.1, 0.3)), "pin");
    model.connect(Ball{}, a.at(Vec3(0.3, 0.2, 0.1)), b.at(Vec3(-0.1, 0.2, 0)), "ball");
    MonotoneTable const table{{{-1.0, -30.0}, {-0.3, -20.0}, {0.4, 10.0}, {1.5, 40.0}}};
    LinearLaw const law{.stiffness = 25.0, .damping = 0.1 * damping};
    TabulatedLaw const tabled{table, damping};
    model.connect(Slide{{.axis = Vec3::UnitX()}, {tabled, law, law, law, law, tabled}}, b.at(Vec3(0.4, 0, 0)),
                  model.ground().at({1, 1, 0}), "slide");
    return model;
  }
};

/// A rigid body, a geometrically exact beam and a cable: ground –Revolute and a drive– body –Weld, Constraint–
/// beam –Weld, Penalty– cable, a spring, a moment in the middle of the cable.
struct MixedPlane {
  using Pin = Joint<planar::Revolute, Constraint>;
  using Fixed = Joint<planar::Weld, Constraint>;
  using Glue = Joint<planar::Weld, Penalty>;
  using Drive = Joint<PrescribedAngle<SmoothRamp>, Constraint>;
  using M = Model<Bodies<planar::Rigid, planar::Lrvf, planar::AncfCable<>>, Joints<Pin, Fixed, Glue, Drive>,
                  Forces<PointMoment<>, SpringDamper>>;

  static M model(double damping) {
    M model{Gravity{0.3, -9.81, 0}};
    Bar bar{.length = 1.0,
            .constants = BarConstants{.EA = 90, .EI = 4, .mass_per_length = 2.0, .GA = 30, .rotary_inertia = 0.05},
            .placement = Placement::planar(0.2, 0.1, 0.5),
            .damping = {.axial = 0.01, .shear = 0.02, .bending = 0.03}};
    auto const cable = model.add(planar::AncfCable<>::from(bar, 2), "cable");
    bar.placement = Placement::planar(0.7, 0.4, -0.6);
    auto const beam = model.add(planar::Lrvf::from(bar, 2), "beam");
    auto const body = model.add(planar::Rigid(2.0, 0.3, Placement::planar(-0.3, 0.2, 1.0)), "body");
    auto const ground = model.ground();
    model.connect(Fixed{}, body.at(Vec2(0.3, -0.1)), beam.at(0.3, 0.05), "fixed");
    model.connect(Drive{{.law = {.target = 1.1, .duration = 4.0}}, {}}, ground.at({0, 0, 0}), body.at(Vec2(0, 0)),
                  "drive");
    model.connect(Glue{planar::Weld{}, Penalty{.stiffness = 50.0, .damping = damping}}, beam.at(0.8),
                  cable.at(0.1, -0.04), "glue");
    model.connect(Pin{}, ground.at({0.1, -0.2, 0}), body.at(Vec2(-0.2, 0.1)), "pin");
    model.apply(PointMoment<>{.moment = {0, 0, 2.5}}, cable.at(0.7), "moment");
    model.apply(SpringDamper{.stiffness = 40.0, .damping = damping, .free_length = 0.6}, cable.at(1.0),
                body.at(Vec2(0.1, 0.2)), "strut");
    return model;
  }
};

/// A force along the line between two markers with two first-order states. The states enter it as a product. They
/// depend on the positions of the markers and, by `damping`, on their velocities.
struct LaggingPull {
  static constexpr int markers = 2, states = 2;
  static constexpr bool is_load = true;
  static constexpr MarkerKind needs = MarkerKind::point;

  double damping = 0.0;

  void check(std::string const&) const {}
  template <StateScalar T>
  std::array<Wrench<T>, 2> wrenches(std::array<Frame<T>, 2> const& f, std::array<T, 2> const& z, double t) const {
    T const pull = z[0] * (z[1] + 1.0) * 5.0 + 1000.0 * t;
    std::array<Wrench<T>, 2> w;
    for (int i = 0; i < 3; ++i) {
      w[0].f[i] = (f[1].r[i] - f[0].r[i]) * pull;
      w[1].f[i] = -w[0].f[i];
    }
    return w;
  }
  template <StateScalar T>
  std::array<T, 2> rates(std::array<Frame<T>, 2> const& f, std::array<T, 2> const& z, double t) const {
    Vec<T, 3> const d = f[1].r - f[0].r, v = f[1].v - f[0].v;
    return {d.dot(d) * 3.0 - z[0] * z[1] + t, d.dot(v) * damping - z[1] * 4.0 + z[0]};
  }
  std::array<double, 2> initial_states() const { return {0.25, -0.5}; }
};

/// A rigid body on a pin and a cable in the plane, and forces with first-order states between them and the ground.
struct MixedStates {
  using Pin = Joint<planar::Revolute, Constraint>;
  using M = Model<Bodies<planar::Rigid, planar::AncfCable<>>, Joints<Pin>, Forces<LaggingPull, PointForce<>>>;

  static M model(double damping) {
    M model{Gravity{0.3, -9.81, 0}};
    Bar const bar{.length = 1.0,
                  .constants = BarConstants{.EA = 90, .EI = 4, .mass_per_length = 2.0},
                  .placement = Placement::planar(0.2, 0.1, 0.5)};
    auto const cable = model.add(planar::AncfCable<>::from(bar, 2), "cable");
    auto const ground = model.ground();
    model.apply(LaggingPull{damping}, cable.at(0.9), ground.at({1.0, 0.5, 0}), "rope");
    auto const body = model.add(planar::Rigid(2.0, 0.3, Placement::planar(-0.3, 0.2, 1.0)), "body");
    model.apply(LaggingPull{damping}, body.at(Vec2(1.5, 2.0)), cable.at(0.3), "tie");
    model.apply(PointForce<>{.force = {1, 2, 0}, .axes = LoadAxes::marker}, cable.at(0.7), "follower");
    model.connect(Pin{}, ground.at({0.1, -0.2, 0}), body.at(Vec2(-0.2, 0.1)), "pin");
    return model;
  }
};

/// A state away from the reference: coordinates, velocities, accelerations, multipliers, t = 1.3.
template <class M>
State scrambled(M const& model, unsigned seed = 1) {
  laws::Numbers number(seed);
  State x = model.reference_state();
  VecX q = x.q;
  System(model).plus(q, number.vector(model.velocities(), 0.4), x.q);
  x.v = number.vector(model.velocities());
  x.a = number.vector(model.velocities(), 2.0);
  x.lambda = number.vector(model.rows(), 5.0);
  x.t = 1.3;
  return x;
}

}  // namespace polybody
