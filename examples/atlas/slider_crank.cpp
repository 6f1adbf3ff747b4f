// Slider-crank with a flexible coupler (D8), in the plane and in space.
#include <polybody/bodies/ffr/ffr.hpp>
#include <polybody/bodies/ffr/planar_ffr.hpp>
#include <polybody/se3_beam.hpp>

#include "../support/flexible_slider_crank.hpp"

#include "problem.hpp"

namespace atlas {

namespace {

// The case with its deflection in metres.
template <class M>
AnyCase deflection(Scenario<M> scenario) {
  auto const bend = scenario.outputs[1].value;
  return any_case(std::move(scenario.model), [bend](M const& m, State const& x) { return 1e-3 * bend(m, x); });
}
template <class B>
AnyCase in_plane(FormulationMesh const& mesh) {
  return deflection(polybody::slider_crank::in_the_plane(Formulation<B, Constraint, GeneralisedAlpha>{.mesh = mesh}));
}
template <class B>
AnyCase in_space(FormulationMesh const& mesh) {
  return deflection(polybody::slider_crank::in_space(Formulation<B, Constraint, GeneralisedAlpha>{.mesh = mesh}));
}

void add(Formulations& to) {
  std::vector<double> const steps{2e-3, 1e-3, 5e-4, 2.5e-4, 1.25e-4, 6.25e-5};
  std::vector<Index> const cubic{2, 4, 8, 16}, linear{4, 8, 16, 32, 64};
  using Green = planar::AncfCable<planar::GreenStrain>;
  using Engineering = planar::AncfCable<planar::EngineeringStrain>;
  char const* const small = "small deformation in a floating frame";
  to.add<planar::Lrvf>("LRVF in the plane", "rigid sections", {linear, steps}, in_plane<planar::Lrvf>);
  to.add<planar::Se3Beam>("SE(3) beam in the plane", "rigid sections", {linear, steps}, in_plane<planar::Se3Beam>);
  to.add<Green>("ANCF cable, Green strain", "cable, Green strain", {cubic, steps}, in_plane<Green>);
  to.add<Engineering>("ANCF cable, engineering strain", "cable, engineering strain", {cubic, steps},
                      in_plane<Engineering>);
  to.add<planar::Ffr>("FFR, nodal coordinates", small, {cubic, steps}, in_plane<planar::Ffr>);
  to.add<planar::Ffr, MeshKind::modes>("FFR, modal coordinates", small, {{1, 3, 5, 7}, steps}, in_plane<planar::Ffr>);
  to.add<Lrvf<>>("LRVF in space", "rigid sections", {linear, steps}, in_space<Lrvf<>>);
  to.add<Se3Beam>("SE(3) beam in space", "rigid sections", {linear, steps}, in_space<Se3Beam>);
  to.add<AncfBeam<ElasticLine>>("ANCF beam, elastic line", "deformable sections, elastic line",
                                {{2, 4, 8, 16, 32}, steps}, in_space<AncfBeam<ElasticLine>>);
  to.add<Ffr, MeshKind::modes>("FFR in space, modal coordinates", small, {{1, 3, 5, 7}, steps}, in_space<Ffr>);
}

}  // namespace

Problem slider_crank() {
  return {.name = "slider_crank",
          .title = "Flexible slider-crank",
          .text =
              "A crank of 0.1 m reaches 150 rad/s within 0.1 s and drives a slider of 0.5 kg through a steel "
              "coupler of "
              "0.4 m (case D8 of [cases](../cases.md)).\nThe slider loads the coupler with up to 0.3 of its Euler "
              "load.\nThe output is the deflection of the middle of the coupler from its chord, from 0 to 0.1 s.",
          .question = {"deflection [m]", 0.1},
          .model = "rigid sections",
          .add = add,
          .known = {{"rigid sections", 5.4199e-3, "chain of rigid segments (D8)"},
                    {"small deformation in a floating frame", 5.4199e-3, "chain of rigid segments (D8)"}},
          .excluded = {{"rigid body", "A rigid coupler has no deflection. The difference from it is the output."}}};
}

}  // namespace atlas
