#pragma once
/// \file Runs of models with nonholonomic constraints, under each method of constraint stabilisation.

#include <gtest/gtest.h>

#include <polybody/integrators/coordinate_partitioning.hpp>
#include <polybody/integrators/generalised_alpha.hpp>
#include <polybody/integrators/radau.hpp>
#include <polybody/integrators/runge_kutta.hpp>
#include <polybody/run/probe.hpp>
#include <polybody/run/simulate.hpp>

#include "support/solver_instances.hpp"

namespace polybody {

/// Runs to time `end_time` and returns the state. The constraint equations must be satisfied during the run, the
/// nonholonomic ones also if a method stabilises positions only.
template <class M, class I>
State rolled(M const& model, State x, I const& integrator, double end_time, double step) {
  System system(model);
  VecX rate = VecX::Zero(model.rows());
  Violation worst;
  double blades = 0.0;
  for (State const& now : simulate(model, x, integrator, {.end_time = end_time, .step = step})) {
    Violation const v = largest_violation(system, now);
    system.violation_rate(rate);
    for (Index const i : model.nonholonomic_equations()) blades = std::max(blades, std::abs(rate[i]));
    worst.position = std::max(worst.position, v.position);
    worst.velocity = std::max(worst.velocity, v.velocity);
  }
  bool keeps_velocities = true;
  if constexpr (requires { integrator.stabilised; }) keeps_velocities = integrator.stabilised;
  EXPECT_LT(worst.position, 1e-10) << integrator.name;
  EXPECT_LT(blades, 1e-9) << integrator.name;
  if (keeps_velocities) {
    EXPECT_LT(worst.velocity, 1e-9) << integrator.name;
  }
  return x;
}

/// The integrator's name, with ", stabilised" if it also stabilises velocities.
template <class I>
std::string named(I const& integrator) {
  std::string name(integrator.name);
  if constexpr (requires { integrator.stabilised; })
    if (integrator.stabilised) name += ", stabilised";
  return name;
}

/// Calls f(integrator, step, tolerance): order two with 2 000 steps per second, order four with 500, order five with
/// 100.
template <class F>
void with_each_integrator(F&& f) {
  f(GeneralisedAlpha{.rho_inf = 0.8}, 5e-4, 1.0);
  f(GeneralisedAlpha{.rho_inf = 0.8, .stabilised = true}, 5e-4, 1.0);
  f(RungeKutta4<Projection>{}, 2e-3, 1e-4);
  f(RungeKutta4<CoordinatePartitioning>{}, 2e-3, 1e-4);
  f(Radau{}, 1e-2, 1e-4);
}

}  // namespace polybody
