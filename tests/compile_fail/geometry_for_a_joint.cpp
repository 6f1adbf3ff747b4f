// refused: The first argument of connect must be a joint. Joint.Revolute
#include <polybody/polybody.hpp>

using namespace polybody;
using Pin = Joint<Revolute, Constraint>;
using M = Model<Bodies<Rigid<>>, Joints<Pin>, Forces<SpringDamper>>;

void join(M& model, BodyHandle<Rigid<>> const& rod) {
  model.connect(Revolute{.axis = {0, 1, 0}}, model.ground().at({0, 0, 0}), rod.at(0.0), "pin");
}
