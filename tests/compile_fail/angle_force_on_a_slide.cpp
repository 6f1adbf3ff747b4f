// refused: A force on an angle needs a joint that permits or prescribes exactly one rotation
#include <polybody/polybody.hpp>

#include <polybody/forces/spring_laws.hpp>

using namespace polybody;
using Slide = Joint<Prismatic, Constraint>;
using M = Model<Bodies<Rigid<>>, Joints<Slide>, Forces<OnAngle<LinearSpring>>>;

void turn(M& model, ElementHandle<Slide> const& slide) {
  model.apply(OnAngle<LinearSpring>{{.stiffness = 1.0}}, slide, "spring");
}
