// accepted
#include <polybody/bodies/ancf/ancf_cable.hpp>
#include <polybody/joints/standard_joints.hpp>
#include <polybody/system/model.hpp>

using namespace polybody;
using Cross = Joint<Universal, Constraint>;

// The cable is along x, the direction of the second arm.
void connect(Model<Bodies<AncfCable<>>, Joints<Cross>>& model, BodyHandle<AncfCable<>> const& cable) {
  model.connect(Cross{{.first = Vec3::UnitY(), .second = Vec3::UnitX()}, {}}, model.ground().at({0, 0, 0}),
                cable.at(0.0));
}
