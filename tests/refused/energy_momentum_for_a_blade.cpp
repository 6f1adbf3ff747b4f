// refused: RollingDisc and KnifeEdge have none
// A blade holds a speed: there is no gap whose change over a step could be known.
#include <polybody/bodies/rigid/planar_rigid.hpp>
#include <polybody/integrators/energy_momentum.hpp>
#include <polybody/joints/knife_edge.hpp>
#include <polybody/run/simulate.hpp>

using namespace polybody;
using M = Model<Bodies<planar::Rigid>, Joints<Joint<KnifeEdge, Constraint>>>;

void run(M const& model, State& x) { simulate(model, x, EnergyMomentum{}, {.until = 1.0, .step = 1e-3}); }
