// Derivatives of runs in joint coordinates.
#include <polybody/gradients/gradient.hpp>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <polybody/bodies/ffr/planar_ffr.hpp>
#include <polybody/bodies/rigid/planar_rigid.hpp>
#include <polybody/gradients/sensitivities.hpp>
#include <polybody/integrators/generalised_alpha.hpp>
#include <polybody/joints/planar/joints.hpp>

#include "support/carried_arm.hpp"
#include "support/impacts_of_whole_states.hpp"
#include "support/slopes_of_runs.hpp"

using namespace polybody;

namespace joint_coordinates_test {

GeneralisedAlpha const integrator{.rho_inf = 0.7};

template <class Policy, CarriedArm what>
void expect_derivatives() {
  auto parameters = parameters_of_carried_arm;
  if (!what.flexible) parameters.pop_back();
  auto const make = carried_arm<Policy, what>(2e-3);
  // the force in the rod contains the round-off of the constraint equations over βh²; differences of runs divide it
  // by the change of the parameter
  expect_derivatives_of_runs(make, parameters, integrator, what.loop ? 1e-7 : 1e-8);
  expect_derivatives_backwards(make, parameters, integrator, 1e-11);
}

TEST(JointCoordinatesUnderParameters, OfATreeInTheAugmentedSystem) {
  expect_derivatives<JointCoordinates, CarriedArm{}>();
  expect_derivatives<JointCoordinates, CarriedArm{.loop = true}>();
}
TEST(JointCoordinatesUnderParameters, OfATreeBodyByBody) {
  expect_derivatives<JointCoordinatesBy<joint_coordinates::ArticulatedBody>, CarriedArm{}>();
  expect_derivatives<JointCoordinatesBy<joint_coordinates::ArticulatedBody>, CarriedArm{.loop = true}>();
}
TEST(JointCoordinatesUnderParameters, OfATreeWithABeamThatFloatsOnAFrame) {
  expect_derivatives<JointCoordinates, CarriedArm{.flexible = true}>();
}

/// In the plane: a beam on a pin with a slider at its end, and two bodies on a pin that fly. Parameters: Young's
/// modulus, position of the slider, a mass, a spin.
auto const in_the_plane = [](std::span<double const> p) {
  using Turn = Joint<planar::Revolute, JointCoordinates>;
  using Slide = Joint<planar::Prismatic, JointCoordinates>;
  using M = Model<Bodies<planar::Rigid, planar::Ffr>, Joints<Turn, Slide>>;
  M model{Gravity{0, -9.81, 0}};
  auto const slider = model.add(planar::Rigid(p[2], 0.01, Placement::planar(0.6, p[1], 0.2)), "slider");
  Vec2 const end_of_beam = Eigen::Rotation2D(-0.2) * Vec2(-0.1, -p[1]);  // in axes of the slider
  auto const beam = model.add(planar::Ffr::from({.length = 0.5,
                                                 .section = Rectangle{.height = 0.01, .width = 0.01},
                                                 .material = Material{.density = 2000.0, .young = p[0], .poisson = 0.3},
                                                 .placement = Placement::at({0, 0, 0})},
                                                2),
                              "beam");
  Vec2 const end_of_first = Vec2(2.0, 0.0) + Eigen::Rotation2D(3.0) * Vec2(-0.3, -0.05);
  auto const first = model.add(planar::Rigid(1.0, 0.02, Placement::planar(2.0, 0, 3.0)), "first");
  auto const second =
      model.add(planar::Rigid(p[2], 0.02, Placement::planar(end_of_first[0] + 0.2, end_of_first[1])), "second");
  model.connect(Turn{}, model.ground().at({0, 0, 0}), beam.at(0.0), "pin");
  model.connect(Slide{{.axis = Vec3::UnitX()}}, beam.at(0.5), slider.at(end_of_beam), "slide");
  model.connect(Turn{}, second.at(Vec2(-0.2, 0.0)), first.at(Vec2(-0.3, -0.05)), "flying pin");
  State start = model.reference_state();
  System const system(model, with<Capabilities::rigid_velocities>);
  system.operations().rigid_velocities(start.q, Vec3::Zero(), {0, 0, p[3]}, start.v);
  start.v[8] += 1.0;  // velocity of the second flying body
  auto const end = [slider, second](auto const& m, auto const& x) {
    auto const a = position(m, x, slider.at(Vec2(0.05, 0.02))), b = position(m, x, second.at(Vec2(0.0, 0.1)));
    auto sum = a[0] + 2.0 * a[1] + b[0] - b[1];
    for (Index i = 0; i < x.v.size(); ++i) sum += 0.002 * double(i + 1) * x.v[i];
    return sum;
  };
  auto const way = [second](auto const& m, auto const& x) { return position(m, x, second.at(Vec2(0.0, 0.1)))[1]; };
  std::vector<Output<M>> outputs{{"end [1]", end}, {"way [1]", way}};
  return with_objective(Scenario<M>{std::move(model), start, {.end_time = 0.1, .step = 2e-3}, std::move(outputs)}, end,
                        way);
};
TEST(JointCoordinatesUnderParameters, InThePlane) {
  std::vector<Parameter> const parameters{
      {"young [Pa]", 1e9}, {"place [m]", 0.1}, {"mass [kg]", 0.2}, {"spin [rad/s]", 3.0}};
  expect_derivatives_of_runs(in_the_plane, parameters, integrator,
                             1e-7);  // tolerance for a beam that swings many times
  expect_derivatives_backwards(in_the_plane, parameters, integrator, 1e-11);
}

TEST(JointCoordinatesUnderParameters, OfAThreadAndOfWhatAnEventDoes) { expect_derivatives_of_nut(integrator); }

TEST(JointCoordinatesUnderParameters, ApproachSlopesOnRowsAtSecondOrder) {
  auto parameters = parameters_of_carried_arm;
  parameters.pop_back();
  auto const apart = [&](double h) {
    MatX const free = sensitivities(carried_arm<JointCoordinates, CarriedArm{}>(h), parameters, integrator)
                          .derivatives.back(),
               on_rows =
                   sensitivities(carried_arm<Constraint, CarriedArm{}>(h), parameters, integrator).derivatives.back();
    double most = 0.0;
    for (Index j = 0; j < free.cols(); ++j)
      most = std::max(most, parameters[std::size_t(j)].size() * (free - on_rows).col(j).head(3).norm());
    return most;
  };
  double const coarse = apart(4e-3), fine = apart(2e-3);
  EXPECT_LT(fine, 1e-3);
  EXPECT_NEAR(coarse / fine, 4.0, 1.0);
}

}  // namespace joint_coordinates_test
