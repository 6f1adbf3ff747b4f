// Conservation of energy and both momenta of flexible rods in free flight in the plane, over long runs (I3, D3).

#include <polybody/integrators/energy_momentum.hpp>

#include <gtest/gtest.h>

#include <polybody/bodies/ancf/planar_ancf_cable.hpp>
#include <polybody/forces/loads.hpp>
#include <polybody/integrators/generalised_alpha.hpp>
#include <polybody/run/probe.hpp>
#include <polybody/run/simulate.hpp>

#include "support/energy_drift.hpp"
#include "support/refusal.hpp"
#include "support/solver_instances.hpp"

using namespace polybody;

namespace energy_momentum_test {

using Cable = planar::AncfCable<>;

/// Flying flexible rod (D3, Simo & Vu-Quoc 1986): 8 N and −80 N m for 2.5 s at the end that starts at (6, 0); the
/// other end is at (0, 8). EA = 1e4 N, 1 kg/m, 10 m.
struct Thrown {
  Model<Bodies<Cable>, Joints<>, Forces<PointForce<Window>, PointMoment<Window>>> model;
  BodyHandle<Cable> rod;
  State x;
  Thrown(double ei, Index n, double ea = 1e4)
      : rod(model.add(Cable::from({.length = 10.0,
                                   .constants = BarConstants{.EA = ea, .EI = ei, .mass_per_length = 1.0},
                                   .placement = Placement::planar(6.0, 0.0, std::atan2(8.0, -6.0))},
                                  n),
                      "rod")) {
    Window const window{.from = 0.0, .to = 2.5};
    model.apply(PointForce<Window>{.force = {8, 0, 0}, .law = window}, rod.at(0.0), "force");
    model.apply(PointMoment<Window>{.moment = {0, 0, -80}, .law = window}, rod.at(0.0), "moment");
    x = model.reference_state();
  }
  void throw_with(double h) { simulate(model, x, EnergyMomentum{}, {.end_time = 2.5, .step = h}).run(); }
  Vec2 centre() const {  // −m x_c is the energy in a field of 1 m/s², m = 10 kg
    Vec2 c = Vec2::Zero();
    for (int k = 0; k < 2; ++k)
      for (Index e = 0; e < rod.body().elements(); ++e)
        c[k] -=
            rod.body().gravity_energy(e, std::span<double const>(x.q.data(), std::size_t(x.q.size())), Vec3::Unit(k)) /
            10.0;
    return c;
  }
};

// 1e4 steps after the end of the load. The impulse 8 N · 2.5 s gives P = (20, 0), x_c = 5.5 + 2 (t − 2.5), y_c = 4.
TEST(EnergyMomentum, KeepsEnergyAndMomentaOfAThrownRodOverTenThousandSteps) {
  for (double const ei : {500.0, 100.0}) {
    double const h = ei / 5e4;
    Thrown rod(ei, 8);
    rod.throw_with(h);
    EXPECT_LT((momentum(rod.model, rod.x).linear - Vec3(20, 0, 0)).norm(), 1e-10);
    EXPECT_LT((rod.centre() - Vec2(5.5, 4.0)).norm(), 1e-10);
    Drift const drift = drift_of(rod.model, rod.x, EnergyMomentum{}, h, 10000);
    held_drift(drift, ei == 500.0 ? "D3's rod, EI = 500, AncfCable, 8 elements, EnergyMomentum, 1e4 steps of 10 ms"
                                  : "D3's rod, EI = 100, AncfCable, 8 elements, EnergyMomentum, 1e4 steps of 2 ms");
    EXPECT_LT((rod.centre() - Vec2(5.5 + 2.0 * 10000 * h, 4.0)).norm(), 1e-8);
  }
}

/// Orders of convergence: log₂ of the ratio of successive differences between runs at h, h/2, h/4, ….
std::vector<double> orders_of(std::vector<VecX> const& ends) {
  std::vector<double> differences, slopes;
  for (std::size_t i = 1; i < ends.size(); ++i) differences.push_back((ends[i] - ends[i - 1]).norm());
  for (std::size_t i = 1; i < differences.size(); ++i) slopes.push_back(std::log2(differences[i - 1] / differences[i]));
  return slopes;
}

// A soft rod that rotates, bends and stretches smoothly. Each refinement reduces the difference to a quarter.
TEST(EnergyMomentum, IsOfOrderTwo) {
  std::vector<VecX> ends;
  for (int k = 1; k <= 8; k *= 2) {
    Thrown rod(100.0, 2, 1e3);
    rod.x.t = 10.0;  // after the end of the load
    rod.model.set_velocity(rod.x, rod.rod, Vec3(1, 0, 0), Vec3(0, 0, 1));
    rod.x.v[8] += 0.5;
    simulate(rod.model, rod.x, EnergyMomentum{}, {.end_time = 10.5, .step = 0.005 / k}).run();
    VecX end(2 * rod.x.q.size());
    end << rod.x.q, rod.x.v;
    ends.push_back(end);
  }
  std::vector<double> const orders = orders_of(ends);
  EXPECT_NEAR(orders.back(), 2.0, 0.1) << testing::PrintToString(orders);
}

// The work of a dead force at a point of the axis is F·Δr up to round-off, for any step length.
TEST(EnergyMomentum, EnergyGrowsByTheWorkOfADeadForce) {
  Model<Bodies<Cable>, Joints<>, Forces<PointForce<>>> model{Gravity{0, -9.81, 0}};
  auto const rod = model.add(
      Cable::from({.length = 1.0, .constants = BarConstants{.EA = 1e4, .EI = 10.0, .mass_per_length = 1.0}}, 3), "rod");
  Vec3 const force(1, 4, 0);
  model.apply(PointForce<>{.force = force}, rod.at(0.8), "force");
  State x = model.reference_state();
  model.set_velocity(x, rod, Vec3::Zero(), Vec3(0, 0, 2.0));
  Vec3 const from = position(model, x, rod.at(0.8));
  double const start = energy(model, x).total();
  simulate(model, x, EnergyMomentum{}, {.end_time = 1.0, .step = 0.02}).run();
  double const work = force.dot(position(model, x, rod.at(0.8)) - from);
  EXPECT_GT(std::abs(work), 0.1);
  EXPECT_NEAR(energy(model, x).total() - start, work, 1e-9);
}

// EA = 1e6 N, so that the fastest mode rotates by more than 50 rad per step (|r′| of an element: ω ≈ √12 √(EA/ρA)/l =
// 2800 rad/s). The trapezoidal rule is stable for linear models only: its steps soon have no convergence of Newton's
// method. The energy-momentum method continues.
TEST(EnergyMomentum, GoesOnWhereTheTrapezoidalRuleFails) {
  auto const flying = [](Thrown& rod) {
    rod.x.t = 10.0;  // after the end of the load
    rod.model.set_velocity(rod.x, rod.rod, Vec3(2, 0, 0), Vec3(0, 0, 3));
    for (Index i = 1; i < rod.x.v.size(); i += 4) rod.x.v[i] += std::cos(0.3 * double(i));
  };
  Thrown wild(500.0, 8, 1e6), kept(500.0, 8, 1e6);
  flying(wild);
  flying(kept);
  EXPECT_THROW(drift_of(wild.model, wild.x, Trapezoidal{}, 0.02, 1000), Error);
  EXPECT_LT(wild.x.t, 11.0);
  expect_invariants(drift_of(kept.model, kept.x, EnergyMomentum{}, 0.02, 1000));
}

TEST(EnergyMomentum, StalledStepLeavesTheStateAndSaysSo) {
  Thrown rod(100.0, 4);
  System system = system_for<EnergyMomentum>(rod.model);
  EnergyMomentum const integrator, impatient{.newton = {.max_iterations = 2}};
  auto const method = method_of(integrator);
  auto workspace = method.workspace<DefaultSolver>(system);
  method.start(system, rod.x, 0.01, workspace);
  for (int i = 0; i < 10; ++i) method.step(system, rod.x, 0.01, workspace);
  State const before = rod.x;
  std::string const message =
      message_of<NewtonConvergenceFailure>([&] { method_of(impatient).step(system, rod.x, 1.0, workspace); });
  EXPECT_TRUE(has(message, "EnergyMomentum: Newton's method did not converge at t = 1.1"));
  EXPECT_TRUE(has(message, "Take a smaller step"));
  EXPECT_EQ(rod.x.q, before.q);
  EXPECT_EQ(rod.x.v, before.v);
  EXPECT_EQ(rod.x.a, before.a);
  EXPECT_EQ(rod.x.history, before.history);
  EXPECT_EQ(rod.x.t, before.t);
  EXPECT_NO_THROW(method.step(system, rod.x, 0.01, workspace));
  EXPECT_NEAR(rod.x.t, 0.11, 1e-12);
  EXPECT_TRUE(has(
      refusal([&] { simulate(rod.model, rod.x, EnergyMomentum{.tolerance = 0.0}, {.end_time = 1.0, .step = 0.1}); }),
      "EnergyMomentum: the tolerance must be positive"));
}

}  // namespace energy_momentum_test
