// refused: A force element needs as many markers as its constant
#include <polybody/polybody.hpp>

#include <polybody/forces/spring_laws.hpp>

using namespace polybody;
using Pin = Joint<Revolute, Constraint>;
using M = Model<Bodies<Rigid<>>, Joints<Pin>, Forces<OnDistance<LinearSpring>>>;

void pull(M& model, ElementHandle<Pin> const& pin) {
  model.apply(OnDistance<LinearSpring>{{.stiffness = 1.0}}, pin, "spring");
}
