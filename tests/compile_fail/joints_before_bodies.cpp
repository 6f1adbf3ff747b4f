// refused: The lists of a model must have this order
#include <polybody/polybody.hpp>

using namespace polybody;
using Pin = Joint<Revolute, Constraint>;

Model<Joints<Pin>, Bodies<Rigid<>>> model{Gravity{0, 0, -9.81}};
