// accepted
#include <polybody/bodies/ancf/ancf_cable.hpp>
#include <polybody/forces/contact.hpp>
#include <polybody/forces/contact_group.hpp>
#include <polybody/system/model.hpp>

using namespace polybody;
using OnPlane = Contact<SphereOnPlane>;
using Group = ContactGroup<OnPlane>;

void apply(Model<Bodies<AncfCable<>>, Joints<>, Forces<OnPlane, Group>>& model, BodyHandle<AncfCable<>> const& cable,
           OnPlane const& contact) {
  model.apply(contact, cable.at(0.5), model.ground().at({0, 0, 0}));
  auto const group = model.apply(Group{}, std::vector{cable.at(0.0), cable.at(0.5)});
  model.add_partner(group, contact, model.ground().at({0, 0, 0}));
}
