// refused: support the policies Constraint, Penalty and Bushing
#include <polybody/bodies/rigid/planar_rigid.hpp>
#include <polybody/integrators/energy_momentum.hpp>
#include <polybody/joints/planar/joints.hpp>
#include <polybody/joints/policies/bushing.hpp>
#include <polybody/run/simulate.hpp>

using namespace polybody;
using Laws = NonlinearBushing<LinearLaw, LinearLaw, LinearLaw, LinearLaw, LinearLaw, LinearLaw>;
using M = Model<Bodies<planar::Rigid>, Joints<Joint<planar::Weld, Laws>>>;

void run(M const& model, State& x) { simulate(model, x, EnergyDecaying{}, {.end_time = 1.0, .step = 1e-3}); }
