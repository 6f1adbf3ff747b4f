// refused: declare the object with `auto`
#include <polybody/joints/revolute.hpp>
#include <polybody/system/model.hpp>

using namespace polybody;

auto const hinge = Joint{Revolute{.axis = {0, 1, 0}}};
Model<Bodies<>, Joints<decltype(hinge)>> model;
