// refused: Friction that follows multipliers needs a model without eliminated unknowns
#include <polybody/bodies/rigid/rigid.hpp>
#include <polybody/forces/reaction_friction.hpp>
#include <polybody/joints/policies/elimination.hpp>
#include <polybody/joints/standard_joints.hpp>
#include <polybody/system/model.hpp>

using namespace polybody;
using Hinge = Joint<Revolute, Constraint>;
using M = Model<Bodies<Rigid<>>, Joints<Hinge, Joint<Revolute, JointCoordinates>>, Forces<BearingFriction<Hinge>>>;

void add(M& model, ElementHandle<Hinge> const& hinge, BearingFriction<Hinge> const& friction) {
  model.apply(friction, hinge);
}
