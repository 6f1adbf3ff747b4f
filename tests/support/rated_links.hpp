#pragma once
// A run of two links with an objective function; its adjoint gradient against its forward sensitivities.

#include <gtest/gtest.h>

#include <polybody/gradients/gradient.hpp>
#include <polybody/gradients/sensitivities.hpp>

#include "support/two_links.hpp"

namespace polybody {

/// Two links. The objective function contains the final position of the tip, the motion of the bodies and the path of
/// the tip. It also contains the final reactions, multiplied by a factor.
template <class B, class Policy>
auto rated_links(double held) {
  return [held](std::span<double const> p) {
    auto links = two_links<B, Policy>(p);
    auto const tip = links.tip;
    auto const end = [tip, held](auto const& model, auto const& x) {
      auto const r = position(model, x, tip);
      auto sum = r[0] + 2.0 * r[1] - 0.5 * r[2];
      for (Index i = 0; i < x.v.size(); ++i) sum += 0.01 * double(i + 1) * x.v[i] + 1e-4 * held * x.a[i];
      for (Index i = 0; i < x.lambda.size(); ++i) sum += 1e-3 * held * double(i + 1) * x.lambda[i];
      return sum;
    };
    auto const way = [tip, mass = 1e-3 * p[1]](auto const& model, auto const& x) {
      auto const r = position(model, x, tip);
      return mass * (r[0] * r[0] + r[2]);
    };
    links.outputs = {{"end [1]", end}, {"way [1]", way}};
    using M = std::remove_cvref_t<decltype(links.model)>;
    return with_objective(Scenario<M>(std::move(links)), end, way);
  };
}

template <class Make, class I>
void expect_direct_derivatives(Make const& make, I const& integrator, double within) {
  std::vector<Parameter> const& parameters = parameters_of_two_links;
  SensitivityResult const direct = sensitivities(make, parameters, integrator);
  GradientResult const g = gradient(make, parameters, integrator);
  EXPECT_LT(g.left, 1e-10);
  double value = direct.values.back()[0];
  VecX expected = direct.derivatives.back().row(0).transpose();
  for (std::size_t k = 1; k < direct.times.size(); ++k) {
    double const half = 0.5 * (direct.times[k] - direct.times[k - 1]);
    value += half * (direct.values[k][1] + direct.values[k - 1][1]);
    expected += half * (direct.derivatives[k].row(1) + direct.derivatives[k - 1].row(1)).transpose();
  }
  EXPECT_NEAR(g.value, value, 1e-13 * std::abs(value));
  for (Index j = 0; j < expected.size(); ++j) {
    double const size = parameters[std::size_t(j)].size();
    EXPECT_NEAR(size * g.derivatives[j], size * expected[j], within * (std::abs(size * expected[j]) + 1.0))
        << parameters[std::size_t(j)].name;
  }
}
}  // namespace polybody
