// Derivatives of Radau steps against finite differences of the same steps.
#include <polybody/gradients/radau_derivatives.hpp>

#include <gtest/gtest.h>

#include "support/step_slopes.hpp"

using namespace polybody;

namespace radau_step_slope_test {

Radau const exact{.tolerance = 1e-13, .newton = {.max_iterations = 50, .budget = 0.0}};

template <class Make>
void expect_derivatives_of(Make const& make, std::vector<Parameter> const& parameters, double h) {
  for (int const steps : {1, 20})
    expect_derivatives_of_steps(derive_steps<RadauLinearisedStep<>>(make, parameters, exact, h, steps), parameters,
                                5e-9);
}
template <class B, class Policy>
void expect_derivatives(std::vector<Parameter> const& parameters, double h) {
  expect_derivatives_of(TwoLinks<B, Policy>{}, parameters, h);
}

TEST(RadauLinearisedStep, RigidOnConstraint) {
  expect_derivatives<Rigid<>, Constraint>(parameters_of_links(2e8, 1e6), 1e-2);
}
TEST(RadauLinearisedStep, CableOnPenalty) {
  expect_derivatives<AncfCable<>, Penalty>(parameters_of_links(2e8, 1e6), 5e-4);
}
TEST(RadauLinearisedStep, LrvfOnBushing) { expect_derivatives<Lrvf<>, Bushing>(parameters_of_links(2e7, 1e3), 1e-3); }
TEST(RadauLinearisedStep, DriveAndRowsThatRepeatOthers) {
  expect_derivatives_of(DrivenDoor{}, parameters_of_door, 1e-2);
}
TEST(RadauLinearisedStep, IsExactByTheLengthOfAStep) {
  expect_derivatives_by_length<RadauLinearisedStep<>>(TwoLinks<Lrvf<>, Bushing>{}, parameters_of_links(2e7, 1e3), exact,
                                                      1e-3, 1e-14);
  expect_derivatives_by_length<RadauLinearisedStep<>>(DrivenDoor{}, parameters_of_door, exact, 2e-2, 1e-14);
}
TEST(RadauLinearisedStep, HasTheOrderOfTheMethod) { expect_order_of_derivatives<RadauLinearisedStep<>>(exact, 10); }

}  // namespace radau_step_slope_test
