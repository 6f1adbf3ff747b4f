// refused: This joint needs more than the marker tells
#include <polybody/bodies/ancf/ancf_cable.hpp>
#include <polybody/joints/universal.hpp>
#include <polybody/system/model.hpp>

using namespace polybody;
using Cross = Joint<Universal, Constraint>;

// A cable knows its tangent, which serves the second arm of a cross, not the first.
void connect(Model<Bodies<AncfCable<>>, Joints<Cross>>& model, BodyHandle<AncfCable<>> const& cable) {
  model.connect(Cross{}, cable.at(0.0), model.ground().at({0, 0, 0}));
}
