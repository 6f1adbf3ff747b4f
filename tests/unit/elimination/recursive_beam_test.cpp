// Beams whose nodes are bodies of a tree of joint coordinates, against the same models with multipliers.
#include <gtest/gtest.h>

#include <polybody/bodies/lrvf/lrvf.hpp>
#include <polybody/bodies/lrvf/planar_lrvf.hpp>
#include <polybody/bodies/se3/planar_se3_beam.hpp>
#include <polybody/bodies/se3/se3_beam.hpp>
#include <polybody/integrators/generalised_alpha.hpp>

#include "support/flexible_trees.hpp"
#include "support/refusal.hpp"

using namespace polybody;

namespace recursive_beam_test {

using namespace flexible_trees;

TEST(RecursiveBeams, TreesInSpaceAccelerateAsWithMultipliers) {
  expect_as_multipliers<InSpace, Se3Beam, JointCoordinates>("Se3Beam in space");
}
TEST(RecursiveBeams, TreesInThePlaneAccelerateAsWithMultipliers) {
  expect_as_multipliers<InPlane, planar::Lrvf, JointCoordinates>("Lrvf in the plane");
  expect_as_multipliers<InPlane, planar::Se3Beam, JointCoordinates>("Se3Beam in the plane");
}

/// Beam on a pin of the ground with a rigid body on a ball at its tip. It begins with a spin of 15 rad/s about the pin,
/// so that it passes more than a full turn.
template <class Beam, class Policy>
struct Spinner {
  Model<Bodies<Beam, Rigid<>>, Joints<Joint<Revolute, Policy>, Joint<Spherical, Policy>>> model{Gravity{0, 0, -9.81}};
  BodyHandle<Rigid<>> load;
  State x;

  Spinner() {
    auto const beam = model.add(bent<Beam>(bar, 1));
    load =
        model.add(Rigid<>({.mass = 0.2, .inertia = 1e-3 * Mat3::Identity(), .placement = Placement::at({0.6, 0, 0})}));
    model.connect(Joint<Revolute, Policy>{{.axis = Vec3(0.0, 0.6, 0.8)}, {}}, model.ground().at({0, 0, 0}),
                  beam.at(0.0));
    model.connect(Joint<Spherical, Policy>{}, beam.at(0.5), load.at({-0.1, 0, 0}));
    x = model.reference_state();
    model.set_velocity(x, beam, Vec3::Zero(), Vec3(0.0, 9.0, 12.0));
    model.set_velocity(x, load, Vec3::Zero(), Vec3(0.0, 9.0, 12.0));
  }
};

/// The policies enforce the same equations, so that steps of both differ by the error of the integrator at most, of
/// second order.
template <class Beam>
void expect_steps_as_with_multipliers() {
  auto const load = [](auto policy, double h) {
    Spinner<Beam, decltype(policy)> spinner;
    simulate(spinner.model, spinner.x, GeneralisedAlpha{.rho_inf = 0.6, .tolerance = 1e-9},
             {.end_time = 0.5, .step = h})
        .run();
    return position(spinner.model, spinner.x, spinner.load.centre());
  };
  double const coarse = (load(JointCoordinates{}, 1e-3) - load(Constraint{}, 1e-3)).norm(),
               fine = (load(JointCoordinates{}, 5e-4) - load(Constraint{}, 5e-4)).norm();
  EXPECT_LT(coarse, 2e-5);
  EXPECT_NEAR(std::log2(coarse / fine), 2.0, 0.1);
}

TEST(RecursiveBeams, StepsOfSe3BeamAreThoseWithMultipliers) { expect_steps_as_with_multipliers<Se3Beam>(); }
TEST(RecursiveBeams, StepsOfLrvfAreThoseWithMultipliers) { expect_steps_as_with_multipliers<Lrvf<>>(); }

TEST(RecursiveBeams, AMarkerBetweenNodesIsRefused) {
  using Pin = Joint<Revolute, JointCoordinates>;
  Model<Bodies<Se3Beam>, Joints<Pin>> model;
  auto const beam = model.add(bent<Se3Beam>(bar, 1));
  EXPECT_EQ(
      refusal([&] { model.connect(Pin{{.axis = {0, 0, 1}}, {}}, model.ground().at({0, 0, 0}), beam.at(0.3), "pin"); }),
      "\"pin\" has joint coordinates, but its marker is between two nodes of the beam, in element 2. Use a mesh "
      "with a node at this point, or the policy Constraint.");
}

}  // namespace recursive_beam_test
