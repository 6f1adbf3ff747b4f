// Derivatives of runs in joint coordinates with multi-stage methods.

#include <gtest/gtest.h>

#include "support/carried_arm.hpp"
#include "support/impacts_of_whole_states.hpp"
#include "support/slopes_of_runs.hpp"

using namespace polybody;

namespace joint_coordinates_stages_test {

template <class Policy, CarriedArm what, class I>
void expect_derivatives(I const& integrator) {
  auto parameters = parameters_of_carried_arm;
  parameters.pop_back();
  auto const make = carried_arm<Policy, what>(2e-3);
  expect_derivatives_of_runs(make, parameters, integrator, 1e-8);
  expect_derivatives_backwards(make, parameters, integrator, 1e-11);
}

TEST(JointCoordinatesInStages, ByRungeKutta) {
  expect_derivatives<JointCoordinates, CarriedArm{}>(RungeKutta4<>{});
  expect_derivatives<JointCoordinatesBy<joint_coordinates::ArticulatedBody>, CarriedArm{}>(RungeKutta4<>{});
}
TEST(JointCoordinatesInStages, ByRungeKuttaWithProjectionOfARowThatStays) {
  expect_derivatives<JointCoordinates, CarriedArm{.loop = true}>(RungeKutta4<Projection>{});
}
TEST(JointCoordinatesInStages, ByRadau) {
  expect_derivatives<JointCoordinates, CarriedArm{}>(Radau{});
  expect_derivatives<JointCoordinates, CarriedArm{.loop = true}>(Radau{});
}
TEST(JointCoordinatesInStages, OfAThreadAndOfWhatAnEventDoes) {
  expect_derivatives_of_nut(RungeKutta4<>{});
  expect_derivatives_of_nut(DormandPrince<>{});
  expect_derivatives_of_nut(Radau{});
}

}  // namespace joint_coordinates_stages_test
