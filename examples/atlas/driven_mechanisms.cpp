// Four-bar mechanism with a misaligned hinge (M1), and lateral buckling of a driven beam (M2).
#include <polybody/bodies/ffr/ffr.hpp>
#include <polybody/polybody.hpp>
#include <polybody/se3_beam.hpp>

#include "../support/buckling_beam.hpp"
#include "../support/misaligned_four_bar.hpp"
#include "problem.hpp"

namespace atlas {

namespace {

using namespace polybody::flexible;

// Mesh of a beam; of a floating frame: with the modes of the formulation, if it has any.
template <class B>
Mesh<B> mesh_of(FormulationMesh const& mesh) {
  return {"", [mesh](Bar const& bar, Index n) { return body_of<B>(bar, {.elements = n, .modes = mesh.modes}); }};
}

// The crank turns by −1.2 rad within 1 s, and stops. The output is the rise of the middle of BC.
template <class B>
AnyCase four_bar_of(FormulationMesh const& mesh) {
  Turn const turn{[](double t) {
                    double const w = 2.0 * std::numbers::pi, a = 1.2;  // −a (t − sin(wt)/w)
                    if (t >= 1.0) return Motion{-a, 0.0, 0.0};
                    return Motion{-a * (t - std::sin(w * t) / w), -a * (1.0 - std::cos(w * t)),
                                  -a * w * std::sin(w * t)};
                  },
                  {1.0}};
  FourBar<B> bars(mesh_of<B>(mesh), *mesh.elements, turn);
  auto const middle = bars.bc.at(0.12);
  using M = Mechanism<B>;
  return any_case(std::move(bars.model), [middle](M const& m, State const& x) { return position(m, x, middle)[2]; });
}

void add_four_bar(Formulations& to) {
  std::vector<double> const steps{0.1, 0.05, 0.025, 0.0125, 0.00625};
  char const* const small = "small deformation in a floating frame";
  to.add<Lrvf<>>("LRVF in space", "rigid sections", {{2, 4, 8, 16, 32}, steps}, four_bar_of<Lrvf<>>);
  to.add<Se3Beam>("SE(3) beam in space", "rigid sections", {{2, 4, 8, 16, 32}, steps}, four_bar_of<Se3Beam>);
  to.add<AncfBeam<ElasticLine>>("ANCF beam, elastic line", "deformable sections, elastic line", {{2, 4, 8, 16}, steps},
                                four_bar_of<AncfBeam<ElasticLine>>);
  to.add<Ffr>("FFR, nodal coordinates", small, {{1, 2, 4, 8}, steps}, four_bar_of<Ffr>);
  to.add<Ffr, MeshKind::modes>("FFR, modal coordinates", small, {{1, 2, 4}, steps}, four_bar_of<Ffr>, 4);
}

// Lateral displacement of the middle of the beam.
template <class B>
AnyCase buckling(FormulationMesh const& mesh) {
  Index const n = *mesh.elements;
  BucklingBeam<B> of(mesh_of<B>(mesh), n, n / 2, std::max<Index>(1, n / 4));
  auto const middle = of.beam.at(0.5);
  using M = Mechanism<B>;
  return any_case(std::move(of.model), [middle](M const& m, State const& x) { return position(m, x, middle)[1]; });
}

void add_buckling(Formulations& to) {
  std::vector<double> const steps{2e-3, 1e-3, 5e-4, 2.5e-4, 1.25e-4, 6.25e-5};
  char const* const small = "small deformation in a floating frame";
  to.add<Lrvf<>>("LRVF in space", "rigid sections", {{8, 16, 32, 64, 128}, steps}, buckling<Lrvf<>>);
  to.add<Se3Beam>("SE(3) beam in space", "rigid sections", {{8, 16, 32, 64, 128}, steps}, buckling<Se3Beam>);
  to.add<AncfBeam<ElasticLine>>("ANCF beam, elastic line", "deformable sections, elastic line",
                                {{4, 8, 16, 32, 64}, steps}, buckling<AncfBeam<ElasticLine>>);
  to.add<Ffr>("FFR, nodal coordinates", small, {{2, 4, 8, 16}, steps}, buckling<Ffr>);
}

char const* const no_torsion = "A cable has neither torsion nor a direction across its axis, which the hinges need.";

}  // namespace

Problem four_bar() {
  return {.name = "four_bar",
          .title = "Four-bar mechanism with a misaligned hinge",
          .text =
              "A steel four-bar mechanism has one hinge with an axis at 5° to the normal of its plane (Bauchau et al. "
              "2016, case M1 of [cases](../cases.md)).\nThe crank turns by 1.2 rad within 1 s, and the bars bend and "
              "twist.\nThe output is the rise of the middle of the coupler, from 0 to 1 s.",
          .question = {"rise of the coupler [m]", 1.0},
          .model = "rigid sections",
          .add = add_four_bar,
          .known = {{"rigid sections", -2.238402e-3, "static solution by shooting (M1)"}},
          .excluded = {{"ANCF cable, Green strain", no_torsion},
                       {"ANCF cable, engineering strain", no_torsion},
                       {"rigid body", "The mechanism of rigid bars is locked."}}};
}

Problem lateral_buckling() {
  return {
      .name = "lateral_buckling",
      .title = "Lateral buckling",
      .text =
          "A crank lifts the tip of a clamped strip of 1 m through a link, with an offset of 0.1 mm (Bauchau et al. "
          "2016, case M2 of [cases](../cases.md)).\nThe strip buckles sideways at about 0.14 s.\nThe output is "
          "the lateral displacement of its middle, from 0 to 0.2 s.",
      .question = {"middle y [m]", 0.2, 0.9},
      .model = "rigid sections",
      .add = add_buckling,
      .known = {{"rigid sections", -0.0330604, "spectral geometrically exact beams (M2)"}},
      .excluded = {{"ANCF cable, Green strain", no_torsion},
                   {"ANCF cable, engineering strain", no_torsion},
                   {"rigid body", "A rigid strip does not buckle, and the mechanism is locked."}}};
}

}  // namespace atlas
