// The very flexible pendulum (D6a), a cable whose bending stiffness is negligible.
#include <polybody/polybody.hpp>
#include <polybody/se3_beam.hpp>

#include "../support/spinning_pendulum.hpp"
#include "problem.hpp"

namespace atlas {

namespace {

// Position y of the tip.
template <class B>
AnyCase pendulum(FormulationMesh const& mesh) {
  using Ball = Joint<Spherical, Constraint>;
  using M = Model<Bodies<B>, Joints<Ball>>;
  M model{Gravity{0, -9.81, 0}};
  auto const rod = model.add(body_of<B>(polybody::spinning_pendulum::bar(), mesh), "rod");
  auto const tip = rod.at(1.0);
  model.connect(Ball{}, model.ground().at({0, 0, 0}), rod.at(0.0), "hinge");
  State start = model.reference_state();
  model.set_velocity(start, rod, HasRigidLayout<B> ? Vec3(0, 0, -2) : Vec3(0, 0, 0), Vec3(0, 4, 0));
  return any_case(std::move(model), [tip](M const& m, State const& x) { return position(m, x, tip)[1]; }, start);
}

void add(Formulations& to) {
  std::vector<double> const steps{1.6e-2, 8e-3, 4e-3, 2e-3, 1e-3, 5e-4};
  std::vector<Index> const cubic{4, 8, 16, 32, 64}, linear{8, 16, 32, 64, 128};
  using Green = AncfCable<GreenStrain>;
  using Engineering = AncfCable<EngineeringStrain>;
  to.add<Rigid<>, MeshKind::none>("rigid body", "rigid bar", {{}, steps}, pendulum<Rigid<>>);
  to.add<Green>("ANCF cable, Green strain", "cable, Green strain", {cubic, steps}, pendulum<Green>);
  to.add<Engineering>("ANCF cable, engineering strain", "cable, engineering strain", {cubic, steps},
                      pendulum<Engineering>);
  to.add<Lrvf<>>("LRVF in space", "rigid sections", {linear, steps}, pendulum<Lrvf<>>);
  to.add<Se3Beam>("SE(3) beam in space", "rigid sections", {linear, steps}, pendulum<Se3Beam>);
  to.add<AncfBeam<ElasticLine>>("ANCF beam, elastic line", "deformable sections, elastic line", {cubic, steps},
                                pendulum<AncfBeam<ElasticLine>>);
}

}  // namespace

Problem spinning_pendulum() {
  char const* const linear = "The deformation is far beyond the range of a linear structure in a floating frame.";
  return {.name = "spinning_pendulum",
          .title = "Very flexible pendulum",
          .text =
              "A cable of 1 m hangs on a ball joint and starts horizontally, with a spin of 4 rad/s about the vertical "
              "(Gerstmayr's pendulum, case D6a of [cases](../cases.md)).\nThe output is the height of the tip, from "
              "0 to 0.5 s.",
          .question = {"tip y [m]", 0.5, 0.9},
          .model = "cable, engineering strain",
          .add = add,
          .known = {{"rigid sections", -0.710316, "spectral geometrically exact beam (D6a)"},
                    {"cable, engineering strain", -0.710316, "spectral geometrically exact beam (D6a)"}},
          .excluded = {{"FFR, nodal coordinates", linear}, {"FFR, modal coordinates", linear}}};
}

}  // namespace atlas
