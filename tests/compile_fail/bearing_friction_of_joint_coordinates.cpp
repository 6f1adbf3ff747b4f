// refused: Friction that follows the reaction of a joint needs the policy Constraint, or a compliant policy
#include <polybody/forces/reaction_friction.hpp>
#include <polybody/joints/policies/elimination.hpp>
#include <polybody/joints/standard_joints.hpp>

using namespace polybody;

BearingFriction<Joint<Revolute, JointCoordinates>> friction{
    .coefficient = 0.1, .radius = 0.02, .resistance = {.slip_speed = 1e-3}};
