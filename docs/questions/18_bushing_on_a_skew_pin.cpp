// title: Torsion bushing on a skew pin
// thread: https://github.com/opensim-org/opensim-core/issues/638
// words: bushing force, rotational stiffness, torsional spring, stiffness matrix, joint axes, frames
// wanted: A rotational bushing acts on a hinge, and the axes of the bushing are not those of the hinge. Tests
//     covered translations only.
// inputs: Bushing of 40, 90 and 160 N m/rad about x, y and z. Hinge along n = (1, 2, 2)/3, inertia 0.5 kg m² about
//     it.
// right: The rotation is ϑ n, the moment of the bushing is K n ϑ. About the hinge the stiffness is k = nᵀK n =
//     1040/9 N m/rad and the frequency √(k/J); the hinge carries the remainder K n − k n of the moment.
#include <polybody/polybody.hpp>
#include <polybody/vibration.hpp>

#include "answer.hpp"
using namespace polybody;

int main() {
  using Hinge = Joint<Revolute, Constraint>;
  using Mount = Joint<RelativeCoordinates, Bushing>;
  Model<Bodies<Rigid<>>, Joints<Hinge, Mount>, Forces<PointMoment<>>> model;
  Vec3 const n = Vec3(1, 2, 2) / 3.0, about(40, 90, 160);
  double const k = 1040.0 / 9.0, angle = 1e-5, inertia = 0.5;
  auto const wheel = model.add(Rigid<>(1.0, inertia * Mat3::Identity()), "wheel");
  auto const ground = model.ground().at({0, 0, 0});
  auto const hinge = model.connect(Hinge{Revolute{.axis = n}}, ground, wheel.centre(), "hinge");
  model.connect(
      Mount{{.axis = {0, 0, 1}},
            {.stiffness = Bushing::diagonal({0, 0, 0}, about), .damping = Bushing::diagonal({0, 0, 0}, {0, 0, 0})}},
      ground, wheel.centre(), "bushing");
  State x = model.reference_state();
  answer("frequency [rad/s]", std::sqrt(k / inertia), modes(model, x, 1).frequency[0], 1e-9);
  model.apply(PointMoment<>{.moment = k * angle * n}, wheel.centre(), "load");
  x = model.reference_state();
  equilibrium(model, x);
  answer("stiffness about the hinge [N m/rad]", k, k * angle / joint_angle(model, x, hinge), 1e-3);
  Vec3 const carried = reaction(model, x, hinge).m / angle;
  answer("moment in the hinge, for 1 rad [N m]", 42.4554959, carried.norm(), 1e-3);
  answer("its component about the hinge [N m]", 0.0, carried.dot(n), 1e-3);
  return wrong_answers();
}
