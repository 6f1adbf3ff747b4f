// Adjoint gradients of runs with Runge–Kutta methods and Radau against their forward sensitivities.

#include <gtest/gtest.h>

#include <polybody/bodies/lrvf/lrvf.hpp>
#include <polybody/bodies/rigid/rigid.hpp>
#include <polybody/joints/policies/policy.hpp>

#include "support/rated_links.hpp"
#include "support/refusal.hpp"

using namespace polybody;

namespace gradient_stages_test {

TEST(GradientOfStages, RigidOnConstraintByRungeKuttaWithProjection) {
  for (double const held : {0.0, 1.0})
    expect_direct_derivatives(rated_links<Rigid<>, Constraint>(held), RungeKutta4<Projection>{}, 1e-11);
}
TEST(GradientOfStages, RigidOnConstraintByRungeKuttaWithBaumgarte) {
  expect_direct_derivatives(rated_links<Rigid<>, Constraint>(1.0),
                            RungeKutta4<Baumgarte>{.stabilisation = {.alpha = 20.0, .beta = 20.0}}, 1e-11);
}
TEST(GradientOfStages, RigidOnConstraintByDormandPrinceWithItsChoiceOfStepsFrozen) {
  expect_direct_derivatives(rated_links<Rigid<>, Constraint>(1.0),
                            DormandPrince<Projection>{.relative_tolerance = 1e-8, .absolute_tolerance = 1e-10}, 1e-11);
}

TEST(GradientOfStages, RigidOnConstraintByRadau) {
  expect_direct_derivatives(rated_links<Rigid<>, Constraint>(0.0), Radau{}, 1e-11);
  expect_direct_derivatives(rated_links<Rigid<>, Constraint>(1.0), Radau{}, 1e-10);
}
TEST(GradientOfStages, LrvfOnBushingByRadau) {
  expect_direct_derivatives(rated_links<Lrvf<>, Bushing>(0.0), Radau{}, 1e-11);
}

TEST(GradientOfStages, HasTheSameBitsWithFewSnapshots) {
  auto const make = rated_links<Rigid<>, Constraint>(1.0);
  DormandPrince<Projection> const exact{.relative_tolerance = 1e-12, .absolute_tolerance = 1e-14};
  GradientResult const by_radau = gradient(make, parameters_of_two_links, Radau{});
  for (std::size_t const snapshots : {2u, 5u}) {
    GradientResult const all = gradient(make, parameters_of_two_links, exact),
                         few = gradient(make, parameters_of_two_links, exact, {.snapshots = snapshots});
    EXPECT_EQ(few.value, all.value);
    EXPECT_EQ(few.derivatives, all.derivatives);
    EXPECT_GT(few.reversal.taken, all.reversal.taken);
    EXPECT_EQ(gradient(make, parameters_of_two_links, Radau{}, {.snapshots = snapshots}).derivatives,
              by_radau.derivatives);
  }
}

TEST(GradientOfStages, RefusesTimesThatEndItsSteps) {
  auto const said = [](auto const& change) {
    auto const make = [&](std::span<double const> p) {
      auto scenario = rated_links<Rigid<>, Constraint>(0.0)(p);
      change(scenario.options, p[0] / parameters_of_two_links[0].value);
      return scenario;
    };
    return refusal([&] { gradient(make, parameters_of_two_links, Radau{}); });
  };
  EXPECT_TRUE(has(said([](RunOptions& o, double) {
                    o.events = {{.name = "event", .value = [](State const& x) { return x.t - 0.01; }}};
                  }),
                  "gradient: runs with events or breakpoints need a method of the generalised-α family"));
  EXPECT_TRUE(
      has(said([](RunOptions& o, double p) { o.end_time = 0.05 * p; }), "gradient: runs whose start, end or steps"));
}

}  // namespace gradient_stages_test
