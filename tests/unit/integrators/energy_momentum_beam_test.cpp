// Conservation of energy and momenta of beams in free flight: fully parameterised in space, and with sections that
// rotate in the plane.

#include <polybody/integrators/energy_momentum.hpp>

#include <gtest/gtest.h>

#include <polybody/bodies/ancf/ancf_beam.hpp>
#include <polybody/bodies/lrvf/planar_lrvf.hpp>
#include <polybody/bodies/se3/planar_se3_beam.hpp>
#include <polybody/run/simulate.hpp>

#include "support/energy_drift.hpp"
#include "support/solver_instances.hpp"

using namespace polybody;

namespace energy_momentum_beam_test {

// Green strains are scalar products of the columns of F. Therefore both momenta are constant.
TEST(EnergyMomentumOfBeams, KeepsEnergyAndMomentaOfTheContinuum) {
  Model<Bodies<AncfBeam<Continuum<>>>, Joints<>> model;
  Bar const bar{.length = 5.0,
                .section = Rectangle{.height = 0.5, .width = 0.4},
                .material = Material{.density = 5.0, .young = 5e4, .poisson = 0.3}};
  auto const beam = model.add(AncfBeam<Continuum<>>::from(bar, 2), "beam");
  State x = model.reference_state();
  model.set_velocity(x, beam, Vec3(1, 2, 3), Vec3(0.5, 1.0, 2.0));
  for (Index i = 0; i < x.v.size(); i += 12) x.v[i + 2] += std::cos(0.1 * double(i));
  Drift const drift = drift_of(model, x, EnergyMomentum{}, 0.01, 200);
  EXPECT_LT(drift.energy, 1e-9);
  EXPECT_LT(drift.linear, 1e-11);
  EXPECT_LT(drift.angular, 1e-9);
}

/// Beam in the plane that is bent to an arc of `angle` [rad], rotates and flies. Its sections have inertia.
template <class B>
struct Arc {
  Model<Bodies<B>, Joints<>> model;
  State x;
  Arc(Index n, double angle, double damping = 0.0) {
    Bar const bar{
        .length = 1.0,
        .constants = BarConstants{.EA = 2e3, .EI = 3.0, .mass_per_length = 0.5, .GA = 1e3, .rotary_inertia = 0.01},
        .damping = {.axial = damping, .shear = damping, .bending = damping}};
    auto const beam = model.add(B::from(bar, n), "beam");
    x = model.reference_state();
    for (Index i = 0; i <= n; ++i) {
      double const turn = angle * double(i) / double(n), radius = 1.0 / angle;
      x.q.segment<3>(3 * i) = Vec3(radius * std::sin(turn), radius * (1.0 - std::cos(turn)), turn);
    }
    model.set_velocity(x, beam, Vec3(1.0, 0.5, 0.0), Vec3(0, 0, 2.0));
  }
};

template <class B>
struct EnergyMomentumOfPlanarBeams : testing::Test {};
using PlanarBeams = testing::Types<planar::Lrvf, planar::Se3Beam>;
TYPED_TEST_SUITE(EnergyMomentumOfPlanarBeams, PlanarBeams);

/// Constant energy and linear momentum, and angular momentum with an error of order two.
template <class B>
void expect_energy_and_order_of_momentum(Index n, double angle) {
  Arc<B> arc(n, angle), finer(n, angle);
  Drift const coarse = drift_of(arc.model, arc.x, EnergyMomentum{}, 0.002, 10000),
              fine = drift_of(finer.model, finer.x, EnergyMomentum{}, 0.001, 10000);
  EXPECT_LT(coarse.energy, 1e-8);
  EXPECT_LT(coarse.linear, 1e-10);
  EXPECT_LT(coarse.angular, 5e-5);
  EXPECT_GT(std::log2(coarse.angular / fine.angular), 1.8);
}

// The angles of neighbouring nodes differ by 0.75 rad, and by 0.15 rad in the second mesh.
TYPED_TEST(EnergyMomentumOfPlanarBeams, EnergyIsConstantOverTenThousandSteps) {
  for (Index const n : {2, 10}) expect_energy_and_order_of_momentum<TypeParam>(n, 1.5);
}

TYPED_TEST(EnergyMomentumOfPlanarBeams, DampingAndEnergyDecayingOnlyTakeEnergy) {
  auto const expect_loss = [](auto const& integrator, double damping) {
    Arc<TypeParam> arc(4, 2.0, damping);
    Drift const drift = drift_of(arc.model, arc.x, integrator, 0.002, 10000);
    EXPECT_LT(drift.largest_gain, 1e-11);
    EXPECT_GT(drift.energy, 1e-3);
    EXPECT_LT(drift.linear, 1e-10);
  };
  expect_loss(EnergyMomentum{}, 5e-3);
  expect_loss(EnergyDecaying{.rho_inf = 0.8}, 0.0);
}

// One element, which unrolls from an angle of 2.2 rad between its ends.
TEST(EnergyMomentumOfBeams, EnergyOfOneArcIsConstantAtLargeAngles) {
  expect_energy_and_order_of_momentum<planar::Se3Beam>(1, 2.2);
}

}  // namespace energy_momentum_beam_test
