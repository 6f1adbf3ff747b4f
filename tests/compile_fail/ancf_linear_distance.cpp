// refused: AncfLinear supports Spherical, Revolute and Weld
// Distance does not name its free directions.
#include <polybody/bodies/ancf/ancf_beam.hpp>
#include <polybody/joints/policies/elimination.hpp>
#include <polybody/joints/standard_joints.hpp>
#include <polybody/system/model.hpp>

using namespace polybody;
using Rod = Joint<Distance, AncfLinear>;
using M = Model<Bodies<AncfBeam<>>, Joints<Rod>>;

void make(M& model, BodyHandle<AncfBeam<>> const& beam) {
  model.connect(Rod{{.length = 1.0}, {}}, model.ground().at({0, 0, 0}), beam.at(0.0));
}
