// refused: EnergyMomentum and EnergyDecaying need bodies with a constant mass matrix
#include <polybody/polybody.hpp>

using namespace polybody;

void run(Model<Bodies<Lrvf<Direct>>, Joints<>> const& model, State& x) {
  simulate(model, x, EnergyMomentum{}, {.end_time = 1.0, .step = 1e-3}).run();
}
