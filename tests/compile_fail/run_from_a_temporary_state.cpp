// refused: A run changes its state, so a temporary or constant state is refused
#include <polybody/polybody.hpp>

using namespace polybody;
using Pin = Joint<Revolute, Constraint>;
using M = Model<Bodies<Rigid<>>, Joints<Pin>, Forces<SpringDamper>>;

void run(M const& model) {
  simulate(model, model.reference_state(), GeneralisedAlpha{}, {.end_time = 1.0, .step = 1e-3}).run();
}
