// refused: Use `auto` for this object
#include <polybody/joints/standard_joints.hpp>
#include <polybody/system/model.hpp>

using namespace polybody;

auto const hinge = Joint{Revolute{.axis = {0, 1, 0}}};
Model<Bodies<>, Joints<decltype(hinge)>> model;
