// accepted
#include <polybody/joints/joint.hpp>
#include <polybody/joints/policies/elimination.hpp>
#include <polybody/joints/standard_joints.hpp>

using namespace polybody;
using Hinge = Joint<Revolute, JointCoordinates>;

Hinge const hinge{Revolute{.axis = {0, 1, 0}}};
Joint<Revolute, Constraint> const ideal = Joint{Revolute{.axis = {0, 1, 0}}};
Joint<Revolute, Penalty> const stiff = Joint{Revolute{.axis = {0, 1, 0}}, Penalty{.stiffness = 1e7, .damping = 1e3}};
