// Derivatives of runs by methods of several stages whose joints eliminate coordinates.
#include <polybody/gradients/radau_step_adjoint.hpp>
#include <polybody/gradients/radau_step_slope.hpp>
#include <polybody/gradients/runge_kutta_step_adjoint.hpp>
#include <polybody/gradients/runge_kutta_step_slope.hpp>

#include <gtest/gtest.h>

#include "support/differences_of_runs.hpp"
#include "support/hung_cables.hpp"

using namespace polybody;

namespace eliminated_stages_test {

/// Forwards beside differences of whole runs, backwards beside forwards.
template <bool held, class I>
void expect_slopes_of_runs(double h, I const& integrator, double within) {
  auto const make = hung_cables<AncfLinear, held>(h);
  std::vector<Parameter> const& parameters = parameters_of_hung_cables;
  MatX const slopes = sensitivities(make, parameters, integrator).slopes.back(),
             expected = by_differences(make, parameters, integrator);
  for (Index j = 0; j < slopes.cols(); ++j) {
    double const size = parameters[std::size_t(j)].size();
    for (Index i = 0; i < slopes.rows(); ++i)
      EXPECT_NEAR(size * slopes(i, j), size * expected(i, j), within * (1.0 + std::abs(size * expected(i, j))))
          << i << ' ' << parameters[std::size_t(j)].name;
    EXPECT_GT(size * slopes.col(j).norm(), 1e-4);
  }
  expect_adjoint_of_hung_cables(make, integrator, 1e-11);
}

TEST(EliminatedInStages, ByRungeKuttaWithoutRows) { expect_slopes_of_runs<false>(5e-4, RungeKutta4<>{}, 1e-8); }
TEST(EliminatedInStages, ByRungeKuttaWithProjectionOfARowThatStays) {
  expect_slopes_of_runs<true>(5e-4, RungeKutta4<Projection>{}, 1e-8);
}
TEST(EliminatedInStages, ByRadau) {
  expect_slopes_of_runs<false>(2e-3, Radau{}, 1e-8);
  expect_slopes_of_runs<true>(2e-3, Radau{}, 1e-8);
}

}  // namespace eliminated_stages_test
