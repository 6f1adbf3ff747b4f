// refused: The model must be the first argument: simulate
#include <polybody/polybody.hpp>

using namespace polybody;
using Pin = Joint<Revolute, Constraint>;
using M = Model<Bodies<Rigid<>>, Joints<Pin>, Forces<SpringDamper>>;

void run(M const& model, State& x) { simulate(x, model, GeneralisedAlpha{}, {.end_time = 1.0, .step = 1e-3}).run(); }
