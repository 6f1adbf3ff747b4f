// Derivatives of runs with multi-stage methods against finite differences of the same runs.
#include <polybody/gradients/sensitivities.hpp>

#include <gtest/gtest.h>

#include <polybody/bodies/lrvf/lrvf.hpp>
#include <polybody/bodies/rigid/rigid.hpp>
#include <polybody/integrators/radau.hpp>
#include <polybody/joints/policies/policy.hpp>

#include "support/differences_of_runs.hpp"
#include "support/refusal.hpp"
#include "support/touched_chain.hpp"
#include "support/two_links.hpp"

using namespace polybody;

namespace sensitivities_stages_test {

/// The outputs at the end of a run with these steps.
template <class Make, class I>
VecX end_of_steps(Make const& make, std::span<double const> p, I const& integrator, std::vector<double> const& times) {
  auto scenario = make(p);
  System system = system_for<I>(scenario.model);
  auto const method = method_of(integrator);
  auto work = method.template workspace<DefaultSolver>(system);
  State x = scenario.start;
  work.forward.project_velocities(system, x.q, x.v, x.t);
  method.start(system, x, times[1] - times[0], work);
  for (std::size_t n = 1; n < times.size(); ++n) {
    double const h = times[n] - times[n - 1];
    EXPECT_EQ(method.step(system, x, h, work).taken, h);
    x.t = times[n];
  }
  return detail::values_of_outputs(scenario, x);
}
/// Fourth-order finite differences of runs whose steps have the same lengths.
template <class Make, class I>
MatX by_frozen_differences(Make const& make, std::vector<Parameter> const& parameters, I const& integrator,
                           std::vector<double> const& times) {
  MatX out;
  for (std::size_t j = 0; j < parameters.size(); ++j) {
    VecX sum;
    for (std::size_t k = 0; k < 4; ++k) {
      std::vector<double> p = detail::values_of(parameters);
      double const e = 1e-3 * parameters[j].size();
      p[j] += FourPoints::places[k] * e;
      VecX const of = FourPoints::weights[k] / e * end_of_steps(make, p, integrator, times);
      sum = k == 0 ? of : VecX(sum + of);
    }
    out.conservativeResize(sum.size(), Index(j + 1));
    out.col(Index(j)) = sum;
  }
  return out;
}

void expect_near(MatX const& derivatives, MatX const& expected, std::vector<Parameter> const& parameters) {
  for (Index j = 0; j < expected.cols(); ++j)
    EXPECT_LT((derivatives.col(j) - expected.col(j)).norm(),
              1e-7 * (expected.col(j).norm() + 1e-4 / parameters[std::size_t(j)].size()))
        << parameters[std::size_t(j)].name << ": " << derivatives.col(j).transpose() << " for "
        << expected.col(j).transpose();
}

TEST(SensitivitiesOfStages, RigidOnConstraintByRungeKuttaWithProjection) {
  auto const& parameters = parameters_of_two_links;
  RungeKutta4<Projection> const integrator;
  SensitivityResult const s = sensitivities(two_links<Rigid<>, Constraint>, parameters, integrator);
  ASSERT_EQ(s.times.size(), 31u);
  expect_near(s.derivatives.back(), by_differences(two_links<Rigid<>, Constraint>, parameters, integrator), parameters);
  // rigid rods do not depend on Young's modulus, ideal pins do not depend on a stiffness
  EXPECT_EQ(s.run.warnings.size(), 2u);
}
TEST(SensitivitiesOfStages, LrvfOnBushingByRadau) {
  auto const& parameters = parameters_of_two_links;
  SensitivityResult const s = sensitivities(two_links<Lrvf<>, Bushing>, parameters, Radau{});
  EXPECT_LT(s.left, 1e-9);
  expect_near(s.derivatives.back(), by_differences(two_links<Lrvf<>, Bushing>, parameters, Radau{}), parameters);
}
TEST(SensitivitiesOfStages, RigidOnConstraintByDormandPrinceWithItsChoiceOfStepsFrozen) {
  auto const& parameters = parameters_of_two_links;
  DormandPrince<Projection> integrator{.relative_tolerance = 1e-8, .absolute_tolerance = 1e-10};
  auto const make = two_links<Rigid<>, Constraint>;
  SensitivityResult const s = sensitivities(make, parameters, integrator);
  double const first = s.times[1] - s.times[0], last = s.times.back() - s.times[s.times.size() - 2];
  EXPECT_GT(std::abs(first - last), 1e-3 * first);  // the method chose the step length
  integrator.relative_tolerance = integrator.absolute_tolerance = 1e6;
  expect_near(s.derivatives.back(), by_frozen_differences(make, parameters, integrator, s.times), parameters);
}

TEST(SensitivitiesOfStages, AreTheSameWhereParametersSayWhatTheyTouch) {
  touched_chain::expect_same_derivatives_with_affects(RungeKutta4<>{});
  touched_chain::expect_same_derivatives_with_affects(Radau{});
}
TEST(SensitivitiesOfStages, RefuseParametersThatTouchMoreThanTheySay) {
  auto parameters = touched_chain::of_chain(true);
  parameters[5].affects = {"rod 0"};
  auto const run = [&] { sensitivities(touched_chain::chain_with_angle, parameters, RungeKutta4<>{}); };
  EXPECT_TRUE(has(refusal(run), "\"stiffness 1 [N/m]\" changes the equations of body \"rod 1\""));
}

}  // namespace sensitivities_stages_test
