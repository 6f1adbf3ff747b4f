// refused: EnergyMomentum and EnergyDecaying do not support nonholonomic joints
// A blade constrains a velocity: there is no constraint function whose change over a step could be computed.
#include <polybody/bodies/rigid/planar_rigid.hpp>
#include <polybody/integrators/energy_momentum.hpp>
#include <polybody/joints/nonholonomic.hpp>
#include <polybody/run/simulate.hpp>

using namespace polybody;
using M = Model<Bodies<planar::Rigid>, Joints<Joint<KnifeEdge, Constraint>>>;

void run(M const& model, State& x) { simulate(model, x, EnergyMomentum{}, {.end_time = 1.0, .step = 1e-3}); }
