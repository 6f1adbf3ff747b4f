// refused: JointCoordinates supports joints between the ground, rigid bodies, floating frames
#include <polybody/bodies/ancf/ancf_beam.hpp>
#include <polybody/joints/policies/elimination.hpp>
#include <polybody/joints/standard_joints.hpp>
#include <polybody/system/model.hpp>

using namespace polybody;
using Pin = Joint<Revolute, JointCoordinates>;
using M = Model<Bodies<AncfBeam<>>, Joints<Pin>>;

void make(M& model, BodyHandle<AncfBeam<>> const& beam) {
  model.connect(Pin{}, model.ground().at({0, 0, 0}), beam.at(0.0));
}
