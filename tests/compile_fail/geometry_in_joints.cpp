// refused: Joints<...> must list joints. Joint<Revolute> makes a joint from the geometry
#include <polybody/polybody.hpp>

using namespace polybody;

Model<Bodies<Rigid<>>, Joints<Revolute>> model;
