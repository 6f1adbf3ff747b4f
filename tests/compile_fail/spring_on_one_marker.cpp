// refused: A force element needs as many markers as its constant
#include <polybody/polybody.hpp>

using namespace polybody;
using Pin = Joint<Revolute, Constraint>;
using M = Model<Bodies<Rigid<>>, Joints<Pin>, Forces<SpringDamper>>;

void pull(M& model, SpringDamper const& spring, BodyHandle<Rigid<>> const& rod) {
  model.apply(spring, rod.at(0.0), "spring");
}
