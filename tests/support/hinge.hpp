#pragma once
/// \file A body on a hinge, to which drives and springs are applied.

#include <polybody/bodies/rigid/rigid.hpp>
#include <polybody/joints/joint.hpp>
#include <polybody/joints/standard_joints.hpp>
#include <polybody/run/probe.hpp>
#include <polybody/run/simulate.hpp>

#include "support/held.hpp"

namespace polybody {

/// Body on a hinge about z at the origin, with inertia J about the hinge and centre of mass at (0, −l, 0).
template <class P, class... F>
struct Hinge {
  using Pin = Joint<Revolute, P>;
  Model<Bodies<Rigid<>>, Joints<Pin>, Forces<F...>> model{Gravity{0, -9.81, 0}};
  BodyHandle<Rigid<>> body;
  ElementHandle<Pin> pin;

  Hinge(double inertia, double mass = 1.0, double l = 0.0)
      : body(model.add(Rigid<>(mass, Mat3(Mat3::Identity() * (inertia - mass * l * l)), Placement::at({0, -l, 0})),
                       "arm")),
        pin(model.connect(Pin{Revolute{.axis = Vec3::UnitZ()}}, model.ground().at({0, 0, 0}), body.at({0, l, 0}),
                          "hinge")) {}
  double angle(State const& x) const { return joint_angle(model, x, pin); }
  /// State after `t` s, from rest.
  template <class I>
  State after(double t, I const& integrator, double h) const {
    State x = model.reference_state();
    simulate(model, x, integrator, {.end_time = t, .step = h}).run();
    return x;
  }
};

/// Claim of the cases of drives, by a closed form.
inline Claim by_formula(char const* what, char const* source, char const* formulation) {
  return {"drives", what, By::closed_form, source, formulation};
}

}  // namespace polybody
