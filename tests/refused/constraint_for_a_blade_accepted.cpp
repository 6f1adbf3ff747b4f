// accepted
#include <polybody/joints/joint.hpp>
#include <polybody/joints/knife_edge.hpp>
#include <polybody/joints/policies/constraint.hpp>

polybody::Joint<polybody::KnifeEdge, polybody::Constraint> const joint{};
