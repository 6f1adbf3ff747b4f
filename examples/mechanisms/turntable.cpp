// Ball that rolls on a turntable: its centre moves on a circle at 2/7 of the speed of the table.
#include <polybody/parts.hpp>

#include "mechanism.hpp"
using namespace polybody;

int main() {
  using Pin = Joint<Revolute, Constraint>;
  using Motor = Joint<PrescribedRate<Constant>, Constraint>;
  using Floor = Contact<SphereOnPlane, SpringDamperContact, BristleFriction>;
  Model<Bodies<Rigid<>>, Joints<Pin, Motor>, Forces<Floor>> model{Gravity{0, 0, -9.81}};
  double const radius = 0.02, mass = 0.1, stiffness = 1e4, speed = 7.0, start = 0.3, push = 0.1;
  auto const ground = model.ground().at({0, 0, 0});
  auto const table = model.add(Rigid<>(5.0, 0.2 * Mat3::Identity()), "table");
  Vec3 const centre(start, 0, radius - mass * 9.81 / stiffness);
  auto const ball =
      model.add(Rigid<>(mass, 0.4 * mass * radius * radius * Mat3::Identity(), Placement::at(centre)), "ball");
  model.connect(Pin{{.axis = {0, 0, 1}}}, ground, table.centre(), "bearing");
  model.connect(Motor{{.law = {{.value = speed}}, .axis = {0, 0, 1}}}, ground, table.centre(), "motor");
  Floor const floor{{.radius = radius},
                    {.stiffness = stiffness, .damping = 5.0},
                    {.coefficient = 0.6, .stiffness = 1e4, .damping = 5.0}};
  model.apply(floor, ball.centre(), table.centre(), "contact");

  // The ball rolls: v + ω × (−R z) = Ω z × r.
  State x = model.reference_state();
  model.set_velocity(x, table, {0, 0, 0}, {0, 0, speed});
  Vec3 const spin(speed * start / radius, push / radius, 0);
  model.set_velocity(x, ball, Vec3(push, 0, 0) - spin.cross(centre), spin);
  mechanism::Picture picture("Ball on a turntable: path of its centre", 0, 1);
  std::vector<Vec3> path;
  double const turn = 7.0 * std::acos(-1.0) / speed;  // 2π/(2Ω/7)
  double rate = 0.0;  // of the direction of the velocity, over the first third of a turn
  for (auto const& now : simulate(model, x, GeneralisedAlpha{}, {.end_time = turn, .step = 2e-4})) {
    Frame<double> const f = now.frame(ball.centre());
    if (path.size() % 1000 == 0) picture.line({f.r}, 1, now.t);
    path.push_back(f.r);
    if (now.t > 0.0 && now.t < turn / 3.0) rate = std::atan2(f.v[1], f.v[0]) / now.t;
  }
  picture.line(path, 0);
  picture.write("turntable");
  return mechanism::compare("speed on the circle over speed of the table", rate / speed, 2.0 / 7.0, 1e-3);
}
