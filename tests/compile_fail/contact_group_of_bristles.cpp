// refused: The contacts of a ContactGroup have no first-order states
#include <polybody/forces/bristle_friction.hpp>
#include <polybody/forces/contact_group.hpp>

using namespace polybody;

ContactGroup<Contact<SphereOnPlane, SpringDamperContact, BristleFriction>> group;
