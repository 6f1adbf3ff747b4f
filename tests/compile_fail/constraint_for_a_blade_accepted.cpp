// accepted
#include <polybody/joints/joint.hpp>
#include <polybody/joints/nonholonomic.hpp>
#include <polybody/joints/policies/policy.hpp>

polybody::Joint<polybody::KnifeEdge, polybody::Constraint> const joint{};
