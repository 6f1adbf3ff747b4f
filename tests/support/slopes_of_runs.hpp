#pragma once
// Derivatives of runs against other derivatives of the same runs.

#include <gtest/gtest.h>

#include <polybody/gradients/gradient.hpp>
#include <polybody/gradients/sensitivities.hpp>

#include "support/differences_of_runs.hpp"

namespace polybody {

/// Both derivatives agree within a relative tolerance and one unit, scaled by the sizes of the parameters. The
/// outputs are of order one.
inline void expect_same_slopes(MatX const& slopes, MatX const& expected, std::vector<Parameter> const& parameters,
                               double within) {
  ASSERT_EQ(slopes.rows(), expected.rows());
  for (Index j = 0; j < slopes.cols(); ++j) {
    double const size = parameters[std::size_t(j)].size();
    for (Index i = 0; i < slopes.rows(); ++i)
      EXPECT_NEAR(size * slopes(i, j), size * expected(i, j), within * (1.0 + std::abs(size * expected(i, j))))
          << i << ' ' << parameters[std::size_t(j)].name;
  }
}

/// Forward sensitivities against finite differences of complete runs. Every parameter has an effect, so zeros are not
/// compared.
template <class Make, class I>
void expect_slopes_of_runs(Make const& make, std::vector<Parameter> const& parameters, I const& integrator,
                           double within) {
  SensitivityResult const s = sensitivities(make, parameters, integrator);
  EXPECT_LT(s.left, 1e-9);
  expect_same_slopes(s.slopes.back(), by_differences(make, parameters, integrator), parameters, within);
  for (std::size_t j = 0; j < parameters.size(); ++j)
    EXPECT_GT(parameters[j].size() * s.slopes.back().col(Index(j)).norm(), 1e-4) << parameters[j].name;
}

/// Adjoint gradients of an objective function, which contains the final state and the integral of the path. They are
/// compared with forward sensitivities of the first two outputs, which are the final state and the path.
template <class Make, class I>
void expect_slopes_backwards(Make const& make, std::vector<Parameter> const& parameters, I const& integrator,
                             double within) {
  SensitivityResult const direct = sensitivities(make, parameters, integrator);
  Gradient const g = gradient(make, parameters, integrator);
  MatX expected = direct.slopes.back().row(0);
  for (std::size_t k = 1; k < direct.times.size(); ++k)
    expected += 0.5 * (direct.times[k] - direct.times[k - 1]) * (direct.slopes[k].row(1) + direct.slopes[k - 1].row(1));
  expect_same_slopes(g.slopes.transpose(), expected, parameters, within);
}

}  // namespace polybody
