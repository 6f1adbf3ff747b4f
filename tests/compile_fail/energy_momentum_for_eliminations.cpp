// refused: do not support policies that eliminate coordinates
#include <polybody/bodies/rigid/planar_rigid.hpp>
#include <polybody/integrators/energy_momentum.hpp>
#include <polybody/joints/planar/joints.hpp>
#include <polybody/run/simulate.hpp>

using namespace polybody;
using M = Model<Bodies<planar::Rigid>, Joints<Joint<planar::Revolute, JointCoordinates>>>;

void run(M const& model, State& x) { simulate(model, x, EnergyMomentum{}, {.end_time = 1.0, .step = 1e-3}); }
