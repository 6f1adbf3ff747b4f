// refused: A force on a translation needs a joint that permits or prescribes exactly one translation
#include <polybody/polybody.hpp>

#include <polybody/forces/spring_laws.hpp>

using namespace polybody;
using Pin = Joint<Revolute, Constraint>;
using M = Model<Bodies<Rigid<>>, Joints<Pin>, Forces<OnTranslation<LinearSpring>>>;

void push(M& model, ElementHandle<Pin> const& pin) {
  model.apply(OnTranslation<LinearSpring>{{.stiffness = 1.0}}, pin, "spring");
}
