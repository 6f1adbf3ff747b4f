// refused: This joint needs a marker with axes
#include <polybody/bodies/ancf/ancf_cable.hpp>
#include <polybody/joints/standard_joints.hpp>
#include <polybody/system/model.hpp>

using namespace polybody;
using Cross = Joint<Universal, Constraint>;

// A cable provides its tangent, which can be the second arm of a universal joint, but not the first.
void connect(Model<Bodies<AncfCable<>>, Joints<Cross>>& model, BodyHandle<AncfCable<>> const& cable) {
  model.connect(Cross{}, cable.at(0.0), model.ground().at({0, 0, 0}));
}
