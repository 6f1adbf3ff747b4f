// title: Mooring line on a sea bed
// thread: https://github.com/Total-RD/seahowl/issues/73
// wanted: A mooring line that is longer than the straight line between its ends lies on the bed in part. Its mass
//     belonged to the straight length.
// inputs: 100 m, 50 N/m, EA = 1e6 N, EI = 1 N m². Anchor (0, 0) on a smooth bed z = 0, fairlead (85, 30) m. 40
//     ANCF cable elements; each node sinks into the bed by 1 mm.
// right: Catenary with a part on the bed: H = 885.0560 N, V = 2212.1263 N, 55.75747 m on the bed.
#include <polybody/polybody.hpp>

#include "answer.hpp"
using namespace polybody;

int main() {
  using Cable = AncfCable<EngineeringStrain>;
  using Ball = Joint<Spherical, Constraint>;
  using Bed = Contact<SphereOnPlane>;
  Model<Bodies<Cable>, Joints<Ball>, Forces<Bed>> model{Gravity{0, 0, -9.81}};
  Bar const bar{.length = 100.0, .constants = BarConstants{.EA = 1e6, .EI = 1.0, .mass_per_length = 50.0 / 9.81}};
  Vec3 const fairlead(85, 0, 30);
  auto const line = model.add(Cable::from(bar, 40), "line");
  model.connect(Ball{}, model.ground().at({0, 0, 0}), line.at(0.0), "anchor");
  auto const top = model.connect(Ball{}, model.ground().at(fairlead), line.at(100.0), "fairlead");
  Bed const bed{.geometry = {.radius = 1e-3}, .normal = {.stiffness = 50.0 * 2.5 / 1e-3, .damping = 0.0}};
  for (int i = 0; i <= 40; ++i) model.apply(bed, line.at(2.5 * i), model.ground().at({0, 0, -1e-3}));
  State x = model.reference_state();
  equilibrium(model, x);
  Vec3 const f = reaction(model, x, top).f;
  answer("horizontal force on the fairlead [N]", 885.0560, f[0], 4.4);
  answer("vertical force on the fairlead [N]", 2212.1263, f[2], 11.0);
  Vec3 const at80 = position(model, x, line.at(80.0));
  answer("height of the point at 80 m [m]", 12.33073, at80[2], 0.1);
  return wrong_answers();
}
