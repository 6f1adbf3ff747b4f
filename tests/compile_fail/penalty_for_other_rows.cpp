// refused: The number of parameters of this policy must equal
// A ball joint has three constraint equations.
#include <polybody/joints/joint.hpp>
#include <polybody/joints/standard_joints.hpp>

polybody::Joint<polybody::Spherical, polybody::PenaltyPerEquation<5>> const joint{
    {}, {.stiffness = polybody::Vec<double, 5>::Ones(), .damping = polybody::Vec<double, 5>::Zero()}};
