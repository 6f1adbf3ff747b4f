#pragma once
/// \file Energy audits of many small models with one type, by a table.

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <vector>

#include <polybody/bodies/rigid/rigid.hpp>
#include <polybody/integrators/radau.hpp>
#include <polybody/run/energy_audit.hpp>
#include <polybody/run/simulate.hpp>

namespace polybody {

/// A part in a model of type M.
template <class M>
struct AuditCase {
  char const* name;
  double end_time, step;           ///< [s]
  double order;                    ///< order of the unaccounted energy: 3, or 2 if the powers have corners
  std::function<State(M&)> build;  ///< adds bodies and the part, returns the initial state
};

/// Unaccounted energy relative to the turnover, of Radau IIA with the step h. The error of this method is negligible.
template <class M>
double unaccounted_of(AuditCase<M> const& c, double h) {
  M model{Gravity{0, -9.81, 0}};
  State x = c.build(model);
  EnergyAudit audit(model);
  for (State const& now : simulate(model, x, Radau{.tolerance = 1e-11}, {.end_time = c.end_time, .step = h}))
    audit.record(now);
  EXPECT_GT(std::abs(audit.work_of_loads()) + std::abs(audit.dissipated()), 0.01);
  return audit.relative();
}

/// The audit closes within 1e-6 of the turnover. A fourth of the step reduces the unaccounted energy with its order, so
/// that no power is missing. The order of one ratio varies by 0.75, because corners lie anywhere in a step.
template <class M>
void expect_closed(std::vector<AuditCase<M>> const& cases) {
  for (AuditCase<M> const& c : cases) {
    SCOPED_TRACE(c.name);
    double const coarse = unaccounted_of(c, 4.0 * c.step), fine = unaccounted_of(c, c.step);
    EXPECT_LT(fine, 1e-6);
    EXPECT_GT(std::log(coarse / fine) / std::log(4.0), c.order - 0.75) << coarse << " and " << fine;
  }
}

}  // namespace polybody
