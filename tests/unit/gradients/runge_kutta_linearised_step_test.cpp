// Derivatives of steps of explicit Runge–Kutta methods against finite differences of the same steps.
#include <polybody/gradients/runge_kutta_derivatives.hpp>

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
void expect_derivatives_of(Make const& make, std::vector<Parameter> const& parameters, I const& integrator, double h) {
  for (int const steps : {1, 20})
    expect_derivatives_of_steps(derive_steps<RungeKuttaLinearisedStep<I>>(make, parameters, integrator, h, steps),
                                parameters, 5e-10);
}
template <class B, class Policy, class I>
void expect_derivatives(std::vector<Parameter> const& parameters, I const& integrator, double h) {
  expect_derivatives_of(TwoLinks<B, Policy>{}, parameters, integrator, h);
}

TEST(RungeKuttaLinearisedStep, RigidOnConstraintByProjection) {
  auto const parameters = parameters_of_links(2e8, 1e6);
  expect_derivatives<Rigid<>, Constraint>(parameters, classical(Projection{}), 5e-3);
  expect_derivatives<Rigid<>, Constraint>(parameters, pair(Projection{}), 5e-3);
}
TEST(RungeKuttaLinearisedStep, RigidOnConstraintByBaumgarte) {
  expect_derivatives<Rigid<>, Constraint>(parameters_of_links(2e8, 1e6),
                                          classical(Baumgarte{.alpha = 20.0, .beta = 30.0}), 5e-3);
}
TEST(RungeKuttaLinearisedStep, RigidOnConstraintThatDrifts) {
  expect_derivatives<Rigid<>, Constraint>(parameters_of_links(2e8, 1e6), pair(NoStabilisation{}), 5e-3);
}
TEST(RungeKuttaLinearisedStep, CableOnPenalty) {
  expect_derivatives<AncfCable<>, Penalty>(parameters_of_links(2e8, 1e6), classical(UnconstrainedOnly{}), 1e-4);
}
TEST(RungeKuttaLinearisedStep, LrvfOnBushing) {
  expect_derivatives<Lrvf<>, Bushing>(parameters_of_links(2e7, 1e3), pair(UnconstrainedOnly{}), 2e-5);
}
TEST(RungeKuttaLinearisedStep, DriveAndRowsThatRepeatOthers) {
  expect_derivatives_of(DrivenDoor{}, parameters_of_door, classical(Projection{}), 5e-3);
}
TEST(RungeKuttaLinearisedStep, IsExactByTheLengthOfAStep) {
  auto const expect_by_length = []<class I>(auto const& make, auto const& parameters, I const& integrator, double h) {
    expect_derivatives_by_length<RungeKuttaLinearisedStep<I>>(make, parameters, integrator, h, 1e-15);
  };
  auto const links = parameters_of_links(2e8, 1e6);
  expect_by_length(TwoLinks<Rigid<>, Constraint>{}, links, classical(Projection{}), 2e-2);
  expect_by_length(TwoLinks<Rigid<>, Constraint>{}, links, pair(Baumgarte{.alpha = 20.0, .beta = 30.0}), 2e-2);
  expect_by_length(DrivenDoor{}, parameters_of_door, classical(Projection{}), 2e-2);
  expect_by_length(DrivenDoor{}, parameters_of_door, pair(Projection{}), 2e-2);
}
TEST(RungeKuttaLinearisedStep, HasTheOrderOfTheMethod) {
  expect_order_of_derivatives<RungeKuttaLinearisedStep<RungeKutta4<>>>(classical(UnconstrainedOnly{}), 50);
  expect_order_of_derivatives<RungeKuttaLinearisedStep<DormandPrince<>>>(pair(UnconstrainedOnly{}), 25);
}

}  // namespace runge_kutta_step_slope_test
