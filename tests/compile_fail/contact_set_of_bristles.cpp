// refused: The contacts of a ContactSet have no first-order states
#include <polybody/forces/bristle_friction.hpp>
#include <polybody/forces/contact_set.hpp>

using namespace polybody;

ContactSet<Shapes<Sphere, Plane>, SpringDamperContact, BristleFriction> const* set = nullptr;
auto const members = set->members();
