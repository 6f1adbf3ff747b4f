// refused: A run needs options: simulate
#include <polybody/polybody.hpp>

using namespace polybody;
using Pin = Joint<Revolute, Constraint>;
using M = Model<Bodies<Rigid<>>, Joints<Pin>, Forces<SpringDamper>>;

void run(M const& model, State& x) { simulate(model, x, GeneralisedAlpha{}).run(); }
