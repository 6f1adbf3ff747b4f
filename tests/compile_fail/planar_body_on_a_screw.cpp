// refused: A planar joint connects planar bodies
#include <polybody/bodies/rigid/planar_rigid.hpp>
#include <polybody/joints/standard_joints.hpp>
#include <polybody/system/model.hpp>

using namespace polybody;
using Thread = Joint<Screw, Constraint>;

void connect(Model<Bodies<planar::Rigid>, Joints<Thread>>& model, BodyHandle<planar::Rigid> const& body) {
  model.connect(Thread{{.pitch = 0.1}, {}}, model.ground().at({0, 0, 0}), body.at({0, 0}));
}
