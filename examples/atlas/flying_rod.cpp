// Flexible rod in free flight through space (D4).
#include <polybody/bodies/ffr/ffr.hpp>
#include <polybody/bodies/lrvf/director_interpolation.hpp>
#include <polybody/polybody.hpp>
#include <polybody/se3_beam.hpp>

#include "../support/flying_rod.hpp"
#include "problem.hpp"

namespace atlas {

namespace {

using polybody::flying_rod::Triangle;

// Position z of the loaded end.
template <class B>
AnyCase flight(FormulationMesh const& mesh) {
  using M = Model<Bodies<B>, Joints<>, Forces<PointForce<Triangle>, PointMoment<Triangle>>>;
  M model;
  auto const body = model.add(body_of<B>(polybody::flying_rod::rod(), mesh), "rod");
  auto const end = body.at(0.0);
  model.apply(PointForce<Triangle>{.force = {20, 0, 0}}, end, "force");
  model.apply(PointMoment<Triangle>{.moment = {0, -100, -200}}, end, "moment");
  return any_case(std::move(model), [end](M const& m, State const& x) { return position(m, x, end)[2]; });
}

void add(Formulations& to) {
  std::vector<double> const steps{0.08, 0.04, 0.02, 0.01, 0.005, 0.0025};
  std::vector<Index> const linear{8, 16, 32, 64, 128};
  char const* const small = "small deformation in a floating frame";
  to.add<Rigid<>, MeshKind::none>("rigid body", "rigid bar", {{}, steps}, flight<Rigid<>>);
  to.add<Lrvf<>>("LRVF in space", "rigid sections", {linear, steps}, flight<Lrvf<>>);
  to.add<Lrvf<Directors>>("LRVF in space, directors", "rigid sections", {linear, steps}, flight<Lrvf<Directors>>);
  to.add<Se3Beam>("SE(3) beam in space", "rigid sections", {linear, steps}, flight<Se3Beam>);
  to.add<AncfBeam<ElasticLine>>("ANCF beam, elastic line", "deformable sections, elastic line",
                                {{4, 8, 16, 32, 64}, steps}, flight<AncfBeam<ElasticLine>>);
  to.add<Ffr>("FFR, nodal coordinates", small, {{2, 4, 8, 16}, steps}, flight<Ffr>);
  to.add<Ffr, MeshKind::modes>("FFR, modal coordinates", small, {{1, 2, 4, 8}, steps}, flight<Ffr>);
}

}  // namespace

Problem flying_rod() {
  char const* const inertia = "A cable has no rotary inertia and no torsion, which are as important as bending here.";
  return {.name = "flying_rod",
          .title = "Flying rod in space",
          .text =
              "A force and a moment act for 5 s at one end of a free rod of 10 m (case D4 of [cases](../cases.md))."
              "\nThe output is the position z of the loaded end, from 0 to 7.5 s.",
          .question = {"loaded end z [m]", 7.5, 0.9},
          .model = "rigid sections",
          .add = add,
          .known = {{"rigid sections", -3.582269, "spectral geometrically exact beam (D4)"}},
          .excluded = {
              {"ANCF cable, Green strain", inertia},
              {"ANCF cable, engineering strain", inertia},
              {"ANCF beam, continuum", "The stiffnesses and the inertia of the rod do not belong to any section."}}};
}

}  // namespace atlas
