// Derivatives of runs with multi-stage methods whose joints eliminate coordinates.

#include <gtest/gtest.h>

#include "support/hung_cables.hpp"
#include "support/impacts_of_whole_states.hpp"
#include "support/slopes_of_runs.hpp"

using namespace polybody;

namespace eliminated_stages_test {

template <bool held, class I>
void expect_derivatives(double h, I const& integrator) {
  auto const make = hung_cables<AncfLinear, held>(h);
  expect_derivatives_of_runs(make, parameters_of_hung_cables, integrator, 1e-8);
  expect_derivatives_backwards(make, parameters_of_hung_cables, integrator, 1e-11);
}

TEST(EliminatedInStages, ByRungeKuttaWithoutRows) { expect_derivatives<false>(5e-4, RungeKutta4<>{}); }
TEST(EliminatedInStages, ByRungeKuttaWithProjectionOfARowThatStays) {
  expect_derivatives<true>(5e-4, RungeKutta4<Projection>{});
}
TEST(EliminatedInStages, ByRadau) {
  expect_derivatives<false>(2e-3, Radau{});
  expect_derivatives<true>(2e-3, Radau{});
}
TEST(EliminatedInStages, EventsSeeAndChangeWholeStates) {
  expect_impact_of_cables(5e-4, RungeKutta4<>{});
  expect_impact_of_cables(2e-3, Radau{});
}

}  // namespace eliminated_stages_test
