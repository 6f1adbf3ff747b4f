// refused: EnergyMomentum and EnergyDecaying do not support friction that follows the multipliers of a joint
#include <polybody/bodies/rigid/planar_rigid.hpp>
#include <polybody/forces/reaction_friction.hpp>
#include <polybody/integrators/energy_momentum.hpp>
#include <polybody/joints/planar/joints.hpp>
#include <polybody/run/simulate.hpp>

using namespace polybody;
using Pin = Joint<planar::Revolute, Constraint>;

void run(Model<Bodies<planar::Rigid>, Joints<Pin>, Forces<BearingFriction<Pin>>> const& model, State& x) {
  simulate(model, x, EnergyMomentum{}, {.end_time = 1.0, .step = 1e-3}).run();
}
