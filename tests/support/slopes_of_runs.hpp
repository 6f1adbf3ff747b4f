#pragma once
// Derivatives of runs against other derivatives of the same runs.

#include <gtest/gtest.h>

#include <polybody/gradients/gradient.hpp>
#include <polybody/gradients/sensitivities.hpp>

#include "support/differences_of_runs.hpp"

namespace polybody {

/// Both derivatives agree within a relative tolerance and one unit, scaled by the sizes of the parameters. The
/// outputs are of order one.
inline void expect_same_derivatives(MatX const& derivatives, MatX const& expected,
                                    std::vector<Parameter> const& parameters, double within) {
  ASSERT_EQ(derivatives.rows(), expected.rows());
  for (Index j = 0; j < derivatives.cols(); ++j) {
    double const size = parameters[std::size_t(j)].size();
    for (Index i = 0; i < derivatives.rows(); ++i)
      EXPECT_NEAR(size * derivatives(i, j), size * expected(i, j), within * (1.0 + std::abs(size * expected(i, j))))
          << i << ' ' << parameters[std::size_t(j)].name;
  }
}

/// Forward sensitivities against finite differences of complete runs. Every parameter has an effect, so zeros are not
/// compared.
template <class Make, class I>
void expect_derivatives_of_runs(Make const& make, std::vector<Parameter> const& parameters, I const& integrator,
                                double within) {
  SensitivityResult const s = sensitivities(make, parameters, integrator);
  EXPECT_LT(s.left, 1e-9);
  expect_same_derivatives(s.derivatives.back(), by_differences(make, parameters, integrator), parameters, within);
  for (std::size_t j = 0; j < parameters.size(); ++j)
    EXPECT_GT(parameters[j].size() * s.derivatives.back().col(Index(j)).norm(), 1e-4) << parameters[j].name;
}

/// Adjoint gradients of an objective function, which contains the final state and the integral of the path. They are
/// compared with forward sensitivities of the first two outputs, which are the final state and the path.
template <class Make, class I>
void expect_derivatives_backwards(Make const& make, std::vector<Parameter> const& parameters, I const& integrator,
                                  double within) {
  SensitivityResult const direct = sensitivities(make, parameters, integrator);
  GradientResult const g = gradient(make, parameters, integrator);
  MatX expected = direct.derivatives.back().row(0);
  for (std::size_t k = 1; k < direct.times.size(); ++k)
    expected += 0.5 * (direct.times[k] - direct.times[k - 1]) *
                (direct.derivatives[k].row(1) + direct.derivatives[k - 1].row(1));
  expect_same_derivatives(g.derivatives.transpose(), expected, parameters, within);
}

}  // namespace polybody
