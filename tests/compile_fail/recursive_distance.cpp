// refused: JointCoordinates needs a joint whose motion has coordinates
#include <polybody/bodies/rigid/rigid.hpp>
#include <polybody/joints/policies/elimination.hpp>
#include <polybody/joints/standard_joints.hpp>
#include <polybody/system/model.hpp>

using namespace polybody;
using Rod = Joint<Distance, JointCoordinates>;
using M = Model<Bodies<Rigid<>>, Joints<Rod>>;

void make(M& model, BodyHandle<Rigid<>> const& body) {
  model.connect(Rod{{.length = 1.0}, {}}, model.ground().at({0, 0, 0}), body.at({0, 0, 0}));
}
