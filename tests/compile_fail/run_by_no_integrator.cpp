// refused: The third argument of simulate must be an integrator
#include <polybody/polybody.hpp>

using namespace polybody;
using Pin = Joint<Revolute, Constraint>;
using M = Model<Bodies<Rigid<>>, Joints<Pin>, Forces<SpringDamper>>;

void run(M const& model, State& x) { simulate(model, x, Projection{}, {.end_time = 1.0, .step = 1e-3}).run(); }
