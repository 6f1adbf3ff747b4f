// Adjoints of runs by Runge–Kutta methods beside their direct differentiation.
#include <polybody/gradients/runge_kutta_step_adjoint.hpp>
#include <polybody/gradients/runge_kutta_step_slope.hpp>

#include <gtest/gtest.h>

#include <polybody/bodies/ancf/ancf_cable.hpp>
#include <polybody/bodies/lrvf/lrvf.hpp>
#include <polybody/bodies/rigid/rigid.hpp>
#include <polybody/joints/policies/constraint.hpp>

#include "support/rated_links.hpp"

using namespace polybody;

namespace gradient_stages_test {

TEST(GradientOfStages, RigidOnConstraintByRungeKuttaWithProjection) {
  for (double const held : {0.0, 1.0})
    expect_direct_slopes(rated_links<Rigid<>, Constraint>(held), RungeKutta4<Projection>{}, 1e-11);
}
TEST(GradientOfStages, RigidOnConstraintByRungeKuttaWithBaumgarte) {
  expect_direct_slopes(rated_links<Rigid<>, Constraint>(1.0),
                       RungeKutta4<Baumgarte>{.stabilisation = {.alpha = 20.0, .beta = 20.0}}, 1e-11);
}
TEST(GradientOfStages, CableOnPenaltyByDormandPrinceWithItsChoiceOfStepsFrozen) {
  expect_direct_slopes(rated_links<AncfCable<>, Penalty>(1.0),
                       DormandPrince<Projection>{.relative_tolerance = 1e-6, .absolute_tolerance = 1e-8}, 1e-10);
}

TEST(GradientOfStages, HasTheSameBitsWithFewSnapshots) {
  auto const make = rated_links<Rigid<>, Constraint>(1.0);
  DormandPrince<Projection> const exact{.relative_tolerance = 1e-12, .absolute_tolerance = 1e-14};
  for (std::size_t const snapshots : {2u, 5u}) {
    Gradient const all = gradient(make, parameters_of_two_links, exact),
                   few = gradient(make, parameters_of_two_links, exact, {.snapshots = snapshots});
    EXPECT_EQ(few.value, all.value);
    EXPECT_EQ(few.slopes, all.slopes);
    EXPECT_GT(few.reversal.taken, all.reversal.taken);
  }
}

}  // namespace gradient_stages_test
