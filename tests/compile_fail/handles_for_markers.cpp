// refused: A joint connects two markers
#include <polybody/polybody.hpp>

using namespace polybody;
using Pin = Joint<Revolute, Constraint>;
using M = Model<Bodies<Rigid<>>, Joints<Pin>, Forces<SpringDamper>>;

void join(M& model, BodyHandle<Rigid<>> const& rod) { model.connect(Pin{}, model.ground(), rod); }
