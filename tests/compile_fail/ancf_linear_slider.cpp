// refused: AncfLinear supports Spherical, Revolute and Weld
#include <polybody/bodies/ancf/ancf_beam.hpp>
#include <polybody/joints/policies/elimination.hpp>
#include <polybody/joints/standard_joints.hpp>
#include <polybody/system/model.hpp>

using namespace polybody;
using Slide = Joint<Prismatic, AncfLinear>;
using M = Model<Bodies<AncfBeam<>>, Joints<Slide>>;

void make(M& model, BodyHandle<AncfBeam<>> const& beam) {
  model.connect(Slide{}, model.ground().at({0, 0, 0}), beam.at(0.0));
}
