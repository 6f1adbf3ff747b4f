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
  model.connect(Mesh{{.teeth_a = 20, .teeth_b = 15, .centres = {1, 0, 0}}}, sun.centre(), planet.centre(),
                "sun, planet");
  model.connect(Mesh{{.teeth_a = -50, .teeth_b = 15, .centres = {1, 0, 0}}}, ground, planet.centre(), "ring, planet");
  model.connect(Motor{{.law = {{.value = 7.0}}}}, ground, sun.centre(), "motor");

  // Outline of a gear: teeth of a module of 20 mm, drawn as a wave about the pitch circle.
  auto const outline = [](Frame<double> const& f, int teeth) {
    std::vector<Vec3> points;
    for (int i = 0; i <= 12 * teeth; ++i) {
      double const angle = 2.0 * std::acos(-1.0) * i / (12.0 * teeth),
                   r = 0.01 * teeth + 0.01 * std::cos(teeth * angle);
      points.push_back(f.r + f.A * Vec3(r * std::cos(angle), r * std::sin(angle), 0));
    }
    return points;
  };
  State x = model.reference_state();
  std::vector<Vec3> path, rim, bar;
  for (auto const& now : simulate(model, x, GeneralisedAlpha{}, {.end_time = 1.0, .step = 1e-3}))
    path.push_back(now.position(planet.centre()));
  for (int i = 0; i <= 80; ++i) {
    Vec3 const round(std::cos(i * 0.0785398), std::sin(i * 0.0785398), 0);
    rim.push_back(0.57 * round);
    bar.push_back(0.025 * round + (round.dot(path.back()) > 0.0 ? path.back() : Vec3(0, 0, 0)));
  }
  mechanism::Picture picture("Planetary gear after 1 s, and path of the planet", 0, 1);
  picture.line(rim, 6);
  picture.line(outline(frame(model, x, ground), 50), 6);
  picture.area(outline(frame(model, x, planet.centre()), 15), 2);
  picture.area(outline(frame(model, x, sun.centre()), 20), 1);
  picture.area(bar, 0);
  picture.line(path, 0);
  picture.text({-0.06, -0.13, 0}, "sun");
  picture.text({-0.28, 0.33, 0}, "planet");
  picture.text({0.43, 0.4, 0}, "ring");
  picture.text({-0.03, 0, 0}, "carrier");
  picture.text(path.front(), "0 s");
  picture.write("planetary_gear");
  // Willis: ω_carrier = ω_sun N_sun/(N_sun + N_ring).
  return mechanism::compare("speed of the carrier [rad/s]", joint_angle_rate(model, x, shaft), 7.0 * 20.0 / 70.0, 1e-6);
}
