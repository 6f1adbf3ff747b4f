// refused: EnergyMomentum and EnergyDecaying do not support force groups
#include <polybody/bodies/rigid/planar_rigid.hpp>
#include <polybody/forces/contact.hpp>
#include <polybody/forces/contact_group.hpp>
#include <polybody/integrators/energy_momentum.hpp>
#include <polybody/run/simulate.hpp>

using namespace polybody;
using Group = ContactGroup<Contact<SphereOnSphere>>;

void run(Model<Bodies<planar::Rigid>, Joints<>, Forces<Group>> const& model, State& x) {
  simulate(model, x, EnergyMomentum{}, {.end_time = 1.0, .step = 1e-3}).run();
}
