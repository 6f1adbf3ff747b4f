// accepted
#include <polybody/bodies/rigid/planar_rigid.hpp>
#include <polybody/joints/planar/joints.hpp>
#include <polybody/system/model.hpp>

using namespace polybody;
using Pin = Joint<planar::Revolute, Constraint>;

void connect(Model<Bodies<planar::Rigid>, Joints<Pin>>& model, BodyHandle<planar::Rigid> const& body) {
  model.connect(Pin{}, model.ground().at({0, 0, 0}), body.at({0, 0}));
}
