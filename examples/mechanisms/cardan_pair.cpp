// Two universal joints in phase: the output shaft turns as uniformly as the input shaft.
#include "mechanism.hpp"
using namespace polybody;

int main() {
  using Pin = Joint<Revolute, Constraint>;
  using Sleeve = Joint<Cylindrical, Constraint>;
  using Cross = Joint<Universal, Constraint>;
  using Motor = Joint<PrescribedRate<Constant>, Constraint>;
  Model<Bodies<Rigid<>>, Joints<Pin, Sleeve, Cross, Motor>> model;
  double const bend = std::acos(-1.0) / 6.0;  // 30° at each joint
  Vec3 const in(1, 0, 0), middle(std::cos(bend), std::sin(bend), 0), out(std::cos(2 * bend), std::sin(2 * bend), 0),
      z(0, 0, 1);
  Mat3 const inertia = 5e-4 * Mat3::Identity();
  auto const ground = model.ground();
  auto const first = model.add(Rigid<>(0.5, inertia, Placement::at(-0.2 * in)), "input");
  auto const second = model.add(Rigid<>(0.5, inertia, Placement::at(0.25 * middle)), "middle");
  auto const third = model.add(Rigid<>(0.5, inertia, Placement::at(Vec3(0.5 * middle + 0.2 * out))), "output");
  model.connect(Pin{{.axis = in}}, ground.at(-0.2 * in), first.centre(), "input bearing");
  model.connect(Motor{{.law = {{.value = 20.0}}, .axis = in}}, ground.at(-0.2 * in), first.centre(), "motor");
  auto const bearing =
      model.connect(Sleeve{{.axis = out}}, ground.at(Vec3(0.5 * middle + 0.2 * out)), third.centre(), "output bearing");
  // The pins of the driving yoke and of the driven yoke are along z.
  model.connect(Cross{{.first = z, .second = Vec3(-middle[1], middle[0], 0)}}, first.at(Vec3(0.2 * in)),
                second.at(Vec3(-0.25 * middle)), "cross 1");
  model.connect(Cross{{.first = Vec3(-middle[1], middle[0], 0), .second = z}}, second.at(Vec3(0.25 * middle)),
                third.at(Vec3(-0.2 * out)), "cross 2");

  State x = model.reference_state();
  mechanism::Picture picture("Two universal joints", 0, 1);
  picture.line({-0.4 * in, Vec3(0, 0, 0)}, 0);
  picture.line({Vec3(0, 0, 0), 0.5 * middle}, 1);
  picture.line({0.5 * middle, 0.5 * middle + 0.4 * out}, 0);
  picture.write("cardan_pair");
  double worst = 0.0;
  for (auto const& now : simulate(model, x, GeneralisedAlpha{.stabilised = true}, {.end_time = 0.4, .step = 5e-4}))
    worst = std::max(worst, std::abs(now.joint_angle_rate(bearing) - 20.0));
  return mechanism::compare("speed of the output [rad/s]", 20.0 + worst, 20.0, 1e-5);
}
