// refused: The type of this force is not in the model's list. Add it to Model
#include <polybody/polybody.hpp>

using namespace polybody;
using Pin = Joint<Revolute, Constraint>;

void pull(Model<Bodies<Rigid<>>, Joints<Pin>>& model, SpringDamper const& spring, BodyHandle<Rigid<>> const& rod) {
  model.apply(spring, model.ground().at({0, 0, 0}), rod.at(0.0));
}
