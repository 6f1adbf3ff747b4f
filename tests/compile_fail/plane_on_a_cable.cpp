// refused: This force needs a marker with
#include <polybody/bodies/ancf/ancf_cable.hpp>
#include <polybody/forces/contact.hpp>
#include <polybody/system/model.hpp>

using namespace polybody;
using OnPlane = Contact<SphereOnPlane>;

// A cable has no rotation about its tangent, so it does not define a plane.
void apply(Model<Bodies<AncfCable<>>, Joints<>, Forces<OnPlane>>& model, BodyHandle<AncfCable<>> const& cable,
           OnPlane const& contact) {
  model.apply(contact, model.ground().at({0, 0, 0}), cable.at(0.5));
}
