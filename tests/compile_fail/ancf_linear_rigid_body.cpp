// refused: AncfLinear needs markers that are linear in the coordinates
#include <polybody/bodies/rigid/rigid.hpp>
#include <polybody/joints/policies/elimination.hpp>
#include <polybody/joints/standard_joints.hpp>
#include <polybody/system/model.hpp>

using namespace polybody;
using Pin = Joint<Spherical, AncfLinear>;
using M = Model<Bodies<Rigid<>>, Joints<Pin>>;

void make(M& model, BodyHandle<Rigid<>> const& body) {
  model.connect(Pin{}, model.ground().at({0, 0, 0}), body.at({0, 0, 0}));
}
