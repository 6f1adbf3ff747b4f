#pragma once
/// \file A planar bar, clamped at its first end, loaded at the second and by gravity, in static equilibrium. It is
/// the model of the static reference cases.

#include <polybody/forces/loads.hpp>
#include <polybody/joints/planar/joints.hpp>
#include <polybody/joints/policies/policy.hpp>
#include <polybody/run/probe.hpp>
#include <polybody/statics/equilibrium.hpp>

namespace polybody {

/// Loads of the cantilever.
struct CantileverLoad {
  Vec2 force = Vec2::Zero();  ///< (2) at the tip [N]
  LoadAxes axes = LoadAxes::world;
  double moment = 0.0;  ///< at the tip [N m]
  Gravity gravity = {};
};

/// The bar `body`, of one of the planar formulations, in equilibrium under `load`.
template <class B>
struct Cantilever {
  using Clamp = Joint<planar::Weld, Constraint>;
  using ModelType = Model<Bodies<B>, Joints<Clamp>, Forces<PointForce<>, PointMoment<>>>;

  ModelType model;
  BodyHandle<B> bar;
  ElementHandle<Clamp> clamp;
  State x;
  EquilibriumReport report;

  Cantilever(B const& body, CantileverLoad const& load, EquilibriumOptions const& options)
      : model(load.gravity),
        bar(model.add(body, "bar")),
        clamp(model.connect(Clamp{}, ground(body), bar.at(0.0), "clamp")) {
    auto const end = bar.at(body.length());
    if (!load.force.isZero(0.0))
      model.apply(PointForce<>{.force = {load.force[0], load.force[1], 0}, .axes = load.axes}, end);
    if (load.moment != 0.0) model.apply(PointMoment<>{.moment = {0, 0, load.moment}}, end);
    x = model.reference_state();
    report = equilibrium(model, x, options);
  }

  /// Position and angle of the section at `s` from the clamp; the angle of `Lrvf` counts full turns.
  Vec3 at(double s) const { return section(x, s); }
  Vec3 tip() const { return at(bar.body().length()); }
  Vec3 tip_displacement() const { return tip() - section(model.reference_state(), bar.body().length()); }

 private:
  Vec3 section(State const& y, double s) const {
    auto const line = bar.body().template centre_line<double>(bar.body().at(s), coordinates_of(model, y, bar),
                                                              velocities_of(model, y, bar));
    return {line.r[0], line.r[1], line.angle};
  }
  auto ground(B const& body) const {
    std::vector<double> q(std::size_t(body.coordinates()));
    body.reference(q);
    return model.ground().at({q[0], q[1], 0});
  }
};

}  // namespace polybody
