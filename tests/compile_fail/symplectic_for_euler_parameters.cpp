// refused: This integrator needs bodies with a constant mass matrix
#include <polybody/bodies/rigid/rigid_euler_parameters.hpp>
#include <polybody/integrators/symplectic.hpp>
#include <polybody/run/simulate.hpp>

using namespace polybody;
using M = Model<Bodies<Rigid<EulerParameters>>, Joints<>>;

void run(M const& model, State& x) { simulate(model, x, Rattle{}, {.end_time = 1.0, .step = 1e-3}); }
