// refused: The parameters of this policy have no default values. Give them after the geometry
#include <polybody/polybody.hpp>

using namespace polybody;

using Pin = Joint<Revolute, Penalty>;

void join(Model<Bodies<Rigid<>>, Joints<Pin>>& model, BodyHandle<Rigid<>> const& rod) {
  model.connect(Pin{Revolute{.axis = {0, 1, 0}}}, model.ground().at({0, 0, 0}), rod.at(0.0));
}
