// accepted
#include <polybody/joints/joint.hpp>
#include <polybody/joints/standard_joints.hpp>

polybody::Joint<polybody::Spherical, polybody::Penalty> joint{{}, {.stiffness = 1e7, .damping = 1e3}};
