// Crane with a winch: the load rises by the reeled length, and the cable stretches under the weight.
#include <polybody/parts.hpp>

#include "mechanism.hpp"
using namespace polybody;

int main() {
  using Cable = OnDistance<Winch<SmoothRamp>>;
  Model<Bodies<planar::Rigid>, Joints<>, Forces<Cable>> model{Gravity{0, -9.81, 0}};
  double const mass = 100.0, length = 4.0, reeled = 1.0, stiffness = 1e5;
  auto const load = model.add(planar::Rigid(mass, 10.0, Placement::planar(0, -length)), "load");
  Winch<SmoothRamp> const winch{
      .axial_stiffness = stiffness, .damping = 2e3, .length = length, .reeled = {.target = reeled, .duration = 2.0}};
  model.apply(Cable{winch}, model.ground().at({0, 0, 0}), load.centre(), "cable");
  State x = model.reference_state();
  mechanism::Picture picture("Crane with a winch, at four times side by side", 0, 1);
  int step = 0;
  for (auto const& now : simulate(model, x, GeneralisedAlpha{}, {.end_time = 8.0, .step = 2e-3}))
    if (step++ % 400 == 0 && now.t < 2.5)
      picture.line({Vec3(now.t, 0, 0), now.position(load.centre()) + Vec3(now.t, 0, 0)}, 0, now.t);
  picture.write("crane");
  double const left = length - reeled, known = left * (1.0 + mass * 9.81 / stiffness);
  return mechanism::compare("depth of the load [m]", -position(model, x, load.centre())[1], known, 1e-4);
}
