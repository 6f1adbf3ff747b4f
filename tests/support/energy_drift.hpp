#pragma once
/// \file Invariants of a run without loads: the largest deviations of energy and momenta during the run.

#include <polybody/integrators/integrator.hpp>
#include <polybody/run/probe.hpp>

#include "held.hpp"

namespace polybody {

struct Drift {
  double energy = 0.0, linear = 0.0, angular = 0.0;  ///< relative to the initial values
  double largest_gain = -1.0;  ///< largest energy gain in one step, relative; negative if every step loses energy
  double violation = 0.0;      ///< |Φ|, largest
};

/// Runs `steps` steps of length h from x, which it changes.
template <class M, class I>
Drift drift_of(M const& model, State& x, I const& integrator, double h, int steps) {
  System system = system_for<I, Capabilities::energy>(model);
  auto const method = method_of(integrator);
  auto workspace = method.template workspace<DefaultSolver>(system);
  method.start(system, x, h, workspace);
  system.evaluate(x.q, x.v, x.t);
  double const start = energy(system, x).total();
  Momentum const p0 = momentum(model, x);
  double before = start;
  VecX open = VecX::Zero(system.rows());
  Drift drift;
  for (int i = 0; i < steps; ++i) {
    method.step(system, x, h, workspace);
    system.evaluate(x.q, x.v, x.t);
    double const now = energy(system, x).total();
    Momentum const p = momentum(model, x);
    drift.energy = std::max(drift.energy, std::abs(now / start - 1.0));
    drift.largest_gain = std::max(drift.largest_gain, (now - before) / start);
    drift.linear = std::max(drift.linear, (p.linear - p0.linear).norm() / p0.linear.norm());
    drift.angular = std::max(drift.angular, (p.angular - p0.angular).norm() / p0.angular.norm());
    system.violation(open);
    for (double const g : open) drift.violation = std::max(drift.violation, std::abs(g));
    before = now;
  }
  return drift;
}

/// Constant energy, momenta and constraint functions.
inline void expect_invariants(Drift const& drift) {
  EXPECT_LT(drift.energy, 1e-8);
  EXPECT_LT(drift.linear, 1e-10);
  EXPECT_LT(drift.angular, 1e-8);
  EXPECT_LT(drift.violation, 1e-11);
}
/// Constant momenta, and an energy that no step increases. The energy changes by more than `least`, relative.
inline void expect_decay(Drift const& drift, double least) {
  EXPECT_LT(drift.largest_gain, 1e-11);
  EXPECT_GT(drift.energy, least);
  EXPECT_LT(drift.linear, 1e-10);
  EXPECT_LT(drift.angular, 1e-8);
}

/// Invariants of a run without loads, relative: energy and angular momentum to 1e-8, linear momentum to 1e-10.
inline void held_drift(Drift const& drift, char const* formulation) {
  auto const claim = [&](char const* what) { return Claim{"I3", what, By::closed_form, "invariant", formulation}; };
  held_within(claim("energy after the loads, drift of itself"), drift.energy, 1e-8, {.scale = 1.0});
  held_within(claim("linear momentum after the loads, drift of itself"), drift.linear, 1e-10, {.scale = 1.0});
  held_within(claim("angular momentum after the loads, drift of itself"), drift.angular, 1e-8, {.scale = 1.0});
}

}  // namespace polybody
