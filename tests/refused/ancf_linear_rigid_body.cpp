// refused: both markers must be linear in them
#include <polybody/bodies/rigid/rigid.hpp>
#include <polybody/joints/policies/ancf_linear.hpp>
#include <polybody/joints/spherical.hpp>
#include <polybody/system/model.hpp>

using namespace polybody;
using Pin = Joint<Spherical, AncfLinear>;
using M = Model<Bodies<Rigid<>>, Joints<Pin>>;

void make(M& model, BodyHandle<Rigid<>> const& body) {
  model.connect(Pin{}, model.ground().at({0, 0, 0}), body.at({0, 0, 0}));
}
