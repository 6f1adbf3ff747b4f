// The Princeton beam (S6) and the 45° bend of Bathe & Bolourchi (S7) under a force at the tip that grows slowly.
#include <polybody/bodies/ffr/ffr.hpp>
#include <polybody/polybody.hpp>
#include <polybody/se3_beam.hpp>

#include "../support/spatial_cantilevers.hpp"
#include "problem.hpp"

namespace atlas {

namespace {

// Position z of the tip of a clamped body under a force that grows to its full size within the time 2 `half`.
template <class B>
AnyCase loaded(B const& of, Vec3 const& force, double half) {
  using Clamp = Joint<Weld, Constraint>;
  using M = Model<Bodies<B>, Joints<Clamp>, Forces<PointForce<Ramp>>>;
  M model;
  auto const body = model.add(of, "beam");
  model.connect(Clamp{}, model.ground().at({0, 0, 0}), body.at(0.0), "clamp");
  auto const tip = body.at(body.body().length());
  model.apply(
      PointForce<Ramp>{.force = force, .law = {.target = 1.0, .duration = half, .start = 0.5 * half, .rounding = half}},
      tip, "force");
  return any_case(std::move(model), [tip](M const& m, State const& x) { return position(m, x, tip)[2]; });
}

template <class B>
AnyCase princeton(FormulationMesh const& mesh) {
  double const beta = std::numbers::pi / 3.0, force = 13.345;
  Bar const bar = spatial_cantilevers::princeton(0.11138, 1e-6);
  return loaded(body_of<B>(bar, mesh), force * Vec3(0, -std::cos(beta), std::sin(beta)), 1.5);
}
// The continuum integrates stresses over the section.
AnyCase solid_princeton(FormulationMesh const& mesh) {
  double const beta = std::numbers::pi / 3.0, force = 13.345;
  Bar const bar{.length = 0.508,
                .section = Rectangle{.height = 12.3777e-3, .width = 3.2024e-3},
                .material = Material{.density = 2810.0, .young = 71.7e9, .poisson = 0.31}};
  return loaded(body_of<AncfBeam<Continuum<>>>(bar, mesh), force * Vec3(0, -std::cos(beta), std::sin(beta)), 1.5);
}

void add_princeton(Formulations& to) {
  std::vector<double> const steps{4e-2, 2e-2, 1e-2, 5e-3, 2.5e-3, 1.25e-3};
  char const* const small = "small deformation in a floating frame";
  to.add<Lrvf<>>("LRVF in space", "rigid sections", {{4, 8, 16, 32, 64}, steps}, princeton<Lrvf<>>);
  to.add<Se3Beam>("SE(3) beam in space", "rigid sections", {{4, 8, 16, 32, 64}, steps}, princeton<Se3Beam>);
  to.add<AncfBeam<ElasticLine>>("ANCF beam, elastic line", "deformable sections, elastic line",
                                {{4, 8, 16, 32, 64}, steps}, princeton<AncfBeam<ElasticLine>>);
  to.add<AncfBeam<Continuum<>>>("ANCF beam, continuum", "deformable sections, continuum", {{4, 8, 16, 32, 64}, steps},
                                solid_princeton);
  to.add<Ffr>("FFR, nodal coordinates", small, {{2, 4, 8, 16}, steps}, princeton<Ffr>);
  to.add<Ffr, MeshKind::modes>("FFR, modal coordinates", small, {{1, 2, 8, 14}, steps}, princeton<Ffr>);
}

template <class B>
AnyCase bend(FormulationMesh const& mesh) {
  Bar const bar = spatial_cantilevers::bend_bar(5e6, 1e7 / 12);
  return loaded(B::from(bar, *mesh.elements, spatial_cantilevers::bend_curve), {0, 0, 600}, 180.0);
}
AnyCase solid_bend(FormulationMesh const& mesh) {
  Bar const bar{.length = spatial_cantilevers::bend_bar(1, 1).length,
                .section = Rectangle{.height = 1.0, .width = 1.0},
                .material = Material{.density = 1.0, .young = 1e7, .poisson = 0.0}};
  return loaded(AncfBeam<Continuum<>>::from(bar, *mesh.elements, spatial_cantilevers::bend_curve), {0, 0, 600}, 180.0);
}

void add_bend(Formulations& to) {
  std::vector<double> const steps{8.0, 4.0, 2.0, 1.0, 0.5, 0.25};
  to.add<Lrvf<>>("LRVF in space", "rigid sections", {{4, 8, 16, 32, 64}, steps}, bend<Lrvf<>>);
  to.add<Se3Beam>("SE(3) beam in space", "rigid sections", {{4, 8, 16, 32, 64}, steps}, bend<Se3Beam>);
  to.add<AncfBeam<ElasticLine>>("ANCF beam, elastic line", "deformable sections, elastic line",
                                {{4, 8, 16, 32, 64}, steps}, bend<AncfBeam<ElasticLine>>);
  to.add<AncfBeam<Continuum<>>>("ANCF beam, continuum", "deformable sections, continuum", {{4, 8, 16, 32, 64}, steps},
                                solid_bend);
}

char const* const no_torsion = "A cable has no torsion, on which this deformation depends.";
char const* const no_answer = "The beam of this problem only deforms. A rigid beam stays at rest.";

}  // namespace

Problem princeton_beam() {
  return {.name = "princeton_beam",
          .title = "Princeton beam",
          .text =
              "A force of 13.345 N acts at the tip of a clamped aluminium strip of 508 mm × 12.4 mm × 3.2 mm, at 60° "
              "to its stiff direction (Dowell & Traybar 1975, case S6 of [cases](../cases.md)).\nThe force grows "
              "within 3 s, about thirty periods of the lowest vibration.\nThe output is the position of the tip in the "
              "soft direction, from 0 to 3.2 s.",
          .question = {"tip z [m]", 3.2},
          .model = "rigid sections",
          .add = add_princeton,
          .known = {{"rigid sections", 0.182003786, "static solution by shooting (S6)"},
                    {"deformable sections, elastic line", 0.182003786, "static solution by shooting (S6)"}},
          .excluded = {{"ANCF cable, Green strain", no_torsion},
                       {"ANCF cable, engineering strain", no_torsion},
                       {"rigid body", no_answer}}};
}

Problem curved_cantilever() {
  char const* const curved = "The options of a floating frame from a bar describe a straight bar.";
  return {.name = "curved_cantilever",
          .title = "45° bend",
          .text =
              "A force of 600 N acts at the tip of a clamped arc of 45° with a radius of 100 m, across its plane "
              "(Bathe & Bolourchi 1979, case S7 of [cases](../cases.md)).\nThe section is 1 m × 1 m, E = 10⁷ Pa and "
              "ν = 0, and the mass per length is 1 kg/m.\nThe force grows within 360 s, about thirty periods of the "
              "lowest vibration.\nThe output is the displacement of the tip across the plane, from 0 to 380 s.",
          .question = {"tip z [m]", 380.0},
          .model = "rigid sections",
          .add = add_bend,
          .known = {{"rigid sections", 53.4748587918, "static solution by shooting (S7)"},
                    {"deformable sections, elastic line", 53.4748587918, "static solution by shooting (S7)"}},
          .excluded = {{"ANCF cable, Green strain", no_torsion},
                       {"ANCF cable, engineering strain", no_torsion},
                       {"FFR, nodal coordinates", curved},
                       {"FFR, modal coordinates", curved},
                       {"rigid body", no_answer}}};
}

}  // namespace atlas
