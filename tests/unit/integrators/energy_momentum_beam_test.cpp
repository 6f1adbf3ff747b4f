// Conservation of energy and both momenta of a fully parameterised beam in free flight.

#include <polybody/integrators/energy_momentum.hpp>

#include <gtest/gtest.h>

#include <polybody/bodies/ancf/ancf_beam.hpp>

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

}  // namespace energy_momentum_beam_test
