#pragma once
// Derivatives of runs by finite differences of runs.

#include <polybody/gradients/parameter.hpp>
#include <polybody/run/simulate.hpp>

#include <span>
#include <vector>

namespace polybody {

/// The outputs of a complete run at its end, with its own steps.
template <class Make, class I>
VecX end_of(Make const& make, std::span<double const> p, I integrator) {
  auto scenario = make(p);
  if constexpr (requires { integrator.newton; }) integrator.tolerance = 1e-13;
  State x = scenario.start;
  simulate(scenario.model, x, integrator, scenario.options).run();
  VecX out(Index(scenario.outputs.size()));
  for (Index i = 0; i < out.size(); ++i) out[i] = scenario.outputs[std::size_t(i)].value(scenario.model, x);
  return out;
}
/// Fourth-order finite differences of complete runs.
template <class Make, class I>
MatX by_differences(Make const& make, std::vector<Parameter> const& parameters, I const& integrator) {
  MatX out;
  for (std::size_t j = 0; j < parameters.size(); ++j) {
    VecX sum;
    for (std::size_t k = 0; k < 4; ++k) {
      std::vector<double> p;
      for (Parameter const& one : parameters) p.push_back(one.value);
      double const e = 2.0 * parameters[j].distance();
      p[j] += FourPoints::places[k] * e;
      VecX const of = FourPoints::weights[k] / e * end_of(make, p, integrator);
      sum = k == 0 ? of : VecX(sum + of);
    }
    out.conservativeResize(sum.size(), Index(j + 1));
    out.col(Index(j)) = sum;
  }
  return out;
}

}  // namespace polybody
