// refused: The parameters of this policy have no default values. Give them after the geometry
// The geometry alone makes no joint if the policy has numbers.
#include <polybody/joints/joint.hpp>
#include <polybody/joints/standard_joints.hpp>

using namespace polybody;
Joint<Revolute, Penalty> const hinge{Revolute{.axis = {0, 1, 0}}};
