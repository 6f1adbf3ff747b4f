// Derivatives of runs whose steps solve the islands of the model apart.
#include <gtest/gtest.h>

#include <polybody/bodies/rigid/rigid.hpp>
#include <polybody/forces/contact.hpp>
#include <polybody/integrators/generalised_alpha.hpp>

#include "support/slopes_of_runs.hpp"

using namespace polybody;

namespace islands_test {

using OnFloor = Contact<SphereOnPlane>;
using Balls = Model<Bodies<Rigid<>>, Joints<>, Forces<OnFloor>>;

/// Two balls fall on a floor, slide and begin to roll. The parameters are their friction coefficients.
auto balls(std::span<double const> mu) {
  Balls model{Gravity{0, 0, -9.81}};
  std::vector<Output<Balls>> outputs;
  for (Index const i : {0, 1}) {
    double const radius = 0.1, height = 0.12 + 0.03 * double(i);
    auto const ball =
        model.add(Rigid<>(1.0, 0.4 * radius * radius * Mat3::Identity(), Placement::at({0, double(i), height})));
    model.apply(OnFloor{{radius},
                        {.stiffness = 1e5, .damping = 100.0, .onset = 1e-3},
                        {.coefficient = mu[std::size_t(i)], .slip_speed = 0.01}},
                ball.at(Vec3(0, 0, 0)), model.ground().at({0, 0, 0}));
    outputs.push_back({"x", [i](Balls const&, State const& x) { return x.q[7 * i]; }});
  }
  State start = model.reference_state();
  start.v[0] = 1.0;
  start.v[6] = 1.4;
  start.v[1] = start.v[7] = 0.3;
  return with_objective(Scenario<Balls>{std::move(model), start, {.end_time = 0.3, .step = 1e-3}, std::move(outputs)},
                        [](Balls const&, auto const& x) { return x.q[0]; });
}
std::vector<Parameter> const coefficients{{"mu of the first ball [1]", 0.4}, {"mu of the second ball [1]", 0.2}};
GeneralisedAlpha const integrator{.tolerance = 1e-11};

TEST(DerivativesOfIslands, EqualDifferencesAndVanishForOtherIslands) {
  auto run = balls(std::vector{0.4, 0.2});
  System system(run.model, with<Capabilities::implicit_step>);
  AlphaMethod const method = integrator.method();
  auto work = method.workspace<DefaultSolver>(system);
  method.start(system, run.start, 1e-3, work);
  for (int i = 0; i < 300; ++i) (void)method.step(system, run.start, 1e-3, work);
  EXPECT_EQ(work.islands.count(), 2u);

  MatX const forward = sensitivities(balls, coefficients, integrator).derivatives.back();
  expect_same_derivatives(forward, by_differences(balls, coefficients, integrator), coefficients, 1e-7);
  for (Index const i : {0, 1}) {
    EXPECT_LT(forward(i, i), -1e-3);
    EXPECT_EQ(forward(i, 1 - i), 0.0);
  }
  VecX const backward = gradient(balls, coefficients, integrator).derivatives;
  EXPECT_NEAR(backward[0], forward(0, 0), 1e-7);
  EXPECT_EQ(backward[1], 0.0);
}

}  // namespace islands_test
