// R2: four-bars through their singular position by the methods whose matrix must follow how the rows turn there; the
// α-methods stand in redundant_joints_test.cpp.

#include <gtest/gtest.h>

#include <polybody/integrators/energy_momentum.hpp>
#include <polybody/integrators/radau.hpp>
#include <polybody/run/energy.hpp>
#include <polybody/run/simulate.hpp>

#include "support/linkages.hpp"

namespace polybody {
namespace singular_positions_test {

/// What a run of four-bars ends with.
struct Turned {
  double off = 0.0, gained = 0.0;  ///< of the corner [m]; energy [J]
  std::vector<std::string> warnings;
};
template <class I>
Turned turn(int n, double until, I const& integrator, double step) {
  FourBars<InPlane<Constraint>> bars(n);
  double const before = energy(bars.model, bars.x).total();
  RunReport const report = simulate(bars.model, bars.x, integrator, {.until = until, .step = step}).run();
  Turned out{0.0, energy(bars.model, bars.x).total() - before, report.warnings};
  for (Corner const& c : corners)
    if (c.n == n && c.t == until) out.off = (bars.corner() - Vec3(c.x, c.y, 0)).norm();
  return out;
}

// The mean of G over the step and G at its end differ by as much as G does from one that has lost a rank.
TEST(SingularPosition, IsPassedByStepsThatConserveEnergy) {
  Turned const r = turn(2, 1, EnergyMomentum{}, 1e-3);
  EXPECT_LT(r.off, 1e-5);
  EXPECT_LT(std::abs(r.gained), 1e-7);
}
TEST(SingularPosition, IsPassedByStepsThatLoseEnergy) {  // of order one
  Turned const r = turn(2, 1, EnergyDecaying{.rho_inf = 0.95}, 1e-3);
  EXPECT_LT(r.off, 1e-2);
  EXPECT_LT(r.gained, 0.0);
  EXPECT_GT(r.gained, -0.1);
}
// G differs as much between the stages.
TEST(SingularPosition, IsPassedByRadau) {
  Turned const r = turn(2, 1, Radau{}, 2.5e-4);
  EXPECT_LT(r.off, 1e-8);
  EXPECT_LT(std::abs(r.gained), 1e-8);
}

}  // namespace singular_positions_test
}  // namespace polybody
