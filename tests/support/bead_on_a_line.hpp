#pragma once
/// \file
/// A bead on a flexible line in the plane.

#include <polybody/bodies/ancf/planar_ancf_cable.hpp>
#include <polybody/bodies/rigid/planar_rigid.hpp>
#include <polybody/joints/driving_constraints.hpp>
#include <polybody/joints/planar/joints.hpp>
#include <polybody/joints/policies/policy.hpp>
#include <polybody/run/probe.hpp>
#include <polybody/run/sliders.hpp>

#include "support/solver_instances.hpp"

namespace polybody {

/// A line from the origin, pinned at its first end, with a sliding bead, or with a bead that is fixed to the point s
/// of the line.
struct BeadOnALine {
  using Line = planar::AncfCable<EngineeringStrain>;
  using Pin = Joint<planar::Revolute, Constraint>;
  using Motor = Joint<PrescribedRate<Constant>, Constraint>;
  using Plane = Model<Bodies<WithSliders<Line>, planar::Rigid>, Joints<Pin, Motor>>;

  Plane model;
  BodyHandle<WithSliders<Line>> line;
  BodyHandle<planar::Rigid> bead;
  ElementHandle<Pin> left, contact;

  BeadOnALine(Gravity const& gravity, Bar const& bar, Index elements, double mass, double s, bool slides = true)
      : model(gravity),
        line(
            model.add(WithSliders(Line::from(bar, elements), slides ? std::vector{s} : std::vector<double>{}), "line")),
        bead(model.add(
            planar::Rigid(mass, 1e-3 * mass, Placement{bar.placement.origin + s * bar.placement.axes.col(0)}), "bead")),
        left(model.connect(Pin{}, model.ground().at({0, 0, 0}), line.at(0.0), "left")),
        contact(model.connect(Pin{}, slides ? line.at(Slider{}) : line.at(s), bead.at({0, 0}), "contact")) {}
  ElementHandle<Pin> pin_right(Vec3 const& to) {
    return model.connect(Pin{}, model.ground().at(to), line.at(line.body().length()), "right");
  }
  /// For statics: the bead does not rotate, and its weight acts on the line from the beginning. Without a load the
  /// direction of sliding is undefined.
  State resting(double weight) {
    model.connect(Motor{{.law = {{.value = 0.0}}}, {}}, model.ground().at({0, 0, 0}), bead.at({0, 0}), "upright");
    State x = model.reference_state();
    x.lambda[model.entry(contact).row + 1] = -weight;
    return x;
  }
  Vec3 place_of_bead(State const& x) const { return position(model, x, bead.at({0, 0})); }
};

}  // namespace polybody
