// refused: A joint geometry needs static constants
#include <polybody/polybody.hpp>

using namespace polybody;

Model<Bodies<Rigid<>>, Joints<Joint<Constraint, Revolute>>> model;
