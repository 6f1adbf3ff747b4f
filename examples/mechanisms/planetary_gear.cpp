// Planetary gear: a sun of 20 teeth drives a carrier through a planet of 15 teeth in a fixed ring of 50 teeth.
#include "mechanism.hpp"
using namespace polybody;

int main() {
  using Pin = Joint<planar::Revolute, Constraint>;
  using Mesh = Joint<Gear, Constraint>;
  using Motor = Joint<PrescribedRate<Constant>, Constraint>;
  Model<Bodies<planar::Rigid>, Joints<Pin, Mesh, Motor>> model;
  double const arm = 0.35;
  auto const ground = model.ground().at({0, 0, 0});
  auto const sun = model.add(planar::Rigid(1.0, 0.02), "sun");
  auto const carrier = model.add(planar::Rigid(1.0, 0.05), "carrier");
  auto const planet = model.add(planar::Rigid(1.0, 0.01, Placement::planar(arm, 0)), "planet");
  model.connect(Pin{}, ground, sun.centre(), "bearing of the sun");
  auto const shaft = model.connect(Pin{}, ground, carrier.centre(), "bearing of the carrier");
  model.connect(Pin{}, carrier.at(Vec2(arm, 0)), planet.centre(), "bearing of the planet");
  model.connect(Mesh{{.teeth_a = 20, .teeth_b = 15, .centres = {1, 0, 0}}}, sun.centre(), planet.centre(), "sun, planet");
  model.connect(Mesh{{.teeth_a = -50, .teeth_b = 15, .centres = {1, 0, 0}}}, ground, planet.centre(), "ring, planet");
  model.connect(Motor{{.law = {{.value = 7.0}}}}, ground, sun.centre(), "motor");

  State x = model.reference_state();
  mechanism::Picture picture("Planetary gear: centre of the planet", 0, 1);
  int step = 0;
  for (auto const& now : simulate(model, x, GeneralisedAlpha{}, {.end_time = 1.0, .step = 1e-3}))
    if (step++ % 200 == 0) picture.line({Vec3(0, 0, 0), now.position(planet.centre())}, 0, now.t);
  picture.write("planetary_gear");
  // Willis: ω_carrier = ω_sun N_sun/(N_sun + N_ring).
  return mechanism::compare("speed of the carrier [rad/s]", joint_angle_rate(model, x, shaft), 7.0 * 20.0 / 70.0, 1e-6);
}
