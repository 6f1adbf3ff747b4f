#pragma once
// Two beams in space that are clamped at one end, in static equilibrium, for a beam with a position mesh and a rotation
// mesh.
//   helix  The bar of Chapter 2 with low stiffness and GJ = EI. A moment M = 3 pi EI/L and a torque pi EI/L act at the
//          tip. The forces are zero, so that the strains Gamma are zero. With w = sqrt(10) pi/L the curve is a helix
//          about the axis (1, 0, 3).
//   bend   The 45 degree bend of Bathe & Bolourchi, a curved bar under 600 N across its plane (case S7).
#include <numbers>

#include "chapter2_meshes.hpp"
#include "support/spatial_cantilevers.hpp"

namespace chapter2 {

template <class B>
struct SpatialBeam {
  using Clamp = Joint<Weld, Constraint>;
  using Model = polybody::Model<Bodies<B>, Joints<Clamp>, Forces<PointForce<>, PointMoment<>>>;

  Model model;
  BodyHandle<B> beam;
  State x;

  SpatialBeam(B const& body, Vec3 const& force, Vec3 const& moment, int load_steps) : beam(model.add(body, "beam")) {
    model.connect(Clamp{}, model.ground().at({0, 0, 0}), beam.at(0.0), "clamp");
    Marker<B> const tip = beam.at(body.length());
    model.apply(PointForce<>{.force = force}, tip, "force");
    model.apply(PointMoment<>{.moment = moment}, tip, "moment");
    x = model.reference_state();
    equilibrium(model, x, {.load_steps = load_steps});
  }
  Gap<3> gap() const { return gap_of_meshes(beam.body(), coordinates_of(model, x, beam)); }
};

inline Vec3 const helix_turn(std::numbers::pi, 0.0, 3.0 * std::numbers::pi);  // rotation of the tip [rad]

template <class B>
SpatialBeam<B> helix(Index elements) {
  Bar spec = bar(low, 7850.0);
  spec.constants->GJ = low.EI;
  return {B::from(spec, elements), Vec3::Zero(), low.EI / length * helix_turn, 10};
}
template <class B>
SpatialBeam<B> bend(Index elements) {
  Bar const spec = spatial_cantilevers::bend_bar(5e6, 1e7 / 12);
  return {B::from(spec, elements, spatial_cantilevers::bend_curve), {0.0, 0.0, 600.0}, Vec3::Zero(), 2};
}

}  // namespace chapter2
