// Derivatives of Radau steps against finite differences of the same steps.
#include <polybody/gradients/radau_step_slope.hpp>

#include <gtest/gtest.h>

#include "support/step_slopes.hpp"

using namespace polybody;

namespace radau_step_slope_test {

Radau const exact{.tolerance = 1e-13, .newton = {.max_iterations = 50, .budget = 0.0}};

template <class Make>
void expect_slopes_of(Make const& make, std::vector<Parameter> const& parameters, double h) {
  for (int const steps : {1, 20})
    expect_slopes_of_steps(derive_steps<RadauStepSlope<>>(make, parameters, exact, h, steps), parameters, 5e-9);
}
template <class B, class Policy>
void expect_slopes(std::vector<Parameter> const& parameters, double h) {
  expect_slopes_of(TwoLinks<B, Policy>{}, parameters, h);
}

TEST(RadauStepSlope, RigidOnConstraint) { expect_slopes<Rigid<>, Constraint>(parameters_of_links(2e8, 1e6), 1e-2); }
TEST(RadauStepSlope, CableOnPenalty) { expect_slopes<AncfCable<>, Penalty>(parameters_of_links(2e8, 1e6), 5e-4); }
TEST(RadauStepSlope, LrvfOnBushing) { expect_slopes<Lrvf<>, Bushing>(parameters_of_links(2e7, 1e3), 1e-3); }
TEST(RadauStepSlope, DriveAndRowsThatRepeatOthers) { expect_slopes_of(DrivenDoor{}, parameters_of_door, 1e-2); }
TEST(RadauStepSlope, IsExactByTheLengthOfAStep) {
  expect_slopes_by_length<RadauStepSlope<>>(TwoLinks<Lrvf<>, Bushing>{}, parameters_of_links(2e7, 1e3), exact, 1e-3,
                                            1e-14);
  expect_slopes_by_length<RadauStepSlope<>>(DrivenDoor{}, parameters_of_door, exact, 2e-2, 1e-14);
}
TEST(RadauStepSlope, HasTheOrderOfTheMethod) { expect_order_of_slopes<RadauStepSlope<>>(exact, 10); }

}  // namespace radau_step_slope_test
