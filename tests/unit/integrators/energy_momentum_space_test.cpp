// Conservation of energy and both momenta of flexible rods in free flight in space, over long runs (I3, D4).

#include <polybody/integrators/energy_momentum.hpp>

#include <gtest/gtest.h>

#include <polybody/bodies/ancf/ancf_cable.hpp>
#include <polybody/bodies/lrvf/lrvf.hpp>
#include <polybody/bodies/se3/se3_beam.hpp>
#include <polybody/forces/loads.hpp>
#include <polybody/integrators/radau.hpp>
#include <polybody/run/probe.hpp>
#include <polybody/run/simulate.hpp>

#include "support/energy_drift.hpp"
#include "support/solver_instances.hpp"

using namespace polybody;

namespace energy_momentum_space_test {

/// Rises from 0 to 1 at 2.5 s and falls back to 0 at 5 s.
struct Triangle {
  Motion operator()(double t) const { return {std::max(0.0, 1.0 - std::abs(t / 2.5 - 1.0)), 0.0, 0.0}; }
  std::vector<double> breakpoints() const { return {0.0, 2.5, 5.0}; }
};

/// Free flight in space (D4, AeroBeams, "flyingSpaghetti3D"): a rod from (6, 0, 0) to (0, 8, 0), thrown by a force
/// and a moment at its first end for 5 s.
template <class B>
struct Thrown {
  Model<Bodies<B>, Joints<>, Forces<PointForce<Triangle>, PointMoment<Triangle>>> model;
  BodyHandle<B> rod;
  State x;
  explicit Thrown(Index n)
      : rod(model.add(
            B::from(
                {.length = 10.0,
                 .constants =
                     BarConstants{
                         .EA = 1e4, .EI = 500, .mass_per_length = 1.0, .GA = 1e4, .GJ = 500, .rotary_inertia = 10.0},
                 .placement = Placement::planar(6.0, 0.0, std::atan2(8.0, -6.0))},
                n),
            "rod")) {
    model.apply(PointForce<Triangle>{.force = {20, 0, 0}}, rod.at(0.0), "force");
    model.apply(PointMoment<Triangle>{.moment = {0, -100, -200}}, rod.at(0.0), "moment");
    x = model.reference_state();
    simulate(model, x, EnergyMomentum{}, {.end_time = 5.0, .step = 0.01}).run();
  }
};

// P = (50, 0, 0) after 5 s, the integral of the force.
TEST(EnergyMomentumInSpace, KeepsEnergyAndMomentaOfAThrownCableOverTenThousandSteps) {
  Thrown<AncfCable<>> cable(6);
  EXPECT_LT((momentum(cable.model, cable.x).linear - Vec3(50, 0, 0)).norm(), 1e-9);
  Drift const drift = drift_of(cable.model, cable.x, EnergyMomentum{}, 0.01, 10000);
  held_drift(drift, "D4's loads on an AncfCable, 6 elements, EnergyMomentum, 1e4 steps of 10 ms");
}

TEST(EnergyMomentumInSpace, KeepsThemOfAThrownSe3Beam) {
  Thrown<Se3Beam> beam(6);
  EXPECT_LT((momentum(beam.model, beam.x).linear - Vec3(50, 0, 0)).norm(), 1e-9);
  Drift const drift = drift_of(beam.model, beam.x, EnergyMomentum{}, 0.01, 10000);
  held_drift(drift, "D4's loads on an Se3Beam, 6 elements, EnergyMomentum, 1e4 steps of 10 ms");
}

TEST(EnergyMomentumInSpace, KeepsThemOfAThrownLrvf) {
  Thrown<Lrvf<>> beam(6);
  Drift const drift = drift_of(beam.model, beam.x, EnergyMomentum{}, 0.01, 10000);
  held_drift(drift, "D4's loads on an Lrvf, 6 elements, EnergyMomentum, 1e4 steps of 10 ms");
}

// Kelvin–Voigt damping of the curvature of a bent cable after its release. It dissipates the same energy as in
// another method.
TEST(EnergyMomentumInSpace, DampsABentCableAsRadauDoes) {
  Model<Bodies<AncfCable<>>, Joints<>> model;
  model.add(AncfCable<>::from({.length = 1.0,
                               .constants = BarConstants{.EA = 1e4, .EI = 1.0, .mass_per_length = 1.0},
                               .damping = {.bending = 2e-3}},
                              4),
            "cable");
  auto const left = [&](auto const& integrator, double step) {
    State x = model.reference_state();
    for (Index node = 0; node <= 4; ++node) {  // a circular arc
      double const angle = 0.25 * double(node);
      x.q.segment<3>(6 * node) = Vec3(std::sin(angle), 0.0, 1.0 - std::cos(angle));
      x.q.segment<3>(6 * node + 3) = Vec3(std::cos(angle), 0.0, std::sin(angle));
    }
    double const before = energy(model, x).total();
    simulate(model, x, integrator, {.end_time = 0.1, .step = step}).run();
    return energy(model, x).total() / before;
  };
  double const by_radau = left(Radau{}, 2.5e-4), kept = left(EnergyMomentum{}, 2.5e-5);
  EXPECT_LT(by_radau, 0.8);
  EXPECT_NEAR(1.0 - kept, 1.0 - by_radau, 1.2e-3 * (1.0 - by_radau));
}

TEST(EnergyMomentumInSpace, KeepsThemWithEngineeringStrainToo) {
  Thrown<AncfCable<EngineeringStrain>> cable(4);
  Drift const drift = drift_of(cable.model, cable.x, EnergyMomentum{}, 0.01, 10000);
  held_drift(drift, "D4's loads on an AncfCable, engineering strain, 4 elements, EnergyMomentum, 1e4 steps of 10 ms");
}

}  // namespace energy_momentum_space_test
