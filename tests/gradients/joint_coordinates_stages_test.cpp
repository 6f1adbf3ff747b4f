// Derivatives of runs in joint coordinates with multi-stage methods.
#include <polybody/gradients/radau_step_adjoint.hpp>
#include <polybody/gradients/radau_step_slope.hpp>
#include <polybody/gradients/runge_kutta_step_adjoint.hpp>
#include <polybody/gradients/runge_kutta_step_slope.hpp>

#include <gtest/gtest.h>

#include "support/carried_arm.hpp"
#include "support/impacts_of_whole_states.hpp"
#include "support/slopes_of_runs.hpp"

using namespace polybody;

namespace joint_coordinates_stages_test {

template <class Policy, CarriedArm what, class I>
void expect_slopes(I const& integrator) {
  auto parameters = parameters_of_carried_arm;
  parameters.pop_back();
  auto const make = carried_arm<Policy, what>(2e-3);
  expect_slopes_of_runs(make, parameters, integrator, 1e-8);
  expect_slopes_backwards(make, parameters, integrator, 1e-11);
}

TEST(JointCoordinatesInStages, ByRungeKutta) {
  expect_slopes<Recursive, CarriedArm{}>(RungeKutta4<>{});
  expect_slopes<RecursiveBy<recursive::ArticulatedBody>, CarriedArm{}>(RungeKutta4<>{});
}
TEST(JointCoordinatesInStages, ByRungeKuttaWithProjectionOfARowThatStays) {
  expect_slopes<Recursive, CarriedArm{.loop = true}>(RungeKutta4<Projection>{});
}
TEST(JointCoordinatesInStages, ByRadau) {
  expect_slopes<Recursive, CarriedArm{}>(Radau{});
  expect_slopes<RecursiveBy<recursive::Reduced>, CarriedArm{.loop = true}>(Radau{});
  expect_slopes<Recursive, CarriedArm{.loop = true}>(Radau{});
}
TEST(JointCoordinatesInStages, OfAThreadAndOfWhatAnEventDoes) {
  expect_slopes_of_nut(RungeKutta4<>{});
  expect_slopes_of_nut(DormandPrince<>{});
  expect_slopes_of_nut(Radau{});
}

}  // namespace joint_coordinates_stages_test
