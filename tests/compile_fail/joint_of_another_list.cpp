// refused: The type of this joint is not in the model's list. Add Joint<Geometry, Policy>
#include <polybody/polybody.hpp>

using namespace polybody;
using Pin = Joint<Revolute, Constraint>;

void join(Model<Bodies<Rigid<>>, Joints<Pin>>& model, BodyHandle<Rigid<>> const& rod) {
  model.connect(Joint<Spherical, Constraint>{}, model.ground().at({0, 0, 0}), rod.at(0.0));
}
