// refused: A planar joint connects planar bodies
#include <polybody/bodies/rigid/planar_rigid.hpp>
#include <polybody/joints/standard_joints.hpp>
#include <polybody/system/model.hpp>

using namespace polybody;
using Ball = Joint<Spherical, Constraint>;

void connect(Model<Bodies<planar::Rigid>, Joints<Ball>>& model, BodyHandle<planar::Rigid> const& body) {
  model.connect(Ball{}, model.ground().at({0, 0, 0}), body.at({0, 0}));
}
