// refused: A planar joint connects planar bodies
// With the umbrella header a compiler's message may begin with a long list of includes.
#include <polybody/polybody.hpp>

using namespace polybody;
using Ball = Joint<Spherical, Constraint>;

void connect(Model<Bodies<planar::Rigid>, Joints<Ball>>& model, BodyHandle<planar::Rigid> const& body) {
  model.connect(Ball{}, model.ground().at({0, 0, 0}), body.at({0, 0}));
}
