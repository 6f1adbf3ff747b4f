// accepted
// The policy of a joint type without a policy is Constraint.
#include <polybody/polybody.hpp>

using namespace polybody;

static_assert(std::is_same_v<Joint<Revolute>, Joint<Revolute, Constraint>>);

Model<Bodies<Rigid<>>, Joints<Joint<Revolute>>> model;
