// accepted
// A bushing with stiffness and damping, on a pin.
#include <polybody/joints/joint.hpp>
#include <polybody/joints/policies/bushing.hpp>
#include <polybody/joints/standard_joints.hpp>

polybody::Joint<polybody::Revolute, polybody::Bushing> const mount{
    {}, {.stiffness = polybody::Bushing::diagonal({1, 1, 1}, {1, 1, 0}), .damping = polybody::Bushing::Matrix::Zero()}};
