// Derivatives of steps of explicit Runge–Kutta methods against finite differences of the same steps.
#include <polybody/gradients/runge_kutta_step_slope.hpp>

#include <gtest/gtest.h>

#include "support/step_slopes.hpp"

using namespace polybody;

namespace runge_kutta_step_slope_test {

template <class Stabilisation>
RungeKutta4<Stabilisation> classical(Stabilisation const& s) {
  return {.stabilisation = s};
}
/// The tolerances are so wide that each step has the requested length.
template <class Stabilisation>
DormandPrince<Stabilisation> pair(Stabilisation const& s) {
  return {.relative_tolerance = 1.0, .absolute_tolerance = 1.0, .stabilisation = s};
}

template <class Make, class I>
void expect_slopes_of(Make const& make, std::vector<Parameter> const& parameters, I const& integrator, double h) {
  for (int const steps : {1, 20})
    expect_slopes_of_steps(derive_steps<RungeKuttaStepSlope<I>>(make, parameters, integrator, h, steps), parameters,
                           5e-10);
}
template <class B, class Policy, class I>
void expect_slopes(std::vector<Parameter> const& parameters, I const& integrator, double h) {
  expect_slopes_of(TwoLinks<B, Policy>{}, parameters, integrator, h);
}

TEST(RungeKuttaStepSlope, RigidOnConstraintByProjection) {
  auto const parameters = parameters_of_links(2e8, 1e6);
  expect_slopes<Rigid<>, Constraint>(parameters, classical(Projection{}), 5e-3);
  expect_slopes<Rigid<>, Constraint>(parameters, pair(Projection{}), 5e-3);
}
TEST(RungeKuttaStepSlope, RigidOnConstraintByBaumgarte) {
  expect_slopes<Rigid<>, Constraint>(parameters_of_links(2e8, 1e6), classical(Baumgarte{.alpha = 20.0, .beta = 30.0}),
                                     5e-3);
}
TEST(RungeKuttaStepSlope, RigidOnConstraintThatDrifts) {
  expect_slopes<Rigid<>, Constraint>(parameters_of_links(2e8, 1e6), pair(NoStabilisation{}), 5e-3);
}
TEST(RungeKuttaStepSlope, CableOnPenalty) {
  expect_slopes<AncfCable<>, Penalty>(parameters_of_links(2e8, 1e6), classical(WithoutRows{}), 1e-4);
}
TEST(RungeKuttaStepSlope, LrvfOnBushing) {
  expect_slopes<Lrvf<>, Bushing>(parameters_of_links(2e7, 1e3), pair(WithoutRows{}), 2e-5);
}
TEST(RungeKuttaStepSlope, DriveAndRowsThatRepeatOthers) {
  expect_slopes_of(DrivenDoor{}, parameters_of_door, classical(Projection{}), 5e-3);
}
TEST(RungeKuttaStepSlope, IsExactByTheLengthOfAStep) {
  auto const expect_by_length = []<class I>(auto const& make, auto const& parameters, I const& integrator, double h) {
    expect_slopes_by_length<RungeKuttaStepSlope<I>>(make, parameters, integrator, h, 1e-15);
  };
  auto const links = parameters_of_links(2e8, 1e6);
  expect_by_length(TwoLinks<Rigid<>, Constraint>{}, links, classical(Projection{}), 2e-2);
  expect_by_length(TwoLinks<Rigid<>, Constraint>{}, links, pair(Baumgarte{.alpha = 20.0, .beta = 30.0}), 2e-2);
  expect_by_length(DrivenDoor{}, parameters_of_door, classical(Projection{}), 2e-2);
  expect_by_length(DrivenDoor{}, parameters_of_door, pair(Projection{}), 2e-2);
}
TEST(RungeKuttaStepSlope, HasTheOrderOfTheMethod) {
  expect_order_of_slopes<RungeKuttaStepSlope<RungeKutta4<>>>(classical(WithoutRows{}), 50);
  expect_order_of_slopes<RungeKuttaStepSlope<DormandPrince<>>>(pair(WithoutRows{}), 25);
}

}  // namespace runge_kutta_step_slope_test
