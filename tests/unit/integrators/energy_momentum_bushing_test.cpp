// A bushing in an energy-conserving step: discrete gradients of rotations.

#include <polybody/integrators/energy_momentum.hpp>

#include <gtest/gtest.h>

#include <polybody/bodies/rigid/planar_rigid.hpp>
#include <polybody/joints/joint.hpp>
#include <polybody/joints/planar/joints.hpp>
#include <polybody/joints/policies/bushing.hpp>

#include "support/energy_drift.hpp"
#include "support/solver_instances.hpp"

using namespace polybody;

namespace energy_momentum_bushing_test {

using Mount = Joint<planar::Weld, Bushing>;

// A body on a bushing with stiffness in all six coordinates, far from its rest position and rotated by 0.5 rad.
TEST(EnergyMomentumOfBushings, StoreWhatTheyTake) {
  Model<Bodies<planar::Rigid>, Joints<Mount>> model;
  auto const body = model.add(planar::Rigid(1.0, 0.1), "body");
  model.connect(Mount{{},
                      {.stiffness = Bushing::diagonal(Vec3(100, 200, 1), Vec3(1, 1, 50)),
                       .damping = Bushing::Matrix::Zero().eval()}},
                model.ground().at({0, 0, 0}), body.at(Vec2(0.3, 0.1)), "mount");
  State x = model.reference_state();
  x.q << 0.2, -0.1, 0.5;
  model.set_velocity(x, body, Vec3(1, 0, 0), Vec3(0, 0, 5.0));
  Drift const drift = drift_of(model, x, EnergyMomentum{}, 0.02, 2000);
  EXPECT_LT(drift.energy, 1e-9);
}

}  // namespace energy_momentum_bushing_test
