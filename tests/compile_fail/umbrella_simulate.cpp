// refused: This explicit integrator has no stabilisation
#include <polybody/polybody.hpp>

using namespace polybody;
using M = Model<Bodies<Rigid<>>, Joints<Joint<Revolute, Constraint>>>;

void run(M const& model, State& x) { simulate(model, x, RungeKutta4<>{}, {.end_time = 1.0, .step = 1e-3}).run(); }
