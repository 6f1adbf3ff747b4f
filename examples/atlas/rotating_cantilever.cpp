// Spin-up of a cantilever (D2): geometric stiffening by the axial force of the rotation.
#include <polybody/bodies/ffr/planar_ffr.hpp>
#include <polybody/polybody.hpp>
#include <polybody/se3_beam.hpp>

#include "../support/spin_up_arm.hpp"
#include "problem.hpp"

namespace atlas {

namespace {

template <class B>
using PinOf = Joint<std::conditional_t<B::world == World::plane, planar::Revolute, Revolute>, Constraint>;

template <class B>
PinOf<B> pin_of() {
  if constexpr (B::world == World::plane)
    return {};
  else
    return {Revolute{.axis = Vec3::UnitZ()}, {}};
}

// Displacement of the tip across the rotating axis.
template <class B>
AnyCase arm(FormulationMesh const& mesh) {
  using M = Model<Bodies<B>, Joints<PinOf<B>, spin_up::Drive>>;
  M model;
  auto const ground = model.ground().at({0, 0, 0});
  auto const body = model.add(body_of<B>(spin_up::arm(), mesh), "arm");
  model.connect(pin_of<B>(), ground, body.at(0.0), "pin");
  model.connect(spin_up::drive(), ground, body.at(0.0), "drive");
  auto const tip = body.at(10.0);
  return any_case(std::move(model), [tip](M const& m, State const& x) {
    double const psi = spin_up::drive().geometry.law(x.t).value;
    Vec3 const r = position(m, x, tip);
    return std::cos(psi) * r[1] - std::sin(psi) * r[0];
  });
}

void add(Formulations& to) {
  // Steps of 0.04 s excite vibrations of beams whose result depends on round-off. Floating frames stay smooth.
  std::vector<double> const steps{0.02, 0.01, 0.005, 0.0025}, of_frames{0.04, 0.02, 0.01, 0.005, 0.0025};
  std::vector<Index> const cubic{2, 4, 8, 16, 32}, linear{5, 10, 20, 40, 80, 160};
  to.add<planar::Lrvf>("LRVF in the plane", "rigid sections", {linear, steps}, arm<planar::Lrvf>);
  to.add<planar::Se3Beam>("SE(3) beam in the plane", "rigid sections", {linear, steps}, arm<planar::Se3Beam>);
  to.add<planar::AncfCable<planar::GreenStrain>>("ANCF cable, Green strain", "cable, Green strain", {cubic, steps},
                                                 arm<planar::AncfCable<planar::GreenStrain>>);
  to.add<planar::AncfCable<planar::EngineeringStrain>>("ANCF cable, engineering strain", "cable, engineering strain",
                                                       {cubic, steps},
                                                       arm<planar::AncfCable<planar::EngineeringStrain>>);
  char const* const small = "small deformation in a floating frame";
  to.add<planar::Ffr>("FFR, nodal coordinates", small, {cubic, of_frames}, arm<planar::Ffr>);
  to.add<planar::Ffr, MeshKind::modes>("FFR, modal coordinates", small, {{1, 2, 4, 8}, of_frames}, arm<planar::Ffr>);
  to.add<Lrvf<>>("LRVF in space", "rigid sections", {{5, 10, 20, 40, 80}, steps}, arm<Lrvf<>>);
  to.add<Se3Beam>("SE(3) beam in space", "rigid sections", {{5, 10, 20, 40, 80}, steps}, arm<Se3Beam>);
  to.add<AncfBeam<ElasticLine>>("ANCF beam, elastic line", "deformable sections, elastic line",
                                {{4, 8, 16, 32, 64}, steps}, arm<AncfBeam<ElasticLine>>);
}

}  // namespace

Problem rotating_cantilever() {
  return {
      .name = "rotating_cantilever",
      .title = "Rotating cantilever",
      .text =
          "A beam of 10 m turns about its clamped end, from rest to 6 rad/s within 15 s (Kane, Ryan & Banerjee "
          "1987, case D2 of [cases](../cases.md)).\nThe axial force of the rotation stiffens the beam, whose "
          "first frequency at rest is below the final speed.\nThe output is the displacement of the tip across "
          "the rotating axis, from 0 to 15 s.",
      .question = {"tip across the axis [m]", 15.0, 0.9},
      .model = "rigid sections",
      .add = add,
      .known = {{"rigid sections", 1.30362629e-3, "spectral geometrically exact beam (D2)"}},
      .excluded = {{"rigid body", "The tip of a rigid beam stays on the axis. The difference from it is the output."}}};
}

}  // namespace atlas
