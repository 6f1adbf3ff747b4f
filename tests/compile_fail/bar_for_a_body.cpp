// refused: The argument of add must be a body. Make a body from a bar
#include <polybody/polybody.hpp>

using namespace polybody;
using Pin = Joint<Revolute, Constraint>;
using M = Model<Bodies<Rigid<>>, Joints<Pin>, Forces<SpringDamper>>;

void add(M& model, Bar const& bar) { model.add(bar, "rod"); }
