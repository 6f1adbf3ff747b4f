// refused: This friction follows the reaction of another type of joint
#include <polybody/bodies/rigid/rigid.hpp>
#include <polybody/forces/reaction_friction.hpp>
#include <polybody/joints/standard_joints.hpp>
#include <polybody/system/model.hpp>

using namespace polybody;
using Hinge = Joint<Revolute, Constraint>;
using Pin = Joint<Cylindrical, Constraint>;
using M = Model<Bodies<Rigid<>>, Joints<Hinge, Pin>, Forces<BearingFriction<Hinge>>>;

void add(M& model, ElementHandle<Pin> const& pin, BearingFriction<Hinge> const& friction) {
  model.apply(friction, pin);
}
