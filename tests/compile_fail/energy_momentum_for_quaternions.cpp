// refused: EnergyMomentum and EnergyDecaying need bodies with a constant mass matrix
#include <polybody/bodies/rigid/rigid_euler_parameters.hpp>
#include <polybody/integrators/energy_momentum.hpp>
#include <polybody/run/simulate.hpp>

using namespace polybody;
using M = Model<Bodies<Rigid<EulerParameters>>, Joints<>>;

void run(M const& model, State& x) { simulate(model, x, EnergyMomentum{}, {.end_time = 1.0, .step = 1e-3}); }
