// Closed mechanisms with every joint twice. The motion is that of the mechanism without the second joints. The
// reactions are bounded and continuous. The tests of Andrews' mechanism, the closed chain, the grid of loops and the
// spatial slider-crank double the joints of these mechanisms, and double_cardan_test.cpp has two equal branches.

#include <gtest/gtest.h>

#include <polybody/integrators/generalised_alpha.hpp>
#include <polybody/integrators/radau.hpp>
#include <polybody/integrators/runge_kutta.hpp>
#include <polybody/joints/standard_joints.hpp>
#include <polybody/run/probe.hpp>
#include <polybody/run/simulate.hpp>

#include "support/doubled_joints.hpp"
#include "support/linkages.hpp"

using namespace polybody;

namespace doubled_joints_test {

template <class Make>
void expect_same_by_every_method(Make const& make, double end_time) {
  auto const by = [&](auto const& integrator) {
    auto single = make(1), twice = make(2);
    expect_same(single, twice, integrator, {.end_time = end_time, .step = 2e-3}, 1e-9);
  };
  by(GeneralisedAlpha{.tolerance = 1e-10});
  by(GeneralisedAlpha{.tolerance = 1e-10, .stabilised = true});
  by(HhtAlpha{.tolerance = 1e-10});
  by(Radau{});
  by(RungeKutta4<Projection>{});
}

TEST(DoubledJoints, MoveFourBarsAsSingleOnes) {
  for (int const n : {1, 3}) {
    expect_same_by_every_method([n](int each) { return FourBars<InPlane<Constraint>>(n, {}, each); }, 0.5);
    expect_same_by_every_method([n](int each) { return FourBars<InSpace<Constraint>>(n, {}, each); }, 0.5);
  }
}
TEST(DoubledJoints, MoveTheBricardMechanismAsSingleOnes) {
  expect_same_by_every_method([](int each) { return Bricard<>(0.1, {}, {}, each); }, 1.0);
}
TEST(DoubledJoints, MoveThinRodsAsSingleOnes) {  // whose mass is singular
  Bricard<> single(0.0, {}, {}, 1), twice(0.0, {}, {}, 2);
  expect_same(single, twice, GeneralisedAlpha{.tolerance = 1e-10}, {.end_time = 1.0, .step = 2e-3}, 1e-8);
}
// In the flat configuration the rank decreases further.
TEST(DoubledJoints, PassASingularPosition) {
  for (int const n : {1, 2}) {
    Corner const end = *std::find_if(std::begin(breakpoints), std::end(breakpoints),
                                     [n](Corner const& c) { return c.n == n && c.t == 4; });
    auto const expect = [&](auto bars, auto const& integrator) {
      simulate(bars.model, bars.x, integrator, {.end_time = end.t, .step = 1e-3}).run();
      EXPECT_LT((bars.corner() - Vec3(end.x, end.y, 0)).norm(), 1e-4) << n << integrator.name;
    };
    expect(FourBars<InPlane<Constraint>>(n, {}, 2), GeneralisedAlpha{});
    expect(FourBars<InPlane<Constraint>>(n, {}, 2), Radau{});
    expect(FourBars<InSpace<Constraint>>(n, {}, 2), GeneralisedAlpha{});
  }
}

}  // namespace doubled_joints_test
