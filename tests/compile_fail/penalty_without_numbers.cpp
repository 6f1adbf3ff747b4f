// refused: The parameters of this policy have no default values. Give them after the geometry
// Physical parameters have no default.
#include <polybody/joints/joint.hpp>
#include <polybody/joints/standard_joints.hpp>

polybody::Joint<polybody::Spherical, polybody::Penalty> joint{};
