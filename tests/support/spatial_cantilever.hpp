#pragma once
/// \file A bar in space, clamped at its first end and loaded at the second, in static equilibrium: `Cantilever` with
/// a third dimension.

#include <polybody/forces/loads.hpp>
#include <polybody/joints/policies/policy.hpp>
#include <polybody/joints/standard_joints.hpp>
#include <polybody/run/probe.hpp>
#include <polybody/statics/equilibrium.hpp>

namespace polybody {

/// Loads at the tip; `axes` apply to both. A moment in world axes keeps its direction while the section rotates.
struct TipLoad {
  Vec3 force = Vec3::Zero();   ///< (3) [N]
  Vec3 moment = Vec3::Zero();  ///< (3) [N m]
  LoadAxes axes = LoadAxes::world;
  Gravity gravity = {};
};

/// The bar `body`, of one of the spatial formulations, in equilibrium under `load`.
template <class B>
struct SpatialCantilever {
  using Clamp = Joint<Weld, Constraint>;
  using ModelType = Model<Bodies<B>, Joints<Clamp>, Forces<PointForce<>, PointMoment<>>>;

  ModelType model;
  BodyHandle<B> bar;
  ElementHandle<Clamp> clamp;
  State x;
  EquilibriumReport report;

  SpatialCantilever(B const& body, TipLoad const& load, EquilibriumOptions const& options)
      : model(load.gravity),
        bar(model.add(body, "bar")),
        clamp(model.connect(Clamp{}, ground(body), bar.at(0.0), "clamp")) {
    if (!load.force.isZero(0.0)) model.apply(PointForce<>{.force = load.force, .axes = load.axes}, end());
    if (!load.moment.isZero(0.0)) model.apply(PointMoment<>{.moment = load.moment, .axes = load.axes}, end());
    x = model.reference_state();
    report = equilibrium(model, x, options);
  }

  std::span<double const> coordinates() const { return coordinates_of(model, x, bar); }
  Marker<B> end() const { return bar.at(bar.body().length()); }
  Frame<double> section(double s) const { return frame(model, x, bar.at(s)); }
  Vec3 tip() const { return position(model, x, end()); }
  Vec3 tip_displacement() const { return tip() - position(model, model.reference_state(), end()); }
  /// Rotation of the tip section from its reference axes to its current axes (world components).
  Mat3 tip_turn() const {
    return frame(model, x, end()).A * frame(model, model.reference_state(), end()).A.transpose();
  }

 private:
  auto ground(B const& body) const {
    std::vector<double> q(std::size_t(body.coordinates()));
    body.reference(q);
    return model.ground().at({q[0], q[1], q[2]});
  }
};

}  // namespace polybody
