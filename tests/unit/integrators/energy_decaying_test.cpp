// Steps that never increase the energy.

#include <polybody/integrators/energy_momentum.hpp>

#include <gtest/gtest.h>

#include <polybody/bodies/ancf/planar_ancf_cable.hpp>
#include <polybody/bodies/rigid/planar_rigid.hpp>
#include <polybody/joints/joint.hpp>
#include <polybody/joints/planar/joints.hpp>
#include <polybody/run/simulate.hpp>

#include "support/energy_drift.hpp"
#include "support/held.hpp"
#include "support/refusal.hpp"
#include "support/solver_instances.hpp"

using namespace polybody;

namespace energy_decaying_test {

using Cable = planar::AncfCable<>;

// A mass on a linear spring, x = ωh. With θ = ½ + χ = 1/(1 + ρ): Δq = h (v₀ + θ Δv), Δv = −hω² (q₀ + θ Δq). Hence a
// step multiplies ω q + i v by (1 − i (1 − θ) x)/(1 + i θ x), and the energy by (1 + (1 − θ)² x²)/(1 + θ² x²). This
// factor tends to ρ² as x → ∞.
TEST(EnergyDecaying, LinearModeLosesTheShareOfItsTheory) {
  using Spring = Joint<planar::Revolute, Penalty>;
  Model<Bodies<planar::Rigid>, Joints<Spring>> model;
  auto const mass = model.add(planar::Rigid(2.0, 1.0), "mass");
  model.connect(Spring{{}, {.stiffness = 50.0, .damping = 0.0}}, model.ground().at({0, 0, 0}), mass.at(Vec2(0, 0)),
                "spring");
  for (double const rho : {0.0, 0.5, 0.9, 1.0})
    for (double const hw : {0.1, 1.0, 10.0, 1e3}) {
      EnergyDecaying const integrator{.rho_inf = rho};
      State x = model.reference_state();
      x.q << 0.3, -0.2, 0.0;
      x.v << 1.0, 0.5, 0.0;
      System system = system_for<EnergyDecaying>(model);
      auto const method = method_of(integrator);
      auto workspace = method.workspace<DefaultSolver>(system);
      double const h = hw / 5.0, theta = 1.0 / (1.0 + rho);
      double const share = (1.0 + std::pow((1.0 - theta) * hw, 2)) / (1.0 + std::pow(theta * hw, 2));
      method.start(system, x, h, workspace);
      for (int i = 0; i < 3; ++i) {
        double const before = energy(model, x).total();
        method.step(system, x, h, workspace);
        held({"I3", "share of energy that a step leaves of an oscillator", By::closed_form,
              "(1 + (1 − θ)² x²)/(1 + θ² x²), x = ωh", "EnergyDecaying"},
             energy(model, x).total() / before, share, 1e-8, {equals("ρ", rho) + equals(", ωh", hw), 1.0});
      }
    }
}

/// A rod of 10 m and 1 kg/m in free flight that rotates, bends and stretches.
struct Flight {
  Model<Bodies<Cable>, Joints<>> model;
  State x;
  Flight(double ea, double ei, Index n) {
    auto const rod = model.add(
        Cable::from({.length = 10.0, .constants = BarConstants{.EA = ea, .EI = ei, .mass_per_length = 1.0}}, n), "rod");
    x = model.reference_state();
    model.set_velocity(x, rod, Vec3(2, 0, 0), Vec3(0, 0, 1));
  }
};

// High modes: rates of the gradients r′ that alternate from node to node along the axis. These modes contain most of
// the energy, and the method dissipates them. The energy that the momenta require remains. Energy falls in every
// step; linear momentum is constant.
TEST(EnergyDecaying, HighModesDieAndEnergyFallsInEveryStep) {
  Flight flight(1e6, 500.0, 8);
  double const smooth = energy(flight.model, flight.x).kinetic;
  for (Index i = 0; i <= 8; ++i) flight.x.v[4 * i + 2] += i % 2 == 0 ? 60.0 : -60.0;
  double const start = energy(flight.model, flight.x).total();
  ASSERT_GT(start, 2.0 * smooth);
  Drift const drift = drift_of(flight.model, flight.x, EnergyDecaying{.rho_inf = 0.5}, 0.005, 400);
  EXPECT_LT(drift.largest_gain, 0.0);
  held_within({"I3", "momentum of a free rod while its high modes die [N s]", By::closed_form, "invariant",
               "EnergyDecaying, planar AncfCable, 8 elements"},
              drift.linear, 1e-11, {.scale = 20.0});
  EXPECT_LT(energy(flight.model, flight.x).total(), 1.1 * smooth);
  EXPECT_GT(energy(flight.model, flight.x).total(), 0.5 * smooth);
}

// Small longitudinal and transverse vibrations of a clamped cable. hω > 1000 for all modes, so each step multiplies
// the energy by ρ².
TEST(EnergyDecaying, StiffModesOfACableLoseTheShareOfTheirTheory) {
  using Clamp = Joint<planar::Weld, Constraint>;
  Model<Bodies<Cable>, Joints<Clamp>> model;
  auto const rod = model.add(
      Cable::from({.length = 1.0, .constants = BarConstants{.EA = 1e4, .EI = 100.0, .mass_per_length = 1.0}}, 1));
  model.connect(Clamp{}, model.ground().at({0, 0, 0}), rod.at(0.0));
  for (double const rho : {0.2, 0.7})
    for (Index const i : {4, 5}) {
      EnergyDecaying const integrator{.rho_inf = rho};
      State x = model.reference_state();
      x.q[i] += 1e-6;
      System system = system_for<EnergyDecaying>(model);
      auto const method = method_of(integrator);
      auto workspace = method.workspace<DefaultSolver>(system);
      method.start(system, x, 50.0, workspace);
      double const before = energy(model, x).total();
      method.step(system, x, 50.0, workspace);
      held({"I3", "share of energy that a step leaves of a clamped cable, hω > 1000", By::closed_form, "ρ²",
            "EnergyDecaying"},
           energy(model, x).total() / before, rho * rho, 1e-3, {equals("ρ", rho) + equals(", column", double(i))});
    }
}

TEST(EnergyDecaying, IsOfOrderOneAndOfOrderTwoWhereItKeepsEnergy) {
  for (double const rho : {0.5, 1.0}) {
    std::vector<VecX> ends;
    for (int k = 1; k <= 8; k *= 2) {
      Flight flight(1e3, 100.0, 2);
      flight.x.v[8] += 0.5;
      simulate(flight.model, flight.x, EnergyDecaying{.rho_inf = rho}, {.end_time = 0.5, .step = 0.001 / k}).run();
      VecX end(2 * flight.x.q.size());
      end << flight.x.q, flight.x.v;
      ends.push_back(end);
    }
    double const order = std::log2((ends[2] - ends[1]).norm() / (ends[3] - ends[2]).norm());
    EXPECT_NEAR(order, rho < 1.0 ? 1.0 : 2.0, 0.1) << rho;
  }
}

TEST(EnergyDecaying, RefusesARadiusOutsideItsRange) {
  Flight flight(1e3, 100.0, 2);
  for (double const rho : {-0.1, 1.1, std::numeric_limits<double>::quiet_NaN()})
    EXPECT_TRUE(has(refusal([&] {
                      simulate(flight.model, flight.x, EnergyDecaying{.rho_inf = rho}, {.end_time = 1.0, .step = 0.1});
                    }),
                    "EnergyDecaying: rho_inf must lie in [0, 1]"));
}

}  // namespace energy_decaying_test
