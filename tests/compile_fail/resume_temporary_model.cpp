// refused: a temporary model is refused
#include <polybody/polybody.hpp>

using namespace polybody;
using M = Model<Bodies<Rigid<>>, Joints<Joint<Revolute, Constraint>>>;

void run(State& x, RunSnapshot const& from) {
  resume(M{}, x, GeneralisedAlpha{}, {.end_time = 1.0, .step = 1e-3}, from);
}
