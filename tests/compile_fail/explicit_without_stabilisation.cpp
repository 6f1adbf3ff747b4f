// refused: This explicit integrator has no stabilisation
#include <polybody/bodies/rigid/planar_rigid.hpp>
#include <polybody/integrators/runge_kutta.hpp>
#include <polybody/joints/planar/joints.hpp>
#include <polybody/run/simulate.hpp>

using namespace polybody;
using M = Model<Bodies<planar::Rigid>, Joints<Joint<planar::Revolute, Constraint>>>;

void run(M const& model, State& x) { simulate(model, x, RungeKutta4<>{}, {.end_time = 1.0, .step = 1e-3}); }
