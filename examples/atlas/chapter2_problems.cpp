// The arm and the cantilever of Chapter 2 of the thesis, by the combinations of the programs robot_arm and cantilever.
#include <polybody/bodies/ffr/planar_ffr.hpp>

#include "../chapter2_formulations.hpp"
#include "problem.hpp"

namespace atlas {

namespace {

using chapter2::BodyOnPolicy;
using chapter2::Mechanism;

struct OfBody {
  void (*add)(Formulations&, chapter2::Problem const&, OfBody const&);
  std::vector<BodyOnPolicy> (*bodies)(Mechanism);
  std::string body;  // its name in --body
  std::string name;  // its name in the atlas
  Settings settings;
};

template <class B, MeshKind kind = MeshKind::elements>
void add_body(Formulations& to, chapter2::Problem const& problem, OfBody const& one) {
  for (BodyOnPolicy const& on : one.bodies(problem.mechanism))
    if (on.body.name == one.body && on.policy == "constraint")
      to.add<B, kind>(one.name, on.body.model, one.settings, [problem, make = on.make](FormulationMesh const& mesh) {
        chapter2::AnyMechanism const made = make(problem.setup, mesh);
        return AnyCase{made.model,
                       [tip = made.tip, of = problem.output_value](State const& x) { return of(x.t, tip(x)); },
                       made.model.reference_state()};
      });
}

void add_bodies(Formulations& to, chapter2::Problem const& problem, std::vector<OfBody> const& all) {
  for (OfBody const& one : all) one.add(to, problem, one);
}

// The sudden loads of both problems excite vibrations that only short steps resolve.
std::vector<double> const steps{4e-2, 2e-2, 1e-2, 5e-3, 2.5e-3, 1.25e-3, 6.25e-4, 3.125e-4, 1.5625e-4};

// Bodies with their meshes. The spatial bodies have coarser meshes.
std::vector<OfBody> bodies(std::vector<Index> const& lrvf) {
  using namespace chapter2;
  std::vector<Index> const cubic{2, 4, 8, 16, 32, 64};
  std::vector<double> const few(steps.begin(), steps.begin() + 4);  // these deformations are beyond a floating frame
  return {
      {add_body<planar::Lrvf>, lrvf_beams, "lrvf", "LRVF in the plane", {lrvf, steps}},
      {add_body<planar::AncfCable<>>, green_cables, "ancf", "ANCF cable, Green strain", {cubic, steps}},
      {add_body<planar::AncfCable<EngineeringStrain>>,
       engineering_cables,
       "ancf-engineering",
       "ANCF cable, engineering strain",
       {cubic, steps}},
      {add_body<planar::Ffr>, floating_frames, "ffr", "FFR, nodal coordinates", {{2, 4, 8, 16, 32}, few}},
      {add_body<planar::Ffr, MeshKind::modes>,
       floating_frames,
       "ffr-modal",
       "FFR, modal coordinates",
       {{1, 2, 4, 8}, few}},
      {add_body<Lrvf<>>, spatial_lrvf_beams, "lrvf-space", "LRVF in space", {{5, 10, 20, 40, 80, 160}, steps}},
      {add_body<AncfBeam<>>, elastic_line_beams, "ancf-beam", "ANCF beam, elastic line", {{4, 8, 16, 32, 64}, steps}},
      {add_body<AncfBeam<Continuum<>>>,
       continuum_beams,
       "ancf-beam-continuum",
       "ANCF beam, continuum",
       {{4, 8, 16, 32, 64}, steps}}};
}

}  // namespace

Problem robot_arm() {
  double const ramp = 4.5, end_time = 6.75;
  chapter2::Problem const arm{
      .mechanism = Mechanism::arm,
      .motion = "arm driven by 1.5 rad in 4.5 s",
      .setup = {.stiffness = chapter2::medium, .ramp = ramp},
      .end_time = end_time,
      .output = "lag of the tip [m]",
      .output_value = [=](double t, Vec3 const& tip) { return chapter2::lag_of(t, tip, ramp); }};
  return {.name = "robot_arm",
          .title = "Robot arm of the thesis",
          .text =
              "A flexible arm of 10 m turns on a pin by 1.5 rad within 4.5 s (thesis, Chapter 2, medium stiffness, "
              "density 7850 kg/m³).\nThe output is the distance of the tip behind the rigid arm, from 0 to 6.75 s.",
          .question = {arm.output, end_time},
          .model = "rigid sections",
          .add = [arm](Formulations& to) { add_bodies(to, arm, bodies({5, 10, 20, 40, 80, 160, 320})); },
          .excluded = {{"rigid body", "A rigid arm has no lag. The difference from it is the output."}}};
}

Problem cantilever() {
  double const end_time = 4.0;
  chapter2::Problem const beam{.mechanism = Mechanism::cantilever,
                               .motion = "clamped beam, 30 kN m at its tip",
                               .setup = {.stiffness = chapter2::low},
                               .end_time = end_time,
                               .output = "tip x [m]",
                               .output_value = [](double, Vec3 const& tip) { return tip[0]; }};
  return {
      .name = "cantilever",
      .title = "Cantilever with tip moment",
      .text =
          "A moment of 30 kN m acts suddenly at the tip of a clamped beam of 10 m (thesis, Figure 2.9, low "
          "stiffness, density 7850 kg/m³).\nThe output is the position of the tip along the beam, from 0 to "
          "4 s.",
      .question = {beam.output, end_time},
      .model = "rigid sections",
      .add = [beam](Formulations& to) { add_bodies(to, beam, bodies({5, 10, 20, 40, 80, 160, 320})); },
      .excluded = {{"rigid body", "The tip of a rigid beam stays at 10 m. The difference from it is the deflection."}}};
}

}  // namespace atlas
